#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "matrix_options.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

struct SampleOptions {
  std::filesystem::path model, output;
  MatrixInput given;
  std::size_t count = 1;
  ChainSettings chains;
};

/// Rows [count x visible] of free chains.
MatrixF free_samples(Device& device, const Cdbn& stack, const SampleOptions& options) {
  if (stack.total_order() > 0)
    throw ConfigError(
        "--given: wanted by a machine with a history, a sequence whose rows to draw are NaN");
  const Matrix start = Matrix::filled_with_row(stack.layers.front().visible_mean, options.count);
  spdlog::info("{} chains of {} steps on {}", options.count, options.chains.steps,
               device.info().name);
  return sample(stack, start, options.chains).to_host();
}

/// The given sequences with what was NaN in them drawn, `count` times over.
MatrixF given_samples(Device& device, const Cdbn& stack, const SavedMachine& saved,
                      const SampleOptions& options) {
  const std::vector<MatrixF> given =
      scaled(saved, options.given.read(), stack.layers.front().shape().visible, options.given);
  std::vector<MatrixF> copies;
  for (std::size_t i = 0; i < options.count; ++i)
    copies.insert(copies.end(), given.begin(), given.end());
  return stacked(
      sample_given(stack, Sequences::from_host(device, copies), options.chains).to_host(), 0);
}

void run_sample(const CommandContext& context, const SampleOptions& options) {
  check_matrix_output(options.output);
  check_settings(options.chains);
  Device device = Device::open({context.platform, context.device});
  const SavedMachine saved = load_machine(device, options.model);
  const Cdbn stack = stack_of(saved, options.model);
  put_matrix(options.output, unscaled(saved, options.given.files.empty()
                                                 ? free_samples(device, stack, options)
                                                 : given_samples(device, stack, saved, options)));
}

}  // namespace

void add_sample_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<SampleOptions>();
  CLI::App* command = app.add_subcommand("sample", "Draws from a single machine by Gibbs steps");
  add_machine_option(*command, options->model);
  add_matrix_input(*command, options->given, "--given",
                   "Matrices of what is given, NaN (an empty cell) where a unit is to be drawn; "
                   "without them free chains of a machine without history");
  add_setting_flag(
      *command, "--count",
      {"count", within(1, 1e6), "samples", "Free chains, or draws for all that is given"},
      options->count);
  add_setting_flags(*command, options->chains);
  add_matrix_output(*command, options->output,
                    "File to write, .npy, .csv or .safetensors: a row a sample, or the rows of "
                    "all that was given (default: CSV on standard output)");
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl sample --model digits.safetensors --count 64 -o digits.npy\n"
      "  mcdbn-cl sample --model digits.safetensors --given left_halves.csv --means >whole.csv");
  command->callback([&context, options] {
    context.run = [&context, options] { run_sample(context, *options); };
  });
}

}  // namespace mcdbn::cli
