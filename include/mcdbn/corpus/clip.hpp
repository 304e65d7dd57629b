#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// How a file of motion becomes a clip that a model can use; training, evaluation and `project`
/// share it.
struct ClipOptions {
  double fps = 30.0;              ///< resample to this rate; 0 keeps the file's own
  bool keep_first_frame = false;  ///< keep a leading calibration pose
};

/// Reads a BVH or AMC file (read_motion), drops a leading calibration pose and resamples.
/// @param notices if given, collects a line for each thing that was odd or was changed
/// @throws InputError if the file is bad or has no frame left, ConfigError if fps is not a rate
Motion load_clip(const std::filesystem::path& path, const ClipOptions& options = {},
                 std::vector<std::string>* notices = nullptr);

/// The BVH and AMC files that a command line means: files as they are, folders searched recursively
/// for *.bvh and *.amc (any case), sorted by path within each folder; a file named twice counts
/// once.
/// @throws InputError if a path does not exist or a folder holds none
std::vector<std::filesystem::path> find_clips(const std::vector<std::filesystem::path>& paths);

/// A clip that the model was trained on, so that it is not taken for a test.
struct TrainingClip {
  std::string path;  ///< absolute
  /// Of the file's bytes, and of an AMC its ASF's too: knows the clip again under another name.
  std::string fingerprint;
  /// Of an AMC's bytes alone, as earlier models recorded it; empty of other files.
  std::string former_fingerprint = {};
};

/// @throws InputError if the file, or an AMC's ASF, cannot be read
TrainingClip identify_clip(const std::filesystem::path& path);

/// Whether one of the clips has the same bytes. Of an AMC that an earlier model recorded the ASF is
/// not compared.
bool is_among(const std::vector<TrainingClip>& clips, const TrainingClip& clip);

/// A clip to train on, its file read once for all that is made of it.
struct LoadedClip {
  TrainingClip clip;
  Motion motion;                         ///< at the file's own rate
  std::string person = {}, action = {};  ///< who does what; empty where not given
};

/// @param notices as load_clip collects them, but what is the same of several clips once
/// @throws InputError as load_clip does
std::vector<LoadedClip> load_clips(const std::vector<std::filesystem::path>& files,
                                   bool keep_first_frame = false,
                                   std::vector<std::string>* notices = nullptr);

}  // namespace mcdbn
