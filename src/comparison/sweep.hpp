#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "base/folder_lock.hpp"
#include "mcdbn/corpus/clip_list.hpp"
#include "mcdbn/device/device.hpp"
#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "mcdbn/motion_model/training_run.hpp"

namespace mcdbn {

/// The settings that a sweep varies, as one of its trainings has them.
using SweepConfiguration = std::vector<GivenSetting>;

struct SweepFile {
  std::vector<std::filesystem::path> test;  ///< clips, or folders of them, to score on
  std::vector<SweepConfiguration> configurations;
};

/// A TOML file: `test`, a list of paths (relative to the file); `[grid]`, lists of values whose
/// combinations are all tried; `[[configuration]]`, tables of settings tried as they are.
/// @throws ConfigError `file:line: what`
SweepFile read_sweep_file(const std::filesystem::path& path);

/// "hidden=8,order=3"
std::string name_of(const SweepConfiguration& configuration);

/// Trains configurations on clips and scores them on a sweep's test clips (Fig. 7). Each gets a
/// folder of its name (shortened where it is too long for one) in the run's, and a line in
/// sweep.jsonl: its settings, training and inference time, PCC and MPJPE; or why it failed. Those
/// that were scored before, with the same settings and clips, are not run again; a new line
/// replaces the one of its name.
class Sweep {
 public:
  /// The whole configuration from what is varied. May throw ConfigError
  using Resolve = std::function<TrainingConfig(const SweepConfiguration&)>;
  /// Called as a training begins; before each that counts there is a short one that builds the
  /// kernels. What it returns gets its epochs' reports and may throw Interrupted to stop the sweep.
  using Watch = std::function<EpochObserver(bool counts)>;

  /// Called with what is odd about the clips, line by line; of several trainings once.
  using Notices = std::function<void(const std::string& notice)>;

  /// @param checkpoints of each training
  /// @throws ConfigError if a test clip is to be trained on, InputError if a clip cannot be read or
  ///         the folder not be made
  Sweep(Device& device, const std::vector<std::filesystem::path>& test,
        std::vector<ListedClip> clips, Resolve resolve, std::filesystem::path run,
        Notices notices = {}, const CheckpointSettings& checkpoints = {});

  /// @return the line, also of a configuration that failed, or was scored before
  /// @throws Interrupted, DeviceError of a device that is lost: the next one would fail, too
  nlohmann::ordered_json run(const SweepConfiguration& configuration, const Watch& watch = {});

 private:
  /// sweep.jsonl, kept whole: a line that was cut off by a crash is dropped.
  class Log {
   public:
    explicit Log(std::filesystem::path path);
    /// The line of what was scored with the settings and fingerprint of `wanted`.
    const nlohmann::ordered_json* scored(const nlohmann::ordered_json& wanted) const;
    /// In place of what has its name: the run folder of that name is the new one's, too.
    void add(nlohmann::ordered_json record);

   private:
    std::filesystem::path path_;
    std::vector<nlohmann::ordered_json> records_;
  };

  /// Hash of what the result depends on beside the settings: the clips' bytes, person and action of
  /// each, the choice of a skeleton, the joint map.
  std::string fingerprint_of(const TrainingConfig& config) const;
  void score(const TrainingConfig& config, const Watch& watch, nlohmann::ordered_json& record);
  void report(const std::string& notice);

  Device& device_;
  std::vector<std::filesystem::path> test_;
  std::vector<ListedClip> clips_;
  nlohmann::json data_;  ///< what fingerprint_of takes of the clips
  Resolve resolve_;
  std::filesystem::path run_;
  Notices notices_;
  std::set<std::string> reported_;
  CheckpointSettings checkpoints_;
  FolderLock lock_;
  Log log_;
};

}  // namespace mcdbn
