#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/corpus/training_clip.hpp"
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

/// A clip to train on, its file read once for all that is made of it.
struct LoadedClip {
  TrainingClip clip;
  Motion motion;  ///< at the file's own rate
};

/// @param notices as load_clip collects them, but what is the same of several clips once
/// @throws InputError as load_clip does
std::vector<LoadedClip> load_clips(const std::vector<std::filesystem::path>& files,
                                   bool keep_first_frame = false,
                                   std::vector<std::string>* notices = nullptr);

}  // namespace mcdbn
