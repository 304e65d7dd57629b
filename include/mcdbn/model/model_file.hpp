#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
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

/// On whom the joint stage was stopped early, and where.
struct EarlyStopping {
  std::vector<std::string> held_out;  ///< that person's clips, by file name: not learnt from
  std::size_t steps = 0;              ///< mini-batches of the parameters that were kept
  double loss = 0;                    ///< theirs on the person held out
};

/// Everything that one model file holds.
struct Model {
  Mcdbn network;
  Modalities modalities;
  std::vector<TrainingClip> training_clips;
  nlohmann::json config;  ///< the effective settings of the run
  std::optional<EarlyStopping> early_stopping = {};
};

/// One .safetensors file: tensors `pose.0.W` …, metadata with format version, modalities, skeleton
/// and settings. Written atomically. @throws InputError
void save_model(const std::filesystem::path& path, const Model& model);
/// @throws InputError
Model load_model(Device& device, const std::filesystem::path& path);
/// The file's own account of itself, for people: sizes, main settings, training clips, early
/// stopping. Needs no device. @throws InputError
nlohmann::json describe_model(const std::filesystem::path& path);

}  // namespace mcdbn
