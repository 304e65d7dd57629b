#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/model/mcdbn.hpp"
#include "mcdbn/model/modalities.hpp"

namespace mcdbn {

/// A clip that the model was trained on, so that it is not taken for a test.
struct TrainingClip {
  std::string path;         ///< absolute
  std::string fingerprint;  ///< of the file's bytes: knows the clip again under another name
};

/// @throws InputError if the file cannot be read
TrainingClip identify_clip(const std::filesystem::path& path);

/// Everything that one model file holds.
struct Model {
  Mcdbn network;
  Modalities modalities;
  std::vector<TrainingClip> training_clips;
  nlohmann::json config;  ///< the effective settings of the run
};

/// One .safetensors file: tensors `pose.0.W` …, metadata with format version, modalities, skeleton
/// and settings. Written atomically. @throws InputError
void save_model(const std::filesystem::path& path, const Model& model);
/// @throws InputError
Model load_model(Device& device, const std::filesystem::path& path);

}  // namespace mcdbn
