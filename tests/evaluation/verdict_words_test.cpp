// Which words a report finds for which figures: both sides of every threshold.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "numbered_report.hpp"

namespace mcdbn {
namespace {

using Kind = Verdict::Kind;
using namespace test;

struct Figures {
  double mpjpe_mm, pcc_channel, pcc_flat = 0.5;
};

ClipScore score_with(const Figures& figures) {
  ClipScore score;
  score.error.mpjpe_mm = figures.mpjpe_mm;
  score.pcc_channel = figures.pcc_channel;
  score.pcc_flat = figures.pcc_flat;
  return score;
}

/// One action of two clips with one sample each; the model against one baseline.
EvaluationReport duel(const Figures& model, const Figures& baseline, const char* name) {
  EvaluationReport report = numbered_report();
  report.clips.resize(2);
  report.fit = "none";
  report.damage = {};
  for (ReportClip& clip : report.clips) {
    clip.action = "walk";
    clip.samples = {{clip.truth_mm, score_with(model)}};
    clip.others = {{name, {clip.truth_mm, score_with(baseline)}}};
  }
  // The baseline is nearer on the second clip in any case.
  report.clips[1].samples[0].score.error.mpjpe_mm += 4;
  report.clips[1].others.at(name).score.error.mpjpe_mm -= 4;
  report.actions = analyse_actions(report.clips, 1);
  return report;
}

bool has_verdict(const EvaluationReport& report, Kind kind, const std::string& text) {
  for (const Verdict& verdict : verdicts(report))
    if (verdict.kind == kind && verdict.text == text) return true;
  for (const Verdict& verdict : verdicts(report)) MESSAGE(verdict.text);
  return false;
}

/// Of one joint along one axis, so many intervals that hold the truth, and so many that do not.
Coverage coverage_of(int held, int missed) {
  MatrixD off = MatrixD::Zero(held + missed, 1);
  off.bottomRows(missed).setConstant(2);
  Coverage coverage;
  coverage.add({"Head"}, off, MatrixD::Zero(off.rows(), 1), MatrixD::Ones(off.rows(), 1));
  return coverage;
}

}  // namespace

TEST_CASE("verdicts: nearer, or following better, or both, or neither") {
  CHECK(has_verdict(
      duel({20, 0.9}, {25, 0.8}, "ridge_window"), Kind::good,
      "The model beats ridge regression: 22.0 mm against 23.0 mm, per-channel PCC 0.900 "
      "against 0.800; nearer on 1 of 2 clips."));
  CHECK(has_verdict(
      duel({20, 0.7}, {25, 0.8}, "mlp_window"), Kind::bad,
      "The model is nearer to the truth than the MLP, but follows the motion less well: "
      "22.0 mm against 23.0 mm, per-channel PCC 0.700 against 0.800; nearer on 1 of 2 "
      "clips."));
  CHECK(has_verdict(
      duel({20, 0.9}, {22, 0.8}, "nearest_neighbour"), Kind::bad,
      "The model is farther from the truth than the nearest neighbour, though it follows "
      "the motion better: 22.0 mm against 20.0 mm, per-channel PCC 0.900 against 0.800; "
      "nearer on 1 of 2 clips."));
  CHECK(has_verdict(
      duel({20, 0.7}, {20, 0.8}, "hold_last_frame"), Kind::bad,
      "The model loses to one pose held throughout: 22.0 mm against 18.0 mm, per-channel "
      "PCC 0.700 against 0.800; nearer on 0 of 2 clips."));
}

TEST_CASE("verdicts: a constant pose by the flattened correlation") {
  CHECK(has_verdict(
      duel({20, 0.7, 0.95}, {50, 0.02, 0.81}, "mean_pose"), Kind::note,
      "By the flattened PCC, a pose that never moves reaches 0.8100 (the model: 0.9500): "
      "judge by the per-channel PCC, where it gets 0.02."));
  CHECK(has_verdict(
      duel({20, 0.7, 0.9}, {50, 0.02, 0.9}, "mean_pose"), Kind::bad,
      "By the flattened PCC that the paper reports, a pose that never moves (0.9000) is as "
      "good as the model (0.9000)."));
  for (const Verdict& verdict : verdicts(duel({20, 0.7, 0.9}, {50, 0.02, 0.79}, "mean_pose")))
    CHECK(verdict.text.find("flattened") == std::string::npos);
}

TEST_CASE("verdicts: planted feet, samples and how alike clips are") {
  EvaluationReport report = numbered_report();
  // The answer is the mean field, number 2: feet at 25 mm/s where the capture's are at 14.
  CHECK(has_verdict(report, Kind::bad,
                    "Planted feet slide at 25 mm/s, in the capture itself at 14 mm/s: 1.8 times as "
                    "fast."));
  const ActionReport& walk = report.actions[0];
  CHECK(has_verdict(
      report, Kind::bad,
      fmt::format("walk: 2 samples of a clip differ by {:.1f} mm; a sample is off by 49.2 mm "
                  "on average, the best of 2 by 48.7 mm, the single mean-field answer by "
                  "22.0 mm.",
                  *walk.diversity_mm)));
  for (ReportClip& clip : report.clips) clip.others.at(kMeanField).score.foot_slide = {20, 30, 3};
  CHECK(has_verdict(report, Kind::good,
                    "Planted feet slide at 30 mm/s, in the capture itself at 20 mm/s: 1.5 times as "
                    "fast."));
  CHECK(has_verdict(
      report, Kind::bad,
      "1 of 5 clips were trained on: every figure that includes them flatters the model. "
      "They are marked."));

  ActionReport& likeness = report.actions[0];
  likeness.pairs_real.statistics.median = 0.9;
  const auto alike = [&](double median, double kl) {
    likeness.pairs_drawn.statistics.median = median;
    likeness.weibull_kl = kl;
    for (const Verdict& verdict : verdicts(report))
      if (verdict.text.starts_with("walk: regenerated clips are ")) return verdict;
    return Verdict{};
  };
  CHECK(alike(0.95, 0.39).text ==
        "walk: regenerated clips are more alike than real ones (median pairwise PCC 0.950 against "
        "0.900; KL of the fitted Weibulls 0.39 nats).");
  CHECK(alike(0.95, 0.39).kind == Kind::good);
  CHECK(alike(0.85, 0.41).kind == Kind::note);
  CHECK(alike(0.85, 0.41).text.find("less alike than") != std::string::npos);
  CHECK(alike(0.904, 0.1).text.find("about as alike as") != std::string::npos);
}

TEST_CASE("verdicts: how many 90 % intervals hold the truth") {
  const auto with = [&](int of_1000) {
    EvaluationReport report = duel({20, 0.9}, {25, 0.8}, "ridge_window");
    report.joints = coverage_of(of_1000, 1000 - of_1000);
    return report;
  };
  CHECK(has_verdict(with(851), Kind::good,
                    "Of 90 % intervals of the joints' places, 85.1 % hold the truth."));
  CHECK(has_verdict(with(949), Kind::good,
                    "Of 90 % intervals of the joints' places, 94.9 % hold the truth."));
  CHECK(has_verdict(
      with(849), Kind::bad,
      "Of 90 % intervals of the joints' places, 84.9 % hold the truth: they are too narrow."));
  CHECK(has_verdict(
      with(951), Kind::bad,
      "Of 90 % intervals of the joints' places, 95.1 % hold the truth: they are too wide."));
  EvaluationReport unknown = with(900);
  unknown.joints = {};
  for (const Verdict& verdict : verdicts(unknown))
    CHECK(verdict.text.find("intervals") == std::string::npos);
}

TEST_CASE("verdicts: the intervals of all frames count alike, not the clips' shares") {
  EvaluationReport report = duel({20, 0.9}, {25, 0.8}, "ridge_window");
  report.clips[0].samples[0].score.within_90 = 0.5;
  report.clips[1].samples[0].score.within_90 = 0.9;
  report.joints = coverage_of(5, 5);      // a short clip
  report.joints.add(coverage_of(81, 9));  // a long one
  CHECK(has_verdict(report, Kind::good,
                    "Of 90 % intervals of the joints' places, 86.0 % hold the truth."));
}

TEST_CASE("verdicts: where a baseline is nearer on an action of several") {
  EvaluationReport report = numbered_report();
  for (ReportClip& clip : report.clips)
    if (clip.action == "jump") clip.others.at("ridge_window").score.error.mpjpe_mm = 15;
  report.actions = analyse_actions(report.clips, 7);
  CHECK(has_verdict(
      report, Kind::bad,
      "On jump, ridge regression is nearer to the truth: 15.0 mm against the model's 22.0 "
      "mm."));
  for (const Verdict& verdict : verdicts(report))
    CHECK(verdict.text.find("On walk") == std::string::npos);
}

TEST_CASE("verdicts: where nothing moves no correlation is given") {
  const double none = std::numeric_limits<double>::quiet_NaN();
  CHECK(has_verdict(
      duel({20, none}, {25, none}, "ridge_window"), Kind::good,
      "The model beats ridge regression: 22.0 mm against 23.0 mm, no per-channel PCC, for "
      "nothing moves; nearer on 1 of 2 clips."));
  CHECK(has_verdict(
      duel({25, none}, {20, 0.5}, "ridge_window"), Kind::bad,
      "The model loses to ridge regression: 27.0 mm against 18.0 mm, no per-channel PCC, "
      "for nothing moves; nearer on 0 of 2 clips."));
  for (const Verdict& verdict : verdicts(duel({20, none, 0.9}, {25, none, 0.9}, "mean_pose")))
    CHECK(verdict.text.find("nan") == std::string::npos);
}

namespace {

const std::string kOnClips =
    "Of the simpler methods the MLP alone can learn from the model's views: the others learnt from "
    "the training clips' exact joints, as one camera sees them.";

bool mentions(const EvaluationReport& report, const std::string& words) {
  const std::vector<Verdict> list = verdicts(report);
  return std::ranges::any_of(
      list, [&](const Verdict& verdict) { return verdict.text.find(words) != std::string::npos; });
}

}  // namespace

TEST_CASE("verdicts: what the simpler methods learnt from, where tracks are as a detector's") {
  EvaluationReport report = duel({20, 0.9}, {25, 0.8}, "nearest_neighbour");
  CHECK_FALSE(mentions(report, "exact joints"));
  report.tracks = "openpose";
  CHECK(has_verdict(report, Kind::note, kOnClips));
  report = duel({20, 0.9}, {25, 0.8}, "mlp_window");
  report.tracks = "openpose";
  for (ReportClip& clip : report.clips) clip.others[kMeanField] = clip.samples[0];
  CHECK_FALSE(mentions(report, "exact joints"));
}

TEST_CASE("verdicts: whether the camera was known, whatever the tracks are") {
  EvaluationReport report = duel({20, 0.9}, {25, 0.8}, "ridge_window");
  CHECK_FALSE(mentions(report, "camera"));
  report.camera_known = false;
  CHECK(has_verdict(report, Kind::note,
                    "No method knew the camera: its place and lens were hidden."));
  report.tracks = "openpose";
  CHECK_FALSE(mentions(report, "No method knew the camera"));  // it is in the note on the tracks
  CHECK(mentions(report, "no camera known"));
}

TEST_CASE("verdicts: people who were trained on, and those of whom nothing tells") {
  EvaluationReport report = duel({20, 0.9}, {25, 0.8}, "ridge_window");
  CHECK_FALSE(mentions(report, "trained on"));
  report.clips[0].known_person = "08";
  CHECK(has_verdict(report, Kind::note,
                    "1 of 2 clips show a person whom the model was trained on in other clips (08): "
                    "for people that it has never seen expect less."));
  report.clips[1].known_person.reset();
  CHECK(has_verdict(report, Kind::note,
                    "Whether the model was trained on the people in 1 of 2 clips is not known: its "
                    "training clips are not here to compare, and the names of these do not tell."));
  report.clips[1].trained_on = true;
  CHECK_FALSE(mentions(report, "is not known"));
}

}  // namespace mcdbn
