#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "mcdbn/learning/epoch_report.hpp"

namespace mcdbn {

/// metrics.jsonl: one object an epoch, with the layer's health now and then, there to be read as
/// soon as the epoch is over. Lines that cannot be written, on a full disk, are tried again with
/// the next ones.
class MetricsLog {
 public:
  /// @param kept bytes of what is there that stay, lines of epochs that are not trained again
  /// @throws InputError if the file cannot be written
  explicit MetricsLog(const std::filesystem::path& path, std::uint64_t kept = 0);
  void add(const EpochReport& report);
  /// Bytes of all lines so far.
  std::uint64_t bytes() const { return written_ + waiting_.size(); }
  /// @throws InputError if there are lines that still cannot be written
  void finish();

 private:
  bool write_waiting();

  std::filesystem::path path_;
  std::uint64_t written_ = 0;
  std::string waiting_;  ///< lines
};

}  // namespace mcdbn
