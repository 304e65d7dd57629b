#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "modality_options.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

struct TransformOptions {
  std::filesystem::path model, output;
  MatrixInput data;
  std::vector<std::string> modalities;  ///< NAME=FILE, of an MRBM
  std::string infer;                    ///< its modality that is wanted
  bool inverse = false;
  std::optional<std::size_t> steps;
};

/// Mean field of an MRBM with what is given clamped (eq 32, 33).
/// @return the modality that is wanted, in the units of its data
MatrixF inferred(Device& device, const SavedMachine& saved, const TransformOptions& options) {
  constexpr std::size_t kUsualSteps = 10;
  const Mrbm& mrbm = mrbm_of(saved, options.model, "--infer");
  const std::vector<ModalityData> inputs = read_modalities(options.modalities, options.data.tensor);
  if (inputs.empty()) throw ConfigError("--infer: wants what is given, --modality NAME=FILE");
  const MrbmUnits modalities = mrbm_units(device, saved, mrbm, inputs);
  const std::size_t wanted = modality_of(mrbm, options.infer, "--infer");
  if (modalities.given[wanted])
    throw ConfigError(fmt::format("--infer {}: it is given", options.infer));
  mrbm.infer({modalities.units.begin(), modalities.units.end()}, modalities.given,
             options.steps.value_or(kUsualSteps));
  return unscaled(saved, modalities.units[wanted].to_host(), wanted);
}

void run_transform(const CommandContext& context, const TransformOptions& options) {
  check_matrix_output(options.output);
  if (!options.infer.empty() && !options.data.files.empty())
    throw ConfigError("data: --infer takes what --modality NAME=FILE gives, and no other files");
  Device device = Device::open({context.platform, context.device});
  const SavedMachine saved = load_machine(device, options.model);
  if (!options.infer.empty()) return put_matrix(options.output, inferred(device, saved, options));
  if (!options.modalities.empty())
    throw ConfigError("--modality is for --infer, which names the modality that is wanted");
  if (options.data.files.empty()) throw ConfigError("data: no files");
  if (options.steps && !options.inverse) throw ConfigError("--steps is for --inverse or --infer");
  const Cdbn stack = stack_of(saved, options.model);
  const Sequences data =
      Sequences::from_host(device, checked_and_scaled(saved, stack, options.data));
  const Sequences result =
      options.inverse ? reconstruct(stack, data, options.steps.value_or(1)) : stack.up_pass(data);
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
  add_matrix_input(*command, options->data, "data", "Matrices, each a sequence of its own");
  CLI::Option* inverse = command->add_flag(
      "--inverse", options->inverse,
      "Write the mean-field reconstruction of the data, in place of the hidden probabilities");
  add_setting_flag(*command, "--steps",
                   {"steps", within(1, 1000), "steps",
                    "Passes up and down of --inverse, at the top of a stack (default: 1), or "
                    "mean-field steps of --infer (default: 10)"},
                   options->steps);
  command
      ->add_option("--infer", options->infer,
                   "Modality of an MRBM to infer, by mean field, from those that --modality gives")
      ->type_name("NAME")
      ->excludes(inverse);
  add_modality_option(*command, options->modalities, "Given modalities of an MRBM");
  add_matrix_output(*command, context, options->output,
                    "File to write, .npy, .csv or .safetensors: the rows of all data that have a "
                    "history (default: CSV on standard output)");
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl transform --model digits.safetensors digits.npy -o code.npy\n"
      "  mcdbn-cl transform --model digits.safetensors digits.npy --inverse -o again.npy\n"
      "  mcdbn-cl transform --model m.safetensors --modality left=l.npy --infer right -o r.npy");
  run_with(*command, context, options, run_transform);
}

}  // namespace mcdbn::cli
