#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "matrix_options.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

struct TransformOptions {
  std::filesystem::path model, output;
  MatrixInput data;
  bool inverse = false;
  std::size_t steps = 1;
};

void run_transform(const CommandContext& context, const TransformOptions& options) {
  check_matrix_output(options.output);
  Device device = Device::open({context.platform, context.device});
  const SavedMachine saved = load_machine(device, options.model);
  const Cdbn stack = stack_of(saved, options.model);
  const Sequences data = Sequences::from_host(
      device,
      scaled(saved, options.data.read(), stack.layers.front().shape().visible, options.data));
  const Sequences result =
      options.inverse ? reconstruct(stack, data, options.steps) : stack.up_pass(data);
  if (result.valid_from > 0)
    spdlog::info("the first {} rows of each file are history and left out", result.valid_from);
  const MatrixF rows = stacked(result.to_host(), result.valid_from);
  put_matrix(options.output, options.inverse ? unscaled(saved, rows) : rows);
}

}  // namespace

void add_transform_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<TransformOptions>();
  CLI::App* command =
      app.add_subcommand("transform", "Gives a single machine's hidden probabilities of data");
  add_machine_option(*command, options->model);
  add_matrix_input(*command, options->data, "data", "Matrices, each a sequence of its own")
      ->required();
  command->add_flag("--inverse", options->inverse,
                    "Up and down again: the mean-field reconstruction of the data");
  add_setting_flag(*command, "--steps",
                   {"steps", at_least(1), "steps", "Up and down so often, at the top of a stack"},
                   options->steps)
      ->needs(command->get_option("--inverse"));
  add_matrix_output(*command, options->output,
                    "File to write, .npy, .csv or .safetensors: the rows of all data that have a "
                    "history (default: CSV on standard output)");
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl transform --model digits.safetensors digits.npy -o code.npy\n"
      "  mcdbn-cl transform --model digits.safetensors digits.npy --inverse -o again.npy");
  command->callback([&context, options] {
    context.run = [&context, options] { run_transform(context, *options); };
  });
}

}  // namespace mcdbn::cli
