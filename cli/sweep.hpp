#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.hpp"
#include "training_options.hpp"

namespace mcdbn::cli {

/// One setting that a sweep varies.
struct SweepSetting {
  std::string name;  ///< with dots between its parts: gaussian.epochs
  nlohmann::json value;
  std::string where;  ///< file:line, for errors
};
using SweepConfiguration = std::vector<SweepSetting>;

struct SweepFile {
  std::vector<std::filesystem::path> test;  ///< clips, or folders of them, to score on
  std::vector<SweepConfiguration> configurations;
};

/// A TOML file: `test`, a list of paths (relative to the file); `[grid]`, lists of values whose
/// combinations are all tried; `[[configuration]]`, tables of settings tried as they are.
/// @throws ConfigError `file:line: what`
SweepFile read_sweep_file(const std::filesystem::path& path);

/// Trains every configuration on `clips` and scores it on the sweep's test clips (Fig. 7). Each
/// gets a folder in `run`, and a line in sweep.jsonl: its settings, training and inference time,
/// PCC and MPJPE; or why it failed, whereupon the next one is tried. Configurations that have a
/// line already, with the same settings, are not run again.
/// @param base where settings come from that the sweep does not vary
/// @throws Interrupted; InputError if the test clips cannot be used
void run_sweep(const CommandContext& context, const SweepFile& sweep,
               const std::vector<std::filesystem::path>& clips, const TrainingOptions& base,
               const std::filesystem::path& run);

}  // namespace mcdbn::cli
