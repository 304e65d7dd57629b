#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/model/model_file.hpp"
#include "mcdbn/training/config.hpp"

namespace mcdbn {

/// Synchronized clips of both modalities, standardized: [frames x dimension] each.
struct TrainingSet {
  Modalities modalities;
  std::vector<MatrixF> tracks;  ///< 2D
  std::vector<MatrixF> poses;   ///< 3D
  std::vector<TrainingClip> clips;
  std::size_t frames() const;
};

/// A file's fingerprint as the model records it. @throws InputError
std::string clip_fingerprint(const std::filesystem::path& path);

/// Reads BVH files, resamples each on `phases` shifted grids, projects it through the camera and
/// learns the features and their scaling. @throws InputError
TrainingSet make_training_set(const std::vector<std::filesystem::path>& files,
                              const TrainingConfig& config, std::vector<std::string>* notices);

/// The same clips as modalities that are already known make of them, one phase each: what baselines
/// are fitted on, and what clips are evaluated on.
struct EncodedClip {
  Motion motion;  ///< resampled
  Camera camera;
  Track2d track;
  MatrixF track_features, pose_features;  ///< standardized
};
EncodedClip encode_clip(const std::filesystem::path& file, const Modalities& modalities,
                        const CameraPlacement& placement, bool keep_first_frame,
                        std::vector<std::string>* notices);

}  // namespace mcdbn
