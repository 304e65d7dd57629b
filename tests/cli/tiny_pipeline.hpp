#pragma once

#include <filesystem>
#include <string>

#include "base/scratch_folder.hpp"
#include "run_cli.hpp"

namespace mcdbn::test {

// Each file has its own, initialized before its other constants, which may begin with these.

/// Settings with which the greedy stages, of one layer, take no time.
const std::string kTinyGreedy =
    "--hidden 8 --mrbm-hidden 8 --phases 1 --gaussian-epochs 2 --mrbm-epochs 2";
/// Settings with which fine-tuning takes no time.
const std::string kTinyFineTuning =
    " --fine-tuning-steps 3 --fine-tuning-windows 4 --augment-views 1";
/// Settings with which training takes no time.
const std::string kTiny = kTinyGreedy + kTinyFineTuning;

CliResult synthesize(const std::filesystem::path& folder);

/// @param clips each in quotes  @param environment what stands before the command
CliResult train(const std::string& clips, const std::filesystem::path& run,
                const std::string& options, const std::string& environment = "");

/// The clip with its rest pose, a calibration, before its first frame. @return `path`
std::filesystem::path with_calibration_pose(const std::filesystem::path& clip,
                                            const std::filesystem::path& path);

/// The whole job at a size that takes seconds, done once for all tests. All read the same clips,
/// whose paths the model records; each process has a run folder of its own.
class TinyPipeline {
 public:
  static const TinyPipeline& instance();
  std::filesystem::path motion() const { return motion_; }
  std::filesystem::path model() const { return folder_ / "run/model.safetensors"; }
  std::filesystem::path folder(const std::string& name) const { return folder_ / name; }
  std::string training_clips() const;  ///< each in quotes
  std::string test_clips() const;
  const std::string& training_messages() const { return training_messages_; }

 private:
  TinyPipeline();
  ScratchFolder folder_;
  std::filesystem::path motion_;
  std::string training_messages_;
};

/// Fails the test where there is none: nothing would be tested. Where MCDBN_ALLOW_NO_DEVICE is set,
/// reports by name that the test is skipped, and returns false.
bool have_device();

}  // namespace mcdbn::test
