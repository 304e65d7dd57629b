#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "commands.hpp"
#include "learning/unit_values.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "modality_options.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

struct SampleOptions {
  std::filesystem::path model, output;
  MatrixInput given;
  std::vector<std::string> modalities;  ///< NAME=FILE, of an MRBM
  std::string infer;                    ///< its modality that is wanted
  std::size_t count = 1;
  ChainSettings chains;
};

void log_chains(const Device& device, std::size_t chains, const SampleOptions& options) {
  spdlog::info("{} chains of {} steps on {}", chains, options.chains.steps, device.info().name);
}

/// Rows [count x visible] of free chains.
MatrixF free_samples(Device& device, const Cdbn& stack, const SampleOptions& options) {
  if (stack.total_order() > 0)
    throw ConfigError(
        "--given: wanted by a machine with a history, a sequence whose rows to draw are NaN");
  const Matrix start = Matrix::filled_with_row(stack.layers.front().visible_mean, options.count);
  log_chains(device, options.count, options);
  return sample(stack, start, options.chains).to_host();
}

/// The given sequences with what was NaN in them drawn, `count` times over, in the data's units.
MatrixF given_samples(Device& device, const Cdbn& stack, const SavedMachine& saved,
                      const SampleOptions& options) {
  const CrbmShape shape = stack.layers.front().shape();
  const std::vector<MatrixF> given = options.given.read();
  for (std::size_t i = 0; i < given.size(); ++i)
    check_unit_values(given[i], shape.kind, options.given.files[i].string(), true);
  std::vector<MatrixF> copies;
  for (std::size_t i = 0; i < options.count; ++i)
    copies.insert(copies.end(), given.begin(), given.end());
  const MatrixF known = stacked(copies, 0);
  const Sequences start =
      Sequences::from_host(device, scaled(saved, std::move(copies), shape.visible, options.given));
  const MatrixF drawn =
      unscaled(saved, stacked(sample_given(stack, start, options.chains).to_host(), 0));
  return known.array().isNaN().select(drawn, known);  // scaling and back rounds what is given
}

/// The wanted modality of an MRBM's chains, in the units of its data: free chains, or those of each
/// row of what is given, `count` times over.
MatrixF mrbm_samples(Device& device, const SavedMachine& saved, const SampleOptions& options) {
  const Mrbm& mrbm = mrbm_of(saved, options.model, "--modality and --infer");
  if (!options.given.files.empty())
    throw ConfigError("--given: what is known of an MRBM is given by --modality NAME=FILE");
  if (options.infer.empty()) throw ConfigError("--infer: wanted by an MRBM, the modality to draw");
  const std::size_t wanted = modality_of(mrbm, options.infer, "--infer");
  const MrbmUnits modalities =
      mrbm_units(device, saved, mrbm, read_modalities(options.modalities, options.given.tensor),
                 options.count);
  if (modalities.given[wanted])
    throw ConfigError(fmt::format("--infer {}: it is given", options.infer));
  log_chains(device, modalities.rows(), options);
  const std::vector<Matrix> drawn =
      sample(mrbm, modalities.units, modalities.given, modalities.rows(), options.chains);
  return unscaled(saved, drawn[wanted].to_host(), wanted);
}

/// Samples of an RBM, a CRBM or a stack of them.
MatrixF stack_samples(Device& device, const SavedMachine& saved, const SampleOptions& options) {
  const Cdbn stack = stack_of(saved, options.model);
  return options.given.files.empty() ? unscaled(saved, free_samples(device, stack, options))
                                     : given_samples(device, stack, saved, options);
}

void run_sample(const CommandContext& context, const SampleOptions& options) {
  check_matrix_output(options.output);
  check_settings(options.chains);
  Device device = Device::open({context.platform, context.device});
  const SavedMachine saved = load_machine(device, options.model);
  const bool joint = std::holds_alternative<Mrbm>(saved.machine) || !options.infer.empty() ||
                     !options.modalities.empty();
  put_matrix(options.output,
             joint ? mrbm_samples(device, saved, options) : stack_samples(device, saved, options));
}

}  // namespace

void add_sample_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<SampleOptions>();
  CLI::App* command = app.add_subcommand("sample", "Draws from a single machine by Gibbs steps");
  add_machine_option(*command, options->model);
  add_matrix_input(*command, options->given, "--given",
                   "Matrices of given values, NaN (an empty cell) where a unit is to be drawn; "
                   "without them free chains, of a machine without history");
  add_modality_option(*command, options->modalities,
                      "Given modalities of an MRBM, which stay fixed; the others are drawn");
  command->add_option("--infer", options->infer, "Modality of an MRBM whose draws are written")
      ->type_name("NAME");
  add_setting_flag(*command, "--count",
                   {"count", within(1, 1e6), "samples",
                    "Number of free chains, or of draws for all that is given"},
                   options->count);
  add_setting_flags(*command, options->chains);
  add_matrix_output(*command, context, options->output,
                    "File to write, .npy, .csv or .safetensors: a row a sample, or the rows of "
                    "all that was given (default: CSV on standard output)");
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl sample --model digits.safetensors --count 64 -o digits.npy\n"
      "  mcdbn-cl sample --model digits.safetensors --given left_halves.csv --means >whole.csv\n"
      "  mcdbn-cl sample --model m.safetensors --modality left=l.npy --infer right -o r.npy");
  run_with(*command, context, options, run_sample);
}

}  // namespace mcdbn::cli
