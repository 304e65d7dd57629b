#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/counted.hpp"
#include "base/shown.hpp"
#include "commands.hpp"
#include "comparison/sweep.hpp"
#include "default_model.hpp"
#include "epoch_progress.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/motion_model/training_run.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "mcdbn/motion_model/training_start.hpp"
#include "setting_flags.hpp"
#include "training_options.hpp"

namespace mcdbn::cli {
namespace {

struct TrainOptions {
  std::vector<std::filesystem::path> data;
  std::filesystem::path run, resume;
  std::filesystem::path sweep, from;
  bool force = false, print_settings = false;
  TrainingOptions settings;
  CheckpointSettings checkpoints;
};

ClipStore read_clips(const RunFolder& run) {
  std::vector<std::string> notices;
  ClipStore clips = cached_training_clips(run.clips(), run.config(), run.clip_cache(), &notices);
  for (const std::string& notice : notices) spdlog::warn("{}", with_flags(notice));
  return clips;
}

/// Errors of a training that can be resumed name the command for it; one that never began leaves
/// no files.
template <typename Train>
void resumable(RunFolder& run, const Train& train) {
  const auto advice = [&](const char* what) {
    return fmt::format("{}; `mcdbn-cl train --resume {}` goes on from the last checkpoint", what,
                       run.model().parent_path().string());
  };
  try {
    train();
  } catch (const Interrupted& error) {
    throw Interrupted(advice(error.what()));
  } catch (const DeviceError& error) {
    if (run.discard_if_untrained()) throw;
    throw DeviceError(advice(error.what()), error.kind());
  } catch (...) {
    run.discard_if_untrained();
    throw;
  }
}

void train_run(const CommandContext& context, Device& device, const TrainOptions& options,
               RunFolder& run) {
  const TrainingConfig& config = run.config();
  std::optional<Model> start;
  if (run.started_from()) start = load_model(device, run.start_model());
  const ClipStore clips = read_clips(run);
  const TrainingSet data = start ? make_training_set(clips, start->modalities, config)
                                 : make_training_set(clips, config);
  spdlog::info("{}, {:.0f} frames at {:g} fps on {}; 3D {} values a frame, 2D {}",
               counted(clips.count(), "clip"), clips.frames_at(config.fps), config.fps,
               device.info().name, data.modalities.pose_scale.output_dimension(),
               data.modalities.track_scale.output_dimension());
  ProgressLine progress(context.quiet);
  const TrainedRun trained =
      train_to_folder(device, data, clips, run, options.checkpoints,
                      {shown_on(progress, device),
                       [](const std::string& text) { spdlog::warn("{}", with_flags(text)); }},
                      start ? &*start : nullptr);
  if (const auto& stopped = trained.model.early_stopping)
    spdlog::info("{} held out for early stopping: the model is that of mini-batch {} of {}",
                 fmt::join(stopped->held_out, ", "), stopped->steps, config.fine_tuning.steps);
  spdlog::info("{}: trained in {:.1f} s", run.model().string(), trained.training_s);
}

void train_once(const CommandContext& context, Device& device, const TrainOptions& options,
                RunFolder run) {
  resumable(run, [&] { train_run(context, device, options, run); });
}

/// A training is resumed with the clips and settings that it was begun with.
/// @throws ConfigError naming an option that would change them
void check_resume(const CLI::App& command) {
  constexpr std::array kAllowed{"--resume", "--checkpoint-minutes", "--platform", "--device",
                                "--quiet"};
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 && std::ranges::count(kAllowed, option->get_name()) == 0)
      throw ConfigError(fmt::format(
          "--resume goes on with the clips and settings that the training was begun with; leave {} "
          "out",
          option->get_name()));
}

void resume(const CommandContext& context, const TrainOptions& options) {
  RunFolder run = RunFolder::resume(options.resume);
  if (run.is_complete()) {
    spdlog::info("{}: training is already complete", run.model().string());
    return;
  }
  Device device = Device::open({context.platform, context.device});
  train_once(context, device, options, std::move(run));
}

void print_record(const nlohmann::ordered_json& record) {
  const auto name = printable(record["name"].get<std::string>());
  // null in a line of before: what is no number, as the correlation of what never moves.
  const auto figure = [&](const char* what) {
    const auto found = record.find(what);
    return found != record.end() && found->is_number() ? found->get<double>() : std::nan("");
  };
  if (record["status"] == "ok")
    fmt::print("{:<44}{:>10.1f}{:>14.3f}{:>12.3f}{:>10.1f}\n", name, figure("training_s"),
               figure("inference_ms_per_frame"), figure("pcc_channel"), figure("mpjpe_mm"));
  else
    fmt::print("{:<44}  failed: {}\n", name, printable(record.value("error", "")));
}

/// Checks the settings of all configurations before anything is trained.
/// @throws ConfigError for the first that are out of range
void check_sweep(const TrainingOptions& settings, const SweepFile& file) {
  std::vector<TrainingConfig> configs;
  for (const SweepConfiguration& configuration : file.configurations) {
    configs.push_back(settings.resolve(configuration));
    configs.back().validate();
  }
  settings.check_used(configs);
}

void train_sweep(const CommandContext& context, Device& device, const TrainOptions& options,
                 const std::vector<ListedClip>& clips, const SweepFile& file) {
  std::optional<ProgressLine> progress;
  const auto watch = [&](bool counts) {
    progress.emplace(context.quiet || !counts);
    return shown_on(*progress, device);
  };
  const auto resolve = [&](const SweepConfiguration& varied) {
    return options.settings.resolve(varied);
  };
  Sweep sweep(
      device, file.test, clips, resolve, options.run,
      [](const std::string& notice) { spdlog::warn("{}", with_flags(notice)); },
      options.checkpoints);
  std::vector<nlohmann::ordered_json> records;
  for (const SweepConfiguration& configuration : file.configurations) {
    spdlog::info("configuration {} of {}: {}", records.size() + 1, file.configurations.size(),
                 name_of(configuration));
    records.push_back(sweep.run(configuration, watch));
    progress.reset();
    if (records.back()["status"] != "ok")
      spdlog::warn("{}: {}", name_of(configuration), records.back()["error"].get<std::string>());
  }
  fmt::print("{:<44}{:>10}{:>14}{:>12}{:>10}\n", "", "train s", "ms a frame", "PCC channel",
             "MPJPE mm");
  for (const nlohmann::ordered_json& record : records) print_record(record);
  if (std::ranges::none_of(records, [](const auto& record) { return record["status"] == "ok"; }))
    throw Error(fmt::format("{}: every configuration failed, for the reason in its line",
                            (options.run / "sweep.jsonl").string()));
}

/// The model file that --from names; empty where it is not given.
std::filesystem::path start_of(const TrainOptions& options) {
  return options.from == "default" ? model_or_default({}, "--from default") : options.from;
}

/// The settings of a training that starts from that model.
TrainingConfig config_from(const Model& start, const TrainingOptions& settings) {
  TrainingConfig config = settings.resolve({}, settings_of_start(start));
  if (config.skeleton == SkeletonUse::shared)
    config.skeleton = is_humanoid(start.modalities.pose_features.skeleton()) ? SkeletonUse::humanoid
                                                                             : SkeletonUse::own;
  check_start(start, config);
  return config;
}

/// Prints the settings that a training with these options would have.
void print_settings(const CommandContext& context, const TrainOptions& options) {
  TrainingConfig config = options.settings.resolve();
  if (const std::filesystem::path from = start_of(options); !from.empty()) {
    Device device = Device::open({context.platform, context.device});
    config = config_from(load_model(device, from), options.settings);
  }
  options.settings.check_used({config});
  fmt::print("{}", settings_toml(config));
}

void run_train(const CommandContext& context, const TrainOptions& options,
               const CLI::App& command) {
  if (!options.resume.empty()) {
    check_resume(command);
    return resume(context, options);
  }
  if (!options.from.empty() && !options.sweep.empty())
    throw ConfigError("--sweep trains from random weights; leave --from out");
  if (options.force && !options.sweep.empty())
    throw ConfigError(
        "--force does not apply to --sweep, which trains only configurations without a score; to "
        "score again, remove sweep.jsonl");
  if (options.print_settings) return print_settings(context, options);
  if (options.data.empty() || options.run.empty())
    throw ConfigError("give clips to train on and --output RUN, or --resume RUN");
  TrainingConfig config = options.settings.resolve();
  const std::filesystem::path from = start_of(options);
  if (options.sweep.empty() && from.empty()) options.settings.check_used({config});
  const auto clips = find_listed_clips(options.data);
  std::optional<SweepFile> sweep;
  if (!options.sweep.empty()) sweep = read_sweep_file(options.sweep);
  if (sweep) check_sweep(options.settings, *sweep);
  Device device = Device::open({context.platform, context.device});
  if (sweep) return train_sweep(context, device, options, clips, *sweep);
  if (!from.empty()) {
    config = config_from(load_model(device, from), options.settings);
    options.settings.check_used({config});
  }
  train_once(context, device, options,
             RunFolder::begin(options.run, config, clips, options.force, from));
}

}  // namespace

