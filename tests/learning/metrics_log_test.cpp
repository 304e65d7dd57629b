#include "learning/metrics_log.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using nlohmann::json;

TEST_CASE("metrics log: a line an epoch, there as soon as it is added, with what is known") {
  const test::ScratchFolder folder;
  const auto path = folder / "metrics.jsonl";
  MetricsLog log(path);
  EpochReport report;
  report.stage = "pose.0";
  report.epoch = 3;
  report.loss = 0.25;
  report.windows_per_s = 1000;
  log.add(report);
  const json plain = {{"stage", "pose.0"}, {"epoch", 3}, {"loss", 0.25}, {"windows_per_s", 1000.0}};
  CHECK(json::parse(read_text_file(path)) == plain);

  report.health = LayerHealth{};
  report.health->hidden_activity = 0.5;
  report.health->saturation = 0.125;
  report.health->weight_norm = 2;
  report.health->weight_norm_B = 3;
  report.stage = "fine-tuning";
  report.held_out_loss = 0.75;
  log.add(report);
  const std::string text = read_text_file(path);
  json second = plain;
  second.merge_patch({{"stage", "fine-tuning"},
                      {"former_stage", "joint"},
                      {"held_out_loss", 0.75},
                      {"hidden_activity", 0.5},
                      {"saturation", 0.125},
                      {"weight_norm", 2.0},
                      {"weight_norm_B", 3.0}});
  CHECK(json::parse(text.substr(text.find('\n') + 1)) == second);
  CHECK_THROWS_AS(MetricsLog(folder / "absent/metrics.jsonl"), InputError);
}
