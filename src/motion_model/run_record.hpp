#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "mcdbn/corpus/clip_list.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

/// Everything that a training was begun with, enough to begin it once more.
struct RunRecord {
  TrainingConfig config;
  std::vector<ListedClip> clips;
  std::optional<StartedFrom> from;
};

/// Files are written with their whole paths. @throws InputError
void write_run_record(const std::filesystem::path& path, const RunRecord& record);
/// @throws InputError naming the file and the field
RunRecord read_run_record(const std::filesystem::path& path);

}  // namespace mcdbn
