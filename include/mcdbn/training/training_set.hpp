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
  std::vector<MatrixF> tracks;      ///< 2D
  std::vector<MatrixF> poses;       ///< 3D
  std::vector<TrainingClip> clips;  ///< files as they were read; of augmented views, each view's
  /// Who is seen in each of `poses`, counted from 0; empty where nobody asked.
  std::vector<std::size_t> people;
  std::size_t frames() const;
};

/// Reads BVH files, resamples each on `phases` shifted grids, projects it through the camera and
/// learns the features and their scaling. @throws InputError
TrainingSet make_training_set(const std::vector<std::filesystem::path>& files,
                              const TrainingConfig& config, std::vector<std::string>* notices);

}  // namespace mcdbn
