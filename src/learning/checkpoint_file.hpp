#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "device/training_state.hpp"

namespace mcdbn {

/// What stands in the file of a checkpoint.
struct CheckpointContent {
  std::map<std::string, TrainingState::Content> over;  ///< results of the stages that ended
  std::string running;                                 ///< the stage that runs; empty: between two
  std::size_t done = 0;                                ///< its mini-batches
  TrainingState::Content now;                          ///< its state
  TrainingState::Content more;                         ///< the training's own numbers
};

/// Writes atomically. @throws InputError
void write_checkpoint(const std::filesystem::path& path, const CheckpointContent& content);
/// Every number in it is finite. @throws InputError naming the file and what is wrong in it
CheckpointContent read_checkpoint(const std::filesystem::path& path);

}  // namespace mcdbn
