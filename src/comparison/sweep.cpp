#include "comparison/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <sstream>

#include "base/interruption.hpp"
#include "base/parsed_json.hpp"
#include "base/text_file.hpp"
#include "base/user_cache.hpp"
#include "comparison/comparison_run.hpp"
#include "corpus/encoded_clip.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "mcdbn/formats/motion_file.hpp"
#include "mcdbn/motion/joint_role.hpp"
#include "mcdbn/motion_model/training_run.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// @throws InputError if a test clip does not become one of the model that is to be trained
void check_test_clips(const std::vector<fs::path>& test, const Modalities& modalities,
                      const TrainingConfig& config) {
  for (const fs::path& file : test) {
    check_interruption();
    encode_clip(file, modalities, modalities.camera, config.keep_first_frame, nullptr,
                config.joint_map);
  }
}

/// No configuration is charged for compiling. The test clips are checked before.
void build_kernels(Device& device, const std::vector<ListedClip>& files,
                   const std::vector<fs::path>& test, const TrainingConfig& config,
                   const Sweep::Watch& watch, std::vector<std::string>& notices) {
  const ClipStore clips = load_training_clips(files, config, &notices);
  const TrainingSet data = make_training_set(clips, config);
  check_test_clips(test, data.modalities, config);
  train_model(device, data, clips, config, watch ? watch(false) : EpochObserver());
}

TrainedRun trained_run(Device& device, const std::vector<ListedClip>& files,
                       const TrainingConfig& config, const fs::path& folder,
                       const CheckpointSettings& checkpoints, const Sweep::Watch& watch) {
  RunFolder run = RunFolder::begin(folder, config, files, true);
  const ClipStore clips = load_training_clips(files, config);
  const TrainingSet data = make_training_set(clips, config);
  return train_to_folder(device, data, clips, run, checkpoints,
                         {.epoch = watch ? watch(true) : EpochObserver()});
}

/// An epoch or mini-batch of everything.
TrainingConfig shortest(TrainingConfig config) {
  config.gaussian.epochs = config.binary.epochs = config.mrbm.epochs = 1;
  config.fine_tuning.steps = std::min<std::size_t>(config.fine_tuning.steps, 1);
  return config;
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

/// By their bytes, whatever their names.
/// @throws ConfigError if a test clip is to be trained on, InputError if it cannot be read
nlohmann::json identified_clips(const std::vector<ListedClip>& training,
                                const std::vector<fs::path>& test) {
  nlohmann::json clips;
  std::vector<TrainingClip> trained_on;
  for (const ListedClip& clip : training) {
    check_interruption();
    trained_on.push_back(identify_clip(clip.file));
    clips["training"].push_back({trained_on.back().fingerprint, clip.person, clip.action});
  }
  for (const fs::path& file : test) {
    check_interruption();
    const TrainingClip clip = identify_clip(file);
    if (is_among(trained_on, clip))
      throw ConfigError(fmt::format(
          "{}: is to be trained on, too; a sweep is scored on other clips, so leave it out of one",
          file.string()));
    read_motion(file);
    clips["test"].push_back(clip.fingerprint);
  }
  return clips;
}

/// The name of a configuration, or its beginning and a hash where file systems take none so long.
std::string folder_name_of(const std::string& name) {
  constexpr std::size_t kLongest_bytes = 255, kKept_bytes = 200;
  if (name.size() <= kLongest_bytes) return name;
  return fmt::format("{}-{:016x}", name.substr(0, kKept_bytes), fnv1a(name));
}

/// Whether the next configuration would fail, too.
bool ends_sweep(const std::exception& error) {
  if (dynamic_cast<const Interrupted*>(&error)) return true;
  const auto* device = dynamic_cast<const DeviceError*>(&error);
  return device && device->kind() == DeviceError::Kind::no_device;
}

void require_folder(const fs::path& folder) {
  const OutputsAtOnce to_stay;
  make_folder(folder);
}

}  // namespace

std::string name_of(const SweepConfiguration& configuration) {
  std::string name;
  for (const GivenSetting& setting : configuration)
    name += (name.empty() ? "" : ",") + setting.name + "=" + setting.value.dump();
  return name.empty() ? "base" : name;
}

