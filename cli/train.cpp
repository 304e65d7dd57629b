#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "comparison/sweep.hpp"
#include "epoch_progress.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "mcdbn/motion_model/training_run.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "setting_flags.hpp"
#include "training_options.hpp"

namespace mcdbn::cli {
namespace {

struct TrainOptions {
  std::vector<std::filesystem::path> data;
  std::filesystem::path run;
  std::filesystem::path sweep;
  TrainingOptions settings;
};

std::vector<LoadedClip> read_clips(const std::vector<ListedClip>& files,
                                   const TrainingConfig& config) {
  std::vector<std::string> notices;
  std::vector<LoadedClip> clips = load_training_clips(files, config, &notices);
  for (const std::string& notice : notices) spdlog::info("{}", with_flags(notice));
  return clips;
}

void train_once(const CommandContext& context, Device& device, const TrainOptions& options,
                const std::vector<ListedClip>& files, const TrainingConfig& config) {
  std::vector<LoadedClip> clips = read_clips(files, config);
  const TrainingSet data = make_training_set(clips, config);
  spdlog::info("{} clips, {} frames at {:g} fps on {}; 3D {} values a frame, 2D {}",
               data.clips.size(), data.frames(), config.fps, device.info().name,
               data.modalities.pose_scale.output_dimension(),
               data.modalities.track_scale.output_dimension());
  const InterruptGuard interrupt;
  ProgressLine progress(context.quiet);
  const TrainedRun trained = train_to_folder(device, data, std::move(clips), config, options.run,
                                             shown_on(progress, interrupt));
  if (const auto& stopped = trained.model.early_stopping)
    spdlog::info("{} kept out to stop early: stopped after {} of {} mini-batches",
                 fmt::join(stopped->held_out, ", "), stopped->steps, config.fine_tuning.steps);
  spdlog::info("{}: trained in {:.1f} s", (options.run / "model.safetensors").string(),
               trained.training_s);
}

void print_record(const nlohmann::ordered_json& record) {
  const std::string name = record["name"].get<std::string>();
  if (record["status"] == "ok")
    fmt::print("{:<44}{:>10.1f}{:>14.3f}{:>12.3f}{:>10.1f}\n", name,
               record["training_s"].get<double>(), record["inference_ms_per_frame"].get<double>(),
               record["pcc_channel"].get<double>(), record["mpjpe_mm"].get<double>());
  else
    fmt::print("{:<44}  failed: {}\n", name, record["error"].get<std::string>());
}

void train_sweep(const CommandContext& context, Device& device, const TrainOptions& options,
                 const std::vector<ListedClip>& clips, const SweepFile& file) {
  const InterruptGuard interrupt;
  std::optional<ProgressLine> progress;
  const auto watch = [&](bool counts) {
    progress.emplace(context.quiet || !counts);
    return shown_on(*progress, interrupt);
  };
  const auto resolve = [&](const SweepConfiguration& varied) {
    return options.settings.resolve(varied);
  };
  Sweep sweep(device, file.test, clips, resolve, options.run);
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
}

void run_train(const CommandContext& context, const TrainOptions& options) {
  const TrainingConfig config = options.settings.resolve();
  const auto clips = find_listed_clips(options.data);
  std::optional<SweepFile> sweep;
  if (!options.sweep.empty()) sweep = read_sweep_file(options.sweep);
  Device device = Device::open({context.platform, context.device});
  if (sweep)
    train_sweep(context, device, options, clips, *sweep);
  else
    train_once(context, device, options, clips, config);
}

}  // namespace

void add_train_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* command = app.add_subcommand("train", "Trains a model on BVH clips");
  command
      ->add_option("data", options->data,
                   "BVH or AMC files, folders that hold some, or lists that `corpus` wrote")
      ->required()
      ->type_name("PATH");
  command
      ->add_option("-o,--output", options->run,
                   "Run folder to write: model.safetensors, metrics.jsonl, config.toml")
      ->required()
      ->type_name("RUN");
  command
      ->add_option(
          "--sweep", options->sweep,
          "TOML file of configurations to train and compare; RUN holds one folder for each, "
          "and sweep.jsonl. Run again, it goes on where it stopped")
      ->type_name("FILE");
  options->settings.add_to(*command);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl train walks/ -o run\n"
      "  mcdbn-cl train walks/ -o run --hidden 200 --gaussian-epochs 50 --platform Portable\n"
      "  mcdbn-cl train walks/ -o sweep --sweep sweep.toml\n"
      "A sweep file: test = ['held_out/'] and [grid] with order = [3, 5], hidden = [100, 300] …, "
      "all\n"
      "combinations, or [[configuration]] tables of settings.");
  command->callback(
      [&context, options] { context.run = [&context, options] { run_train(context, *options); }; });
}

}  // namespace mcdbn::cli
