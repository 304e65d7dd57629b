#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "device/training_state.hpp"

namespace mcdbn {

/// Contents of a checkpoint's file.
struct CheckpointContent {
  std::map<std::string, TrainingState::Content> finished_stages;  ///< their results
  std::string running_stage;                                      ///< empty: between two
  std::size_t done_minibatches = 0;                               ///< of the running stage
  TrainingState::Content running_state;                           ///< of the running stage
  TrainingState::Content extra_state;                             ///< the training's own numbers
};

/// Writes atomically. @throws InputError
void write_checkpoint(const std::filesystem::path& path, const CheckpointContent& content);
/// Every number in it is finite. @throws InputError naming the file and what is wrong in it
CheckpointContent read_checkpoint(const std::filesystem::path& path);

}  // namespace mcdbn
