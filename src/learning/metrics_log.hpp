#pragma once

#include <filesystem>
#include <fstream>

#include "mcdbn/learning/epoch_report.hpp"

namespace mcdbn {

/// metrics.jsonl: one object an epoch, with the layer's health now and then, there to be read as
/// soon as the epoch is over.
class MetricsLog {
 public:
  /// @throws InputError if the file cannot be written
  explicit MetricsLog(const std::filesystem::path& path);
  /// @throws InputError likewise
  void add(const EpochReport& report);

 private:
  void check() const;

  std::filesystem::path path_;
  std::ofstream stream_;
};

}  // namespace mcdbn
