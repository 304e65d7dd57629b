#include "learning/metrics_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

void append(nlohmann::ordered_json& line, const LayerHealth& health) {
  line["hidden_activity"] = health.hidden_activity;
  line["saturation"] = health.saturation;
  line["weight_norm"] = health.weight_norm;
  if (health.weight_norm_A) line["weight_norm_A"] = *health.weight_norm_A;
  if (health.weight_norm_B) line["weight_norm_B"] = *health.weight_norm_B;
  if (health.free_run_error) line["free_run_error"] = *health.free_run_error;
}

}  // namespace

MetricsLog::MetricsLog(const std::filesystem::path& path, std::uint64_t kept) : path_(path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error) written_ = std::min<std::uint64_t>(kept, size);
  if (!write_waiting()) finish();
}

void MetricsLog::add(const EpochReport& report) {
  nlohmann::ordered_json line = {{"stage", report.stage},
                                 {"epoch", report.epoch},
                                 {"loss", report.loss},
                                 {"windows_per_s", report.windows_per_s}};
  // Up to version 0.1 fine-tuning was called so.
  if (report.stage == "fine-tuning") line["former_stage"] = "joint";
  if (report.held_out_loss) line["held_out_loss"] = *report.held_out_loss;
  if (report.waiting_share) line["waited"] = *report.waiting_share;
  if (report.health) append(line, *report.health);
  waiting_ += line.dump() + '\n';
  write_waiting();
}

void MetricsLog::finish() {
  if (!write_waiting()) throw InputError(fmt::format("{}: cannot be written", path_.string()));
}

/// Writes the waiting lines over half a line that an earlier try, or a program that was killed, may
/// have left. @return whether it was possible
bool MetricsLog::write_waiting() {
  std::ofstream stream(path_, std::ios::binary | std::ios::app);
  if (!stream) return false;
  std::error_code error;
  std::filesystem::resize_file(path_, written_, error);
  stream << waiting_ << std::flush;
  if (!stream || error) return false;
  written_ += waiting_.size();
  waiting_.clear();
  return true;
}

}  // namespace mcdbn
