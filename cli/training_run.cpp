#include "training_run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"
#include "motion_model/sample_calibration.hpp"
#include "progress.hpp"
#include "training_options.hpp"

namespace mcdbn::cli {
namespace {

/// metrics.jsonl: one object an epoch, with the layer's health now and then.
class MetricsLog {
 public:
  explicit MetricsLog(const std::filesystem::path& path) : path_(path), stream_(path) {
    if (!stream_) throw InputError(fmt::format("{}: cannot be written", path.string()));
  }
  void add(const EpochReport& report) {
    nlohmann::ordered_json line = {{"stage", report.stage},
                                   {"epoch", report.epoch},
                                   {"loss", report.loss},
                                   {"windows_per_s", report.windows_per_s}};
    // Up to version 0.1 fine-tuning was called so.
    if (report.stage == "fine-tuning") line["former_stage"] = "joint";
    if (report.held_out_loss) line["held_out_loss"] = *report.held_out_loss;
    if (report.health) append(line, *report.health);
    stream_ << line.dump() << '\n' << std::flush;
    if (!stream_) throw InputError(fmt::format("{}: cannot be written", path_.string()));
  }

 private:
  static void append(nlohmann::ordered_json& line, const LayerHealth& health) {
    line["hidden_activity"] = health.hidden_activity;
    line["saturation"] = health.saturation;
    line["weight_norm"] = health.weight_norm;
    if (health.weight_norm_A) line["weight_norm_A"] = *health.weight_norm_A;
    if (health.weight_norm_B) line["weight_norm_B"] = *health.weight_norm_B;
    if (health.free_run_error) line["free_run_error"] = *health.free_run_error;
  }

  std::filesystem::path path_;
  std::ofstream stream_;
};

void make_run_folder(const std::filesystem::path& run, const TrainingConfig& config) {
  std::error_code error;
  std::filesystem::create_directories(run, error);
  if (error) throw InputError(fmt::format("{}: cannot be made: {}", run.string(), error.message()));
  write_text_file(run / "config.toml", settings_toml(config));
}

}  // namespace

TrainedRun train_to_folder(const CommandContext& context, Device& device,
                           const std::vector<std::filesystem::path>& files,
                           const TrainingConfig& config, const std::filesystem::path& run,
                           const InterruptGuard& interrupt) {
  std::vector<std::string> notices;
  std::vector<LoadedClip> clips = load_clips(files, config.keep_first_frame, &notices);
  const TrainingSet data = make_training_set(clips, config);
  for (const std::string& notice : notices) spdlog::info("{}", notice);
  make_run_folder(run, config);
  spdlog::info("{} clips, {} frames at {:g} fps on {}; 3D {} values a frame, 2D {}",
               data.clips.size(), data.frames(), config.fps, device.info().name,
               data.modalities.pose_scale.output_dimension(),
               data.modalities.track_scale.output_dimension());
  MetricsLog metrics(run / "metrics.jsonl");
  ProgressLine progress(context.quiet);
  const auto observer = [&](const EpochReport& report) {
    interrupt.check();
    metrics.add(report);
    progress.show(fmt::format("{} epoch {}/{}  loss {:.4f}  {:.0f} windows/s", report.stage,
                              report.epoch, report.epochs, report.loss, report.windows_per_s),
                  report.overall_progress);
  };
  auto [network, stopped] = train_network(device, data, std::move(clips), config, observer);
  if (stopped)
    spdlog::info("{} kept out to stop early: stopped after {} of {} mini-batches",
                 fmt::join(stopped->held_out, ", "), stopped->steps, config.fine_tuning.steps);
  if (config.fine_tuning.steps > 0)
    network.sampling = calibrated_sampling(network, data.modalities, data.tracks, data.poses);
  TrainedRun trained{
      {std::move(network), data.modalities, data.clips, settings_json(config), std::move(stopped)},
      progress.elapsed_s()};
  const std::filesystem::path file = run / "model.safetensors";
  save_model(file, trained.model);
  spdlog::info("{}: trained in {:.1f} s", file.string(), trained.training_s);
  return trained;
}

}  // namespace mcdbn::cli