Sweep::Log::Log(fs::path path) : path_(std::move(path)) {
  if (!fs::exists(path_)) return;
  std::istringstream lines(read_text_file(path_));
  for (std::string line; std::getline(lines, line);) {
    auto record = parsed_json<ordered_json>(line);
    if (record.is_object() && record.contains("settings") && record["name"].is_string() &&
        record["status"].is_string())
      records_.push_back(std::move(record));
  }
}

const ordered_json* Sweep::Log::scored(const ordered_json& wanted) const {
  for (const ordered_json& record : records_) {
    const auto has_same = [&](const char* what) {  // an older program's lines have no fingerprint
      return record.contains(what) &&
             nlohmann::json(record.at(what)) == nlohmann::json(wanted.at(what));
    };
    if (record.at("status") == "ok" && has_same("settings") && has_same("fingerprint"))
      return &record;
  }
  return nullptr;
}

void Sweep::Log::add(ordered_json record) {
  std::erase_if(records_,
                [&](const ordered_json& other) { return other.at("name") == record.at("name"); });
  records_.push_back(std::move(record));
  std::string text;
  for (const ordered_json& entry : records_)
    text += entry.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + '\n';
  const OutputsAtOnce after_each;
  write_text_file(path_, text);
}

Sweep::Sweep(Device& device, const std::vector<fs::path>& test, std::vector<ListedClip> clips,
             Resolve resolve, fs::path run, Notices notices, const CheckpointSettings& checkpoints)
    : device_(device),
      test_(find_clips(test)),
      clips_(std::move(clips)),
      data_(identified_clips(clips_, test_)),
      resolve_(std::move(resolve)),
      run_(std::move(run)),
      notices_(std::move(notices)),
      checkpoints_(checkpoints),
      lock_((require_folder(run_), run_)),
      log_(run_ / "sweep.jsonl") {}

ordered_json Sweep::run(const SweepConfiguration& configuration, const Watch& watch) {
  ordered_json record = {{"name", name_of(configuration)}, {"configuration", ordered_json()}};
  for (const GivenSetting& setting : configuration)
    record["configuration"][setting.name] = setting.value;
  try {
    const TrainingConfig config = resolve_(configuration);
    record["settings"] = settings_json(config);
    record["fingerprint"] = fingerprint_of(config);
    if (const ordered_json* done = log_.scored(record)) return *done;
    config.validate();
    score(config, watch, record);
  } catch (const std::exception& error) {
    if (ends_sweep(error)) throw;
    if (!record.contains("settings")) record["settings"] = record["configuration"];
    record["status"] = "failed";
    record["error"] = error.what();
  }
  log_.add(record);
  return record;
}

std::string Sweep::fingerprint_of(const TrainingConfig& config) const {
  nlohmann::json all = data_;
  all["skeleton"] = static_cast<int>(config.skeleton);
  for (const auto& [role, joint] : config.joint_map)
    all["joint_map"][std::string(name_of(role))] = joint;
  return fmt::format("{:016x}",
                     fnv1a(all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

void Sweep::report(const std::string& notice) {
  if (notices_ && reported_.insert(notice).second) notices_(notice);
}

void Sweep::score(const TrainingConfig& config, const Watch& watch, ordered_json& record) {
  const std::string folder = folder_name_of(record["name"].get<std::string>());
  std::vector<std::string> notices;
  build_kernels(device_, clips_, test_, shortest(config), watch, notices);
  for (const std::string& notice : notices) report(notice);
  const TrainedRun trained =
      trained_run(device_, clips_, config, run_ / folder, checkpoints_, watch);
  TestRunOptions options;
  options.camera = trained.model.modalities.camera;
  options.joint_map = config.joint_map;
  options.keep_first_frame = config.keep_first_frame;
  options.baselines.clear();
  options.notices = [this](const std::string& notice) { report(notice); };
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
  record["folder"] = folder;
  record["training_s"] = trained.training_s;
  record["inference_s"] = seconds;
  record["inference_ms_per_frame"] = 1000.0 * seconds / frames;
  record["clips"] = results.size();
  record["frames"] = frames;
  record["pcc_flat"] = mean.pcc_flat;
  record["pcc_channel"] = mean.pcc_channel;
  record["mpjpe_mm"] = mean.error.mpjpe_mm;
}

}  // namespace mcdbn