void add_train_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* command = app.add_subcommand("train", "Trains a model on BVH clips");
  command
      ->add_option("data", options->data,
                   "BVH or AMC files, folders that hold some, or lists that `corpus` wrote")
      ->type_name("PATH");
  command
      ->add_option("-o,--output", options->run,
                   "Run folder to write: model.safetensors, metrics.jsonl, config.toml")
      ->type_name("RUN");
  command->add_flag("--force", options->force,
                    "Train anew in a run folder that holds a training already");
  command
      ->add_option(
          "--sweep", options->sweep,
          "TOML file of configurations to train and compare; RUN holds one folder for each, and "
          "sweep.jsonl. Run again, it skips configurations that have a score on these clips")
      ->type_name("FILE");
  command
      ->add_option("--from", options->from,
                   "Model to start from, in place of random weights: with its sizes, joints, "
                   "features and scaling, by fine-tuning alone; `default`: the general one that "
                   "comes with the program")
      ->type_name("FILE|default");
  options->settings.add_to(*command);
  command->add_flag("--print-settings", options->print_settings,
                    "Print the value of every setting, as a file for --config, and exit");
  command
      ->add_option(
          "--resume", options->resume,
          "Run folder of a training that was interrupted: goes on from its last checkpoint, "
          "to the same model, with the clips and settings that it was begun with")
      ->type_name("RUN");
  add_setting_flags(*command, options->checkpoints);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl train walks/ -o run\n"
      "  mcdbn-cl train walks/ -o run --hidden 200 --gaussian-epochs 50 --platform Portable\n"
      "  mcdbn-cl train --resume run\n"
      "  mcdbn-cl train waves/ -o run --from default --tracks detector --fine-tuning-steps 500\n"
      "  mcdbn-cl train walks/ -o sweep --sweep sweep.toml\n"
      "A sweep file: test = ['held_out/'] and [grid] with order = [3, 5], hidden = [100, 300] …, "
      "all\n"
      "combinations, or [[configuration]] tables of settings.\n"
      "Without fine-tuning other defaults hold: 100 --gaussian-epochs, 50 --binary-epochs, 30\n"
      "--mrbm-epochs, 2 --layers of --order 5 and 300 units. With it no --*-initial-deviation is\n"
      "used: the greedy stages begin with the first weights of fine-tuning.");
  run_with(*command, context, options,
           [command](const CommandContext& shared, const TrainOptions& chosen) {
             run_train(shared, chosen, *command);
           });
}

}  // namespace mcdbn::cli
