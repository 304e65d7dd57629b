#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "interrupt.hpp"
#include "mcdbn/errors.hpp"
#include "mcdbn/model/model_file.hpp"
#include "mcdbn/motion/clip.hpp"
#include "mcdbn/text_file.hpp"
#include "mcdbn/training/greedy_schedule.hpp"
#include "progress.hpp"
#include "training_options.hpp"

namespace mcdbn::cli {
namespace {

struct TrainOptions {
  std::vector<std::filesystem::path> data;
  std::filesystem::path run;
  TrainingOptions settings;
};

/// metrics.jsonl: one object an epoch.
class MetricsLog {
 public:
  explicit MetricsLog(const std::filesystem::path& path) : path_(path), stream_(path) {
    if (!stream_) throw InputError(fmt::format("{}: cannot be written", path.string()));
  }
  void add(const EpochReport& report) {
    const nlohmann::ordered_json line = {{"stage", report.stage},
                                         {"epoch", report.epoch},
                                         {"loss", report.loss},
                                         {"windows_per_s", report.windows_per_s}};
    stream_ << line.dump() << '\n' << std::flush;
    if (!stream_) throw InputError(fmt::format("{}: cannot be written", path_.string()));
  }

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
};

void make_run_folder(const std::filesystem::path& run, const TrainingConfig& config) {
  std::error_code error;
  std::filesystem::create_directories(run, error);
  if (error) throw InputError(fmt::format("{}: cannot be made: {}", run.string(), error.message()));
  write_text_file(run / "config.toml", settings_toml(config));
}

void run_train(const CommandContext& context, const TrainOptions& options) {
  const TrainingConfig config = options.settings.resolve();
  std::vector<std::string> notices;
  Device device = Device::open({context.platform, context.device});
  const InterruptGuard interrupt;
  const TrainingSet data = make_training_set(find_clips(options.data), config, &notices);
  for (const std::string& notice : notices) spdlog::info("{}", notice);
  make_run_folder(options.run, config);
  spdlog::info("{} clips, {} frames at {:g} fps on {}; 3D {} values a frame, 2D {}",
               data.clips.size(), data.frames(), config.fps, device.info().name,
               data.modalities.pose_scale.output_dimension(),
               data.modalities.track_scale.output_dimension());
  MetricsLog metrics(options.run / "metrics.jsonl");
  ProgressLine progress(context.quiet);
  Mcdbn network = train_greedy(device, data, config, [&](const EpochReport& report) {
    interrupt.check();
    metrics.add(report);
    progress.show(fmt::format("{} epoch {}/{}  loss {:.4f}  {:.0f} windows/s", report.stage,
                              report.epoch, report.epochs, report.loss, report.windows_per_s),
                  report.overall_progress);
  });
  const std::filesystem::path file = options.run / "model.safetensors";
  save_model(file, {std::move(network), data.modalities, data.clips, settings_json(config)});
  spdlog::info("{}: trained in {:.1f} s", file.string(), progress.elapsed_s());
}

}  // namespace

void add_train_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<TrainOptions>();
  CLI::App* command = app.add_subcommand("train", "Trains a model on BVH clips");
  command->add_option("data", options->data, "BVH files, or folders that hold some")
      ->required()
      ->type_name("PATH");
  command
      ->add_option("-o,--output", options->run,
                   "Run folder to write: model.safetensors, metrics.jsonl, config.toml")
      ->required()
      ->type_name("RUN");
  options->settings.add_to(*command);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl train walks/ -o run\n"
      "  mcdbn-cl train walks/ -o run --hidden 200 --gaussian-epochs 50 --platform Portable");
  command->callback(
      [&context, options] { context.run = [&context, options] { run_train(context, *options); }; });
}

}  // namespace mcdbn::cli
