#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/device/device.hpp"
#include "mcdbn/learning/epoch_report.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn::test {

/// The device that the program takes by default. Never closed, as every_device.hpp explains.
Device& usual_device();

/// What the library itself makes of a call, for comparison with the program's files.
struct LibraryTraining {
  std::string model_file;  ///< its bytes
  std::vector<EpochReport> epochs;
};

/// @param record what the model file is to hold of its settings
LibraryTraining train_by_library(const std::vector<std::filesystem::path>& clips,
                                 const TrainingConfig& config, const nlohmann::json& record);

}  // namespace mcdbn::test
