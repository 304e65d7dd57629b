// Every figure of summary.json once more, by plain code of the tests' own.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/capture_bound.hpp"
#include "by_hand.hpp"
#include "numbered_report.hpp"

namespace mcdbn {
namespace {

using namespace test;
using nlohmann::json;

void check_figures(const json& found, const std::vector<double>& numbers) {
  const auto wanted = numbered_figures(numbers);
  CHECK(found.size() == wanted.size());
  for (const auto& [name, value] : wanted) {
    CAPTURE_BOUND(name);
    REQUIRE(found.contains(name));
    CHECK(std::abs(found.at(name).get<double>() - value) <= 1e-9 * std::abs(value));
  }
}

void check_number(const json& found, const char* name, double wanted) {
  CAPTURE(name);
  CHECK(std::abs(found.at(name).get<double>() - wanted) <= 1e-9 * std::max(1.0, std::abs(wanted)));
}

void check_statistics(const json& found, const std::vector<double>& values) {
  const HandStatistics wanted = statistics_by_hand(values);
  CHECK(found.at("count") == values.size());
  CHECK(found.at("left_out") == 0);
  check_number(found, "mean", wanted.mean);
  check_number(found, "standard_deviation", wanted.deviation);
  check_number(found, "median", wanted.median);
  check_number(found, "minimum", wanted.minimum);
  check_number(found, "maximum", wanted.maximum);
  check_number(found, "mode", wanted.mode);
  CHECK(found.at("histogram").at("counts") == json(wanted.counts));
  check_number(found.at("histogram"), "low", wanted.minimum);
  check_number(found.at("histogram"), "high", wanted.maximum);
}

std::vector<double> parameters_of(const json& fit, const std::vector<const char*>& names) {
  CHECK(fit.at("parameters").size() == names.size());
  std::vector<double> values;
  for (const char* name : names) values.push_back(fit.at("parameters").at(name).at("value"));
  return values;
}

void check_weibull(const json& fit, const std::vector<double>& values) {
  const auto wanted = weibull_by_hand(values);
  const auto errors = weibull_errors_by_hand(wanted, values);
  for (int i = 0; i < 2; ++i) {
    const json& found = fit.at("parameters").at(i == 0 ? "shape" : "scale");
    CHECK(found.at("value").get<double>() == doctest::Approx(wanted[i]).epsilon(1e-6));
    // Second differences over steps of 1e-4 are right to about 1e-6 of themselves.
    CHECK(found.at("standard_error").get<double>() == doctest::Approx(errors[i]).epsilon(1e-4));
    const double reach = 1.959963984540054 * errors[i] / wanted[i];
    CHECK(found.at("low_95").get<double>() ==
          doctest::Approx(wanted[i] * std::exp(-reach)).epsilon(1e-4));
    CHECK(found.at("high_95").get<double>() ==
          doctest::Approx(wanted[i] * std::exp(reach)).epsilon(1e-4));
  }
}

void check_fits(const json& fits, const std::vector<double>& values) {
  const std::map<std::string, std::vector<const char*>> names = {
      {"normal", {"mean", "sd"}},
      {"log-normal", {"log_mean", "log_sd"}},
      {"gamma", {"shape", "scale"}},
      {"Weibull", {"shape", "scale"}},
      {"GEV", {"shape", "scale", "location"}}};
  REQUIRE(fits.size() == names.size());
  double before = -1e300;
  std::map<std::string, int> seen;
  for (const json& fit : fits) {
    const std::string family = fit.at("family");
    CAPTURE(family);
    CHECK(++seen[family] == 1);
    const auto parameters = parameters_of(fit, names.at(family));
    const auto count = static_cast<double>(parameters.size());
    const double likelihood = log_likelihood_by_hand(family, parameters, values);
    const double n = static_cast<double>(values.size());
    CHECK(fit.at("aic").get<double>() == doctest::Approx(2 * count - 2 * likelihood).epsilon(1e-7));
    CHECK(fit.at("bic").get<double>() ==
          doctest::Approx(count * std::log(n) - 2 * likelihood).epsilon(1e-7));
    CHECK(fit.at("aic").get<double>() >= before);
    before = fit.at("aic");
    if (family == "Weibull") check_weibull(fit, values);
  }
}

std::vector<MatrixD> clips_of(const EvaluationReport& report, const std::string& action,
                              bool real) {
  std::vector<MatrixD> clips;
  for (const ReportClip& clip : report.clips) {
    if (clip.action != action) continue;
    if (real) clips.push_back(relative_by_hand(clip.truth_mm, clip.joints));
    for (const ReportMotion& sample : clip.samples)
      if (!real) clips.push_back(relative_by_hand(sample.points_mm, clip.joints));
  }
  return clips;
}

std::vector<double> pairs_of(const std::vector<MatrixD>& clips) {
  std::vector<double> pairs;
  for (std::size_t i = 0; i < clips.size(); ++i)
    for (std::size_t j = i + 1; j < clips.size(); ++j)
      pairs.push_back(correlation_by_hand(clips[i], clips[j]));
  return pairs;
}

std::array<double, 2> weibull_in(const json& correlations) {
  for (const json& fit : correlations.at("fits"))
    if (fit.at("family") == "Weibull")
      return {fit.at("parameters").at("shape").at("value"),
              fit.at("parameters").at("scale").at("value")};
  FAIL("no Weibull");
  return {};
}

}  // namespace

TEST_CASE("summary: scores of the model, its mean field and the baselines are means by hand") {
  const EvaluationReport report = numbered_report();
  const json summary = summary_json(report);
  check_figures(summary.at("model"), sample_numbers(report, ""));
  check_figures(summary.at("model_mean_field"), {kMeanFieldNumber});
  CHECK(summary.at("baselines").size() == 2);
  check_figures(summary.at("baselines").at("ridge_window"), {kRidgeNumber});
  check_figures(summary.at("baselines").at("mean_pose"), {kMeanPoseNumber});
  CHECK(summary.at("clips") == 5);
  CHECK(summary.at("frames") == 118);
  CHECK(summary.at("training_clips") == 1);
  CHECK(summary.at("samples") == 2);
  CHECK(summary.at("temperature") == 0.75);
  CHECK(summary.at("model_file") == "model.safetensors");
  CHECK(summary.at("protocol") == "subject");
  CHECK(summary.at("fit") == "track");
  CHECK(summary.at("track_damage") ==
        json{{"noise_px", 1.5}, {"missing_share", 0.25}, {"hidden_s", 0.5}});
  for (std::size_t i = 0; i < 5; ++i) {
    const json& clip = summary.at("per_clip").at(i);
    CHECK(clip.at("name") == report.clips[i].name);
    CHECK(clip.at("action") == report.clips[i].action);
    CHECK(clip.at("frames") == report.clips[i].truth_mm.rows());
    CHECK(clip.at("fps") == 25);
    CHECK(clip.at("trained_on") == (i == 2));
    const double number = 10.0 * static_cast<double>(i + 1);
    check_figures(clip.at("model"), {number + 3, number + 2});
  }
}

TEST_CASE("summary: every figure of an action by hand") {
  const EvaluationReport report = numbered_report();
  const json summary = summary_json(report);
  REQUIRE(summary.at("actions").size() == 2);
  const json &walk = summary.at("actions").at(0), &jump = summary.at("actions").at(1);
  CHECK(walk.at("name") == "walk");
  CHECK(jump.at("name") == "jump");
  CHECK(walk.at("clips") == 3);
  CHECK(walk.at("frames") == 74);
  CHECK(walk.at("training_clips") == 1);
  CHECK(walk.at("samples") == 2);
  check_figures(walk.at("model"), sample_numbers(report, "walk"));
  check_figures(jump.at("model"), sample_numbers(report, "jump"));
  check_figures(walk.at("best_of_samples"), {12, 32, 42});  // the second sample of each
  check_figures(walk.at("model_mean_field"), {kMeanFieldNumber});
  check_figures(walk.at("baselines").at("ridge_window"), {kRidgeNumber});
  double diversity = 0;
  for (const ReportClip& clip : report.clips)
    if (clip.action == "walk")
      diversity += distance_by_hand(clip.samples[0].points_mm, clip.samples[1].points_mm, 3) / 3;
  check_number(walk, "diversity_mm", diversity);

  for (const json& action : {walk, jump}) {
    const std::string name = action.at("name");
    CAPTURE(name);
    std::vector<double> flat, channel;
    for (const double number : sample_numbers(report, name)) {
      flat.push_back(0.97 - 0.0011 * number);
      channel.push_back(0.85 - 0.0023 * number);
    }
    check_statistics(action.at("pcc_flat"), flat);
    check_statistics(action.at("pcc_channel"), channel);
    check_fits(action.at("pcc_flat").at("fits"), flat);
    check_fits(action.at("pcc_channel").at("fits"), channel);
    const auto regenerated = pairs_of(clips_of(report, name, false));
    const auto real = pairs_of(clips_of(report, name, true));
    if (real.size() > 1)
      check_statistics(action.at("pairwise_real"), real);
    else  // a single value has no deviation
      check_number(action.at("pairwise_real"), "mean", real.at(0));
    check_statistics(action.at("pairwise_regenerated"), regenerated);
    check_fits(action.at("pairwise_regenerated").at("fits"), regenerated);
  }
}

TEST_CASE("summary: drawn pairs are as many as the real ones, of the regenerated, by the seed") {
  const EvaluationReport report = numbered_report();
  const std::vector<double> all = pairs_of(clips_of(report, "walk", false));
  std::set<std::vector<double>> draws;
  for (const std::uint64_t seed : {7U, 8U, 9U, 10U}) {
    const auto action = analyse_actions(report.clips, seed).at(0);
    const std::vector<double>& drawn = action.pairs_drawn.values;
    REQUIRE(drawn.size() == 3);
    std::size_t next = 0;  // in their order, each at most once
    for (const double value : drawn) {
      while (next < all.size() && std::abs(all[next] - value) > 1e-12) ++next;
      CHECK(next++ < all.size());
    }
    draws.insert(drawn);
    CHECK(analyse_actions(report.clips, seed).at(0).pairs_drawn.values == drawn);
  }
  CHECK(draws.size() > 1);
  check_statistics(json(summary_json(report)).at("actions").at(0).at("pairwise_regenerated_drawn"),
                   report.actions[0].pairs_drawn.values);
}

TEST_CASE("summary: the divergence is that of the regenerated from the real pairs") {
  const EvaluationReport report = numbered_report();
  const json walk = json(summary_json(report)).at("actions").at(0);
  const auto real = weibull_in(walk.at("pairwise_real"));
  const auto regenerated = weibull_in(walk.at("pairwise_regenerated_drawn"));
  const double wanted = weibull_divergence_by_hand(real, regenerated);
  CHECK(walk.at("weibull_kl_nats").get<double>() == doctest::Approx(wanted).epsilon(1e-4));
  CHECK(std::abs(weibull_divergence_by_hand(regenerated, real) - wanted) > 0.01 * wanted);
}

}  // namespace mcdbn
