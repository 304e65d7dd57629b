// The room motion_model: the model of motion, where machines and motion meet: its file, its
// training on clips, regeneration (Algorithms 3 and 5). It uses learning, corpus, fitting. Add
// here: what needs a network and bodies at once; what needs only one of them belongs to its wing.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mcdbn/corpus/training_clip.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// On whom fine-tuning was stopped early, and where.
struct EarlyStopping {
  std::vector<std::string> held_out;  ///< that person's clips, by file name: not learnt from
  std::size_t steps = 0;              ///< mini-batches of the parameters that were kept
  double loss = 0;                    ///< theirs on the person held out
};

/// The model that a training started from.
struct StartedFrom {
  std::string model;        ///< its file, absolute
  std::string fingerprint;  ///< of the file's bytes
};

/// Everything that one model file holds.
struct Model {
  Mcdbn network;
  Modalities modalities;
  std::vector<TrainingClip> training_clips;
  nlohmann::json config;  ///< the effective settings of the run
  std::optional<EarlyStopping> early_stopping = {};
  std::optional<StartedFrom> started_from = {};
};

/// Numbers of a model file: 32 bits each, or 16 bits, which halve the file.
enum class StoredNumbers { single, half };

/// One .safetensors file: tensors `pose.0.W` …, metadata with format version, modalities, skeleton
/// and settings. Written atomically. @throws InputError
void save_model(const std::filesystem::path& path, const Model& model,
                StoredNumbers stored = StoredNumbers::single);
/// @throws InputError
Model load_model(Device& device, const std::filesystem::path& path);
/// The file's own account of itself, for people: sizes, parameters that were learnt, main settings
/// and how it was trained, training clips, early stopping, what it started from. Needs no device.
/// @throws InputError
nlohmann::json describe_model(const std::filesystem::path& path);

}  // namespace mcdbn
