#include "learning/metrics_log.hpp"

#include <fmt/format.h>

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

MetricsLog::MetricsLog(const std::filesystem::path& path) : path_(path), stream_(path) {
  check();
}

void MetricsLog::add(const EpochReport& report) {
  nlohmann::ordered_json line = {{"stage", report.stage},
                                 {"epoch", report.epoch},
                                 {"loss", report.loss},
                                 {"windows_per_s", report.windows_per_s}};
  // Up to version 0.1 fine-tuning was called so.
  if (report.stage == "fine-tuning") line["former_stage"] = "joint";
  if (report.held_out_loss) line["held_out_loss"] = *report.held_out_loss;
  if (report.health) append(line, *report.health);
  stream_ << line.dump() << '\n' << std::flush;
  check();
}

void MetricsLog::check() const {
  if (!stream_) throw InputError(fmt::format("{}: cannot be written", path_.string()));
}

}  // namespace mcdbn
