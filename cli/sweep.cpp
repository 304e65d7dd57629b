#include "sweep.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <sstream>

#include "base/text_file.hpp"
#include "comparison/comparison_run.hpp"
#include "interrupt.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "training_options.hpp"
#include "training_run.hpp"

namespace mcdbn::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// sweep.jsonl, kept whole: a line that was cut off by a crash is dropped.
class SweepLog {
 public:
  explicit SweepLog(fs::path path) : path_(std::move(path)) {
    if (!fs::exists(path_)) return;
    std::istringstream lines(read_text_file(path_));
    for (std::string line; std::getline(lines, line);) {
      ordered_json record = ordered_json::parse(line, nullptr, false);
      if (record.is_object() && record.contains("settings")) records_.push_back(std::move(record));
    }
  }
  const ordered_json* find(const ordered_json& settings) const {
    for (const ordered_json& record : records_)
      if (nlohmann::json(record.at("settings")) == nlohmann::json(settings)) return &record;
    return nullptr;
  }
  void add(ordered_json record) {
    records_.push_back(std::move(record));
    std::string text;
    for (const ordered_json& entry : records_) text += entry.dump() + '\n';
    write_text_file(path_, text);
  }

 private:
  fs::path path_;
  std::vector<ordered_json> records_;
};

std::string name_of(const SweepConfiguration& configuration) {
  std::string name;
  for (const SweepSetting& setting : configuration)
    name += (name.empty() ? "" : ",") + setting.name + "=" + setting.value.dump();
  return name.empty() ? "base" : name;
}

/// Seconds to regenerate all clips; a first run builds the kernels.
double inference_s(const Model& model, const std::vector<ClipResult>& results) {
  std::vector<MatrixF> tracks;
  tracks.reserve(results.size());
  for (const ClipResult& result : results) tracks.push_back(result.truth.track_features);
  regenerate(model.network, {tracks.front()});
  const auto start = std::chrono::steady_clock::now();
  regenerate(model.network, tracks);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class Sweep {
 public:
  Sweep(const CommandContext& context, const SweepFile& file, const std::vector<fs::path>& clips,
        const TrainingOptions& base, fs::path run)
      : context_(context),
        device_(Device::open({context.platform, context.device})),
        test_(find_clips(file.test)),
        clips_(clips),
        base_(base),
        run_(std::move(run)),
        log_((make_folder(run_), run_ / "sweep.jsonl")) {}

  /// @return the record, also of a configuration that failed, or was done before
  ordered_json run(const SweepConfiguration& configuration) {
    ordered_json record = {{"name", name_of(configuration)}, {"configuration", ordered_json()}};
    for (const SweepSetting& setting : configuration)
      record["configuration"][setting.name] = setting.value;
    try {
      const TrainingConfig config = base_.resolve([&](TrainingConfig& changed) {
        for (const SweepSetting& setting : configuration)
          assign_setting(changed, setting.name, setting.value, setting.where);
      });
      record["settings"] = settings_json(config);
      if (const ordered_json* done = log_.find(record["settings"])) return *done;
      config.validate();
      score(config, record);
    } catch (const Interrupted&) {
      throw;
    } catch (const DeviceError&) {
      throw;  // the next one would fail too
    } catch (const std::exception& error) {
      if (!record.contains("settings")) record["settings"] = record["configuration"];
      if (const ordered_json* done = log_.find(record["settings"])) return *done;
      record["status"] = "failed";
      record["error"] = error.what();
    }
    log_.add(record);
    return record;
  }

 private:
  static void make_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
      throw InputError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  }

  /// An epoch or mini-batch of everything first: no configuration is charged for compiling.
  void build_kernels(TrainingConfig config, const fs::path& folder) {
    config.gaussian.epochs = config.binary.epochs = config.mrbm.epochs = 1;
    config.fine_tuning.steps = std::min<std::size_t>(config.fine_tuning.steps, 1);
    CommandContext silent = context_;
    silent.quiet = true;
    train_to_folder(silent, device_, clips_, config, folder, interrupt_);
  }

  void score(const TrainingConfig& config, ordered_json& record) {
    const fs::path folder = run_ / record["name"].get<std::string>();
    build_kernels(config, folder);
    const TrainedRun trained =
        train_to_folder(context_, device_, clips_, config, folder, interrupt_);
    TestRunOptions options;
    options.camera = trained.model.modalities.camera;
    options.baselines = false;
    options.fit.reset();  // it is networks that are compared, not what the track makes of them
    const auto results = run_test(trained.model, test_, options);
    std::vector<ClipScore> scores;
    int frames = 0;
    for (const ClipResult& result : results) {
      scores.push_back(result.samples.front().score);
      frames += result.truth.motion.frames();
    }
    const ClipScore mean = mean_score(scores);
    const double seconds = inference_s(trained.model, results);
    record["status"] = "ok";
    record["training_s"] = trained.training_s;
    record["inference_s"] = seconds;
    record["inference_ms_per_frame"] = 1000.0 * seconds / frames;
    record["clips"] = results.size();
    record["frames"] = frames;
    record["pcc_flat"] = mean.pcc_flat;
    record["pcc_channel"] = mean.pcc_channel;
    record["mpjpe_mm"] = mean.error.mpjpe_mm;
  }

  const CommandContext& context_;
  Device device_;
  InterruptGuard interrupt_;
  std::vector<fs::path> test_;
  const std::vector<fs::path>& clips_;
  const TrainingOptions& base_;
  fs::path run_;
  SweepLog log_;
};

void print_record(const ordered_json& record) {
  const std::string name = record["name"].get<std::string>();
  if (record["status"] == "ok")
    fmt::print("{:<44}{:>10.1f}{:>14.3f}{:>12.3f}{:>10.1f}\n", name,
               record["training_s"].get<double>(), record["inference_ms_per_frame"].get<double>(),
               record["pcc_channel"].get<double>(), record["mpjpe_mm"].get<double>());
  else
    fmt::print("{:<44}  failed: {}\n", name, record["error"].get<std::string>());
}

}  // namespace

void run_sweep(const CommandContext& context, const SweepFile& file,
               const std::vector<fs::path>& clips, const TrainingOptions& base,
               const fs::path& run) {
  Sweep sweep(context, file, clips, base, run);
  std::vector<ordered_json> records;
  for (const SweepConfiguration& configuration : file.configurations) {
    spdlog::info("configuration {} of {}: {}", records.size() + 1, file.configurations.size(),
                 name_of(configuration));
    records.push_back(sweep.run(configuration));
    if (records.back()["status"] != "ok")
      spdlog::warn("{}: {}", name_of(configuration), records.back()["error"].get<std::string>());
  }
  fmt::print("{:<44}{:>10}{:>14}{:>12}{:>10}\n", "", "train s", "ms a frame", "PCC channel",
             "MPJPE mm");
  for (const ordered_json& record : records) print_record(record);
}

}  // namespace mcdbn::cli
