#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "base/counted.hpp"
#include "base/output_file.hpp"
#include "base/utf8.hpp"
#include "commands.hpp"
#include "epoch_progress.hpp"
#include "fit_data.hpp"
#include "learning/metrics_log.hpp"
#include "machine_settings.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/machine_fit.hpp"
#include "mcdbn/machines/size_limits.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "modality_options.hpp"
#include "setting_flags.hpp"

namespace mcdbn::cli {
namespace {

/// What --machine names.
struct MachineKind {
  const char* name;
  VisibleKind visible;
  bool has_history, is_stack;
};

constexpr std::array kKinds{
    MachineKind{"rbm", VisibleKind::binary, false, false},
    MachineKind{"gaussian-rbm", VisibleKind::gaussian, false, false},
    MachineKind{"crbm", VisibleKind::gaussian, true, false},
    MachineKind{"binary-crbm", VisibleKind::binary, true, false},
    MachineKind{"dbn", VisibleKind::binary, false, true},
    MachineKind{"gaussian-dbn", VisibleKind::gaussian, false, true},
    MachineKind{"cdbn", VisibleKind::gaussian, true, true},
    MachineKind{"binary-cdbn", VisibleKind::binary, true, true},
};

constexpr const char* kMrbm = "mrbm";

std::vector<std::string> kind_names() {
  std::vector<std::string> names{kMrbm};
  for (const MachineKind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

struct FitOptions {
  MatrixInput data;
  std::vector<std::string> modalities;  ///< NAME=FILE, of an MRBM
  std::vector<std::string> gaussian;    ///< names of its Gaussian ones
  std::filesystem::path output;
  std::string machine;
  bool standardize = false;
  MachineSettings settings;
  std::vector<std::size_t> widths, orders;  ///< of each layer, where they differ
  const CLI::App* command = nullptr;

  bool is_given(const std::string& flag) const { return command->get_option(flag)->count() > 0; }
  const MachineKind& kind() const {
    return *std::find_if(kKinds.begin(), kKinds.end(),
                         [&](const MachineKind& one) { return machine == one.name; });
  }
};

void check_flags(const FitOptions& options) {
  if (options.output.extension() != ".safetensors")
    throw ConfigError(
        fmt::format("--output {}: a machine's file is a .safetensors", options.output.string()));
  const bool is_mrbm = options.machine == kMrbm;
  const auto refuse = [&](const char* flag, const char* what) {
    if (options.is_given(flag))
      throw ConfigError(fmt::format("{}: --machine {} has no {}", flag, options.machine, what));
  };
  if (is_mrbm || !options.kind().has_history) {
    refuse("--order", "history");
    refuse("--orders", "history");
  }
  if (is_mrbm || !options.kind().is_stack) {
    refuse("--layers", "layers but one");
    refuse("--widths", "layers but one");
    refuse("--orders", "layers but one");
  }
  if (!is_mrbm) refuse("--gaussian", "modalities");
  if (is_mrbm != options.data.files.empty() || is_mrbm == options.modalities.empty())
    throw ConfigError(
        "data: --machine mrbm wants --modality NAME=FILE for each modality, every other machine "
        "files without names");
  if (options.standardize && !is_mrbm && options.kind().visible == VisibleKind::binary)
    throw ConfigError(fmt::format(
        "--standardize: --machine {} wants values from 0 to 1 as they are", options.machine));
  if (options.standardize && is_mrbm && options.gaussian.empty())
    throw ConfigError(
        "--standardize: no modality is --gaussian, and binary ones want values from 0 to 1 as they "
        "are");
}

/// Checks the flags alone: a settings file may serve several machines.
/// @throws ConfigError naming a flag of a setting that has no effect on this machine
void check_settings_used(const FitOptions& options, const MachineParts& machine) {
  const MachineSettings& settings = options.settings;
  visit_settings(settings, [&](const Setting& setting, const auto&) {
    const std::string flag = flag_of(setting.name);
    if (!options.is_given(flag)) return;
    std::string why = why_unused(machine, setting.name);
    if (why.empty())
      why = why_unused(settings.gaussian, settings.binary, settings.mrbm, setting.name);
    if (!why.empty())
      throw ConfigError(
          fmt::format("--machine {}: {} {}; leave it out", options.machine, flag, why));
  });
}

/// A machine that could not be saved where it belongs, as on a full disk, is kept among temporary
/// files. @return why it could not, and where it lies
std::string keep_elsewhere(const SavedMachine& machine, const std::filesystem::path& output,
                           const std::string& why) {
  const std::filesystem::path elsewhere = make_temporary_folder() / output.filename();
  if (!elsewhere.has_parent_path()) return why;
  try {
    const OutputsAtOnce to_stay;
    save_machine(elsewhere, machine);
  } catch (const InputError&) {
    return why;
  }
  return fmt::format("{}; the machine lies in {}: make room and move it to {}", why,
                     elsewhere.string(), output.string());
}

/// Where the data are why a training diverges, no rate helps.
/// @throws DivergenceError, with the advice
template <typename Fit>
SavedMachine with_advice(const std::string& advice, const Fit& fit) {
  try {
    return fit();
  } catch (const DivergenceError& error) {
    if (advice.empty()) throw;
    throw DivergenceError(fmt::format("{}; {}", error.what(), advice));
  }
}

/// Fits with the progress, the metrics and the way to stop that all machines share, and saves.
/// @param unscaled what far_from_standardized says of the data, or nothing
/// @param fit makes a SavedMachine on a device, given an observer
template <typename Fit>
void fit_and_save(const CommandContext& context, const FitOptions& options,
                  const std::string& unscaled, Fit&& fit) {
  if (!unscaled.empty()) spdlog::warn("{}", unscaled);
  Device device = Device::open({context.platform, context.device});
  std::filesystem::path metrics_path = options.output;
  OutputFile metrics_file(metrics_path.replace_extension(".metrics.jsonl"));
  MetricsLog metrics(metrics_file.temporary());
  ProgressLine progress(context.quiet);
  const EpochObserver show = shown_on(progress, device);
  const auto observe = [&](const EpochReport& report) {
    metrics.add(report);
    show(report);
  };
  SavedMachine saved = with_advice(unscaled, [&] { return fit(device, observe); });
  saved.config = settings_record(options.settings);
  saved.config["machine"] = options.machine;
  if (!options.widths.empty()) saved.config["widths"] = options.widths;
  if (!options.orders.empty()) saved.config["orders"] = options.orders;
  try {
    save_machine(options.output, saved);
    metrics.finish();
    metrics_file.put_in_place();
  } catch (const InputError& error) {
    throw InputError(keep_elsewhere(saved, options.output, error.what()));
  }
  spdlog::info("{}: fitted in {:.1f} s", options.output.string(), progress.elapsed_s());
}

void run_fit_mrbm(const CommandContext& context, const FitOptions& options) {
  check_settings_used(options, {.layers = {}, .has_mrbm = true});
  std::vector<ModalityData> inputs = read_modalities(options.modalities, options.data.tensor);
  if (inputs.size() < 2) throw ConfigError("--modality: give at least two");
  for (const std::string& name : options.gaussian)
    if (std::ranges::count(inputs, name, &ModalityData::name) == 0)
      throw ConfigError(fmt::format("--gaussian {}: there is no such --modality", name));
  std::vector<Modality> modalities;
  std::vector<ColumnScale> scales;
  std::string unscaled;
  for (ModalityData& input : inputs) {
    require_utf8(input.name, "--modality: a name");
    const bool is_gaussian = std::ranges::count(options.gaussian, input.name) > 0;
    modalities.push_back(
        {.name = input.name, .kind = is_gaussian ? VisibleKind::gaussian : VisibleKind::binary});
    ColumnScale scale =
        prepare(input.data, input.files, modalities.back().kind, options.standardize);
    if (options.standardize) scales.push_back(std::move(scale));
    if (is_gaussian && unscaled.empty())
      unscaled = far_from_standardized(input.data, input.files, false);
  }
  fit_and_save(context, options, unscaled, [&](Device& device, const EpochObserver& observer) {
    std::vector<Sequences> data;
    data.reserve(inputs.size());
    for (const ModalityData& input : inputs)
      data.push_back(Sequences::from_host(device, input.data));
    spdlog::info("{} modalities, {} on {}", data.size(), counted(data.front().values.rows(), "row"),
                 device.info().name);
    return SavedMachine{fit_mrbm(device, modalities, data, options.settings, observer), scales};
  });
}

/// The layers from below, by --widths and --orders where they are given.
std::vector<LayerSize> layer_sizes(const FitOptions& options) {
  const auto &widths = options.widths, &orders = options.orders;
  std::vector<LayerSize> sizes = equal_layers(options.settings, options.kind().has_history);
  const std::size_t layers = !widths.empty()           ? widths.size()
                             : !orders.empty()         ? orders.size()
                             : options.kind().is_stack ? sizes.size()
                                                       : 1;
  if (!orders.empty() && orders.size() != layers)
    throw ConfigError(
        fmt::format("--orders: {} numbers, but --widths has {}", orders.size(), widths.size()));
  sizes.resize(layers, sizes.front());
  for (std::size_t i = 0; i < layers; ++i) {
    if (!widths.empty()) sizes[i].hidden = widths[i];
    if (!orders.empty()) sizes[i].order = orders[i];
  }
  return sizes;
}

MachineParts parts_of(VisibleKind lowest, const std::vector<LayerSize>& layers) {
  MachineParts parts;
  for (const LayerSize& layer : layers)
    parts.layers.push_back({parts.layers.empty() ? lowest : VisibleKind::binary, layer.order > 0});
  return parts;
}

void run_fit(const CommandContext& context, const FitOptions& options) {
  check_flags(options);
  options.settings.validate();
  if (options.machine == kMrbm) return run_fit_mrbm(context, options);
  const MachineKind& kind = options.kind();
  const std::vector<LayerSize> layers = layer_sizes(options);
  check_settings_used(options, parts_of(kind.visible, layers));
  std::size_t history = 0;
  for (const LayerSize& layer : layers) history += layer.order;
  std::vector<MatrixF> data = options.data.read();
  const ColumnScale scale = prepare(data, options.data, kind.visible, options.standardize);
  check_lengths(data, history, options.data.files);
  const bool learns_deviation =
      options.settings.gaussian.deviation_rate > 0 && layers.front().order == 0;
  const std::string unscaled = kind.visible == VisibleKind::gaussian
                                   ? far_from_standardized(data, options.data, learns_deviation)
                                   : std::string();
  fit_and_save(context, options, unscaled, [&](Device& device, const EpochObserver& observer) {
    const Sequences sequences = Sequences::from_host(device, data);
    spdlog::info("{}, {} of {} on {}", counted(data.size(), "file"),
                 counted(sequences.values.rows(), "row"),
                 counted(sequences.values.columns(), "value"), device.info().name);
    const Cdbn stack =
        fit_stack(device, sequences, kind.visible, layers, options.settings, observer);
    SavedMachine saved{stack};
    if (!kind.is_stack) saved.machine = stack.layers.front();
    if (options.standardize) saved.scales.push_back(scale);
    return saved;
  });
}

/// Before the flags of the settings: options are taken in the order in which they were added, so
/// that flags override the file.
void add_config_option(CLI::App& command, MachineSettings& settings) {
  command
      .add_option_function<std::filesystem::path>(
          "--config",
          [&settings](const std::filesystem::path& file) {
            for (const GivenSetting& given : read_settings_file(file))
              assign_setting(settings, given);
          },
          "TOML file of settings; flags override it")
      ->type_name("FILE");
}

/// A width and an order for each layer of a stack.
void add_layer_options(CLI::App& command, FitOptions& options) {
  const auto add = [&](const char* flag, std::vector<std::size_t>& values, const char* help,
                       const CLI::Validator& range, const char* unit) {
    return command.add_option(flag, values, help)
        ->delimiter(',')
        ->expected(1, static_cast<int>(size_limits::kLayers.most))
        ->check(range)
        ->type_name(unit)
        ->excludes(command.get_option("--layers"));
  };
  add("--widths", options.widths, "Hidden units of each layer of a stack, from below: 300,150",
      in_range(size_limits::kUnits), "UNITS,…")
      ->excludes(command.get_option("--hidden"));
  add("--orders", options.orders, "History of each layer of a stack, from below: 5,3",
      in_range(size_limits::kHistory), "FRAMES,…")
      ->excludes(command.get_option("--order"));
}

}  // namespace

void add_fit_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* command = app.add_subcommand("fit", "Fits a single machine to matrices of any data");
  options->command = command;
  add_matrix_input(*command, options->data, "data",
                   "Matrices, a row for each case or frame; each file is a sequence of its own");
  add_modality_option(
      *command, options->modalities,
      "Matrices of an MRBM's modalities, each with its name; the files of a name are "
      "sequences, as many and as long as those of every other name");
  command
      ->add_option("--gaussian", options->gaussian,
                   "Modalities of an MRBM whose units are Gaussian; the others are binary")
      ->type_name("NAME");
  command
      ->add_option("--machine", options->machine,
                   "rbm, gaussian-rbm: without history; crbm (Gaussian), binary-crbm: with "
                   "history; dbn, gaussian-dbn, cdbn, binary-cdbn: stacks of them, named by the "
                   "lowest layer; mrbm: of several modalities")
      ->required()
      ->check(CLI::IsMember(kind_names()));
  mark_output(
      command->add_option("-o,--output", options->output,
                          "File to write, machine.safetensors; beside it machine.metrics.jsonl"),
      context)
      ->required()
      ->type_name("FILE");
  command->add_flag("--standardize", options->standardize,
                    "Scale each column to mean 0 and deviation 1, which Gaussian units need; kept "
                    "in the file, and undone on output");
  add_config_option(*command, options->settings);
  add_setting_flags(*command, options->settings);
  add_layer_options(*command, *options);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl fit digits.npy --machine rbm --hidden 256 -o digits.safetensors\n"
      "  mcdbn-cl fit a.csv b.csv --machine crbm --order 5 --standardize -o walk.safetensors\n"
      "  mcdbn-cl fit --machine mrbm --modality left=l.npy --modality right=r.npy -o "
      "m.safetensors");
  run_with(*command, context, options, run_fit);
}

}  // namespace mcdbn::cli
