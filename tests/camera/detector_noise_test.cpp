#include "camera/detector_noise.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "base/near.hpp"
#include "base/settings_table.hpp"
#include "camera/standing_body.hpp"
#include "mcdbn/base/errors.hpp"

namespace detector_noise_test {

using namespace mcdbn;
using namespace mcdbn::test;
using namespace mcdbn::test::standing_body;

namespace {

/// Offsets of a column from its place, shares of body height, both axes below one another.
Eigen::VectorXd off(const Track2d& track, const Track2d& exact, Eigen::Index column) {
  Eigen::VectorXd all(2 * track.frames());
  all << (track.x_px - exact.x_px).col(column), (track.y_px - exact.y_px).col(column);
  return all / kHeight_px;
}

double rms_of_all(const Track2d& track, const Track2d& exact) {
  double sum = 0;
  for (Eigen::Index j = 0; j < track.joint_count(); ++j)
    sum += off(track, exact, j).squaredNorm() / static_cast<double>(2 * track.x_px.size());
  return std::sqrt(sum);
}

/// RMS change of the offsets over so many frames.
double rms_change(const Track2d& track, const Track2d& exact, Eigen::Index lag) {
  const MatrixD x = (track.x_px - exact.x_px) / kHeight_px;
  return std::sqrt(
      (x.bottomRows(x.rows() - lag) - x.topRows(x.rows() - lag)).array().square().mean());
}

bool same(const Track2d& a, const Track2d& b) {
  const auto equal = [](const MatrixD& x, const MatrixD& y) {
    return ((x.array() == y.array()) || (x.array().isNaN() && y.array().isNaN())).all();
  };
  return equal(a.x_px, b.x_px) && equal(a.y_px, b.y_px) && equal(a.confidence, b.confidence);
}

/// Frames, on average, from where it begins to hold to where it ends.
double mean_episode(const Eigen::Array<bool, Eigen::Dynamic, 1>& holds) {
  double frames = 0, episodes = 0;
  for (Eigen::Index t = 0; t < holds.size(); ++t) {
    frames += holds[t];
    episodes += holds[t] && (t == 0 || !holds[t - 1]);
  }
  return frames / episodes;
}

}  // namespace

TEST_CASE("detectors: their figures are those of docs/detectors.md") {
  const std::vector<Detector>& all = detectors();
  REQUIRE(all.size() == 3);
  const auto is = [](const Detector& detector, const char* name, const char* joint_set) {
    CHECK(detector.name == name);
    CHECK(detector.joint_set == joint_set);
  };
  is(all[0], "openpose", "BODY_25");
  const Values openpose{{"bias", "0.006"},
                        {"bias-time", "5"},
                        {"drift", "0.0055"},
                        {"drift-time", "0.25"},
                        {"drift-speed", "0.7"},
                        {"jitter", "0.0008"},
                        {"jitter-speed", "0.002"},
                        {"hidden", "0.018"},
                        {"stray", "0.001"},
                        {"stray-hands", "0.0175"},
                        {"stray-hidden", "0.12"},
                        {"stray-size", "0.24"},
                        {"stray-time", "0.04"},
                        {"lost", "0.001"},
                        {"lost-hidden", "0.25"},
                        {"lost-time", "0.09"},
                        {"swapped-legs", "0.02"},
                        {"swapped-arms", "0.002"},
                        {"swap-time", "0.05"},
                        {"confidence", "0.7"},
                        {"confidence-spread", "0.08"},
                        {"confidence-hidden", "0.45"},
                        {"confidence-stray", "0.25"}};
  CHECK(values_of(all[0].noise) == openpose);
  CHECK(values_of(DetectorNoise{}) == openpose);
  CHECK(openpose.size() == member_count<DetectorNoise>());
  // The others, where they differ.
  is(all[1], "mediapipe", "MEDIAPIPE_33");
  CHECK(changed_by(all[1].noise) == Values{{"jitter", "0.0005"},
                                           {"jitter-speed", "0.0012"},
                                           {"stray", "0.02"},
                                           {"stray-hands", "0.025"},
                                           {"stray-size", "0.12"},
                                           {"stray-time", "0.03"},
                                           {"lost", "0"},
                                           {"lost-hidden", "0"},
                                           {"swapped-legs", "0.1"},
                                           {"swapped-arms", "0.01"},
                                           {"confidence", "0.98"},
                                           {"confidence-spread", "0.04"},
                                           {"confidence-hidden", "0.5"},
                                           {"confidence-stray", "0.7"}});
  is(all[2], "coco", "COCO_17");
  CHECK(changed_by(all[2].noise) == Values{{"bias", "0.007"},
                                           {"drift", "0.0072"},
                                           {"drift-speed", "0.3"},
                                           {"jitter", "0.0005"},
                                           {"jitter-speed", "0.0028"},
                                           {"stray", "0"},
                                           {"stray-hands", "0"},
                                           {"stray-hidden", "0"},
                                           {"lost", "0"},
                                           {"lost-hidden", "0"},
                                           {"confidence", "0.85"},
                                           {"confidence-spread", "0.09"},
                                           {"confidence-hidden", "0.73"}});
}

TEST_CASE("a detector without noise gives the joints' places") {
  const Track2d exact = standing(50);
  CHECK(same(detected(exact, noiseless(), 1), exact));
}

TEST_CASE("each part of a detector's noise has the deviation and the duration of its setting") {
  const Track2d exact = standing(6000);
  DetectorNoise jitter = noiseless();
  jitter.jitter = 0.01;
  const Track2d jittered = detected(exact, jitter, 1);
  CHECK(rms_of_all(jittered, exact) == near(0.01, 0.02));
  CHECK(rms_change(jittered, exact, 1) == near(0.01 * std::sqrt(2), 0.02));

  DetectorNoise drift = noiseless();
  drift.drift = 0.01;
  drift.drift_s = 0.5;
  const Track2d drifted = detected(exact, drift, 2);
  CHECK(rms_of_all(drifted, exact) == near(0.01, 0.06));
  // Of an autoregression: the correlation is exp(-t / time).
  for (const int lag : {1, 5, 15, 60})
    CHECK(rms_change(drifted, exact, lag) ==
          near(0.01 * std::sqrt(2 * (1 - std::exp(-lag / 15.0))), 0.07));

  DetectorNoise bias = noiseless();
  bias.bias = 0.01;
  bias.bias_s = 1e6;
  double sum = 0;
  constexpr int kSeeds = 200;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Track2d two = standing(2);
    const Track2d biased = detected(two, bias, static_cast<std::uint64_t>(seed));
    CHECK(rms_change(biased, two, 1) < 1e-4);
    sum += std::pow(rms_of_all(biased, two), 2) / kSeeds;
  }
  CHECK(std::sqrt(sum) == near(0.01, 0.05));
}

TEST_CASE("noise does not hang on the frame rate, but for what is new in every frame") {
  DetectorNoise noise = noiseless();
  noise.drift = 0.01;
  const Track2d slow = standing(4000, 30), fast = standing(16000, 120);
  CHECK(rms_change(detected(slow, noise, 1), slow, 3) ==
        near(rms_change(detected(fast, noise, 1), fast, 12), 0.05));
}

TEST_CASE("noise grows with speed") {
  Track2d exact = standing(4000);
  // One body height a second, there and back.
  for (int t = 0; t < exact.frames(); ++t)
    exact.x_px.row(t).array() += kHeight_px / 30.0 * (t % 400 < 200 ? t % 200 : 200 - t % 200);
  DetectorNoise noise = noiseless();
  noise.jitter = 0.002;
  noise.jitter_speed = 0.004;
  CHECK(rms_of_all(detected(exact, noise, 1), exact) == near(0.006, 0.03));
  noise = noiseless();
  noise.drift = 0.01;
  noise.drift_speed = 0.5;
  CHECK(rms_of_all(detected(exact, noise, 1), exact) == near(0.015, 0.06));
}

TEST_CASE("what is hidden is less sure: further off, lost and astray more often, less confident") {
  const Track2d exact = standing(4000);
  DetectorNoise noise = noiseless();
  noise.hidden = 0.02;
  CHECK(rms_of_all(detected(exact, noise, 1, true), exact) == near(0.02, 0.08));
  CHECK(same(detected(exact, noise, 1, false), exact));

  noise = noiseless();
  noise.lost = 0.05;
  noise.lost_hidden = 0.3;
  const auto missing = [&](bool hidden) {
    const Track2d track = detected(standing(20000), noise, 3, hidden);
    CHECK(((track.confidence.array() == 0) == track.x_px.array().isNaN()).all());
    CHECK((track.x_px.array().isNaN() == track.y_px.array().isNaN()).all());
    return (track.confidence.array() == 0).cast<double>().mean();
  };
  CHECK(missing(false) == near(0.05, 0.1));
  CHECK(missing(true) == near(0.3, 0.05));

  noise = noiseless();
  noise.confidence = 0.8;
  noise.confidence_hidden = 0.4;
  CHECK(detected(exact, noise, 4, false).confidence.mean() == doctest::Approx(0.8));
  CHECK(detected(exact, noise, 4, true).confidence.mean() == doctest::Approx(0.4));
  noise.confidence = noise.confidence_hidden = 0.5;
  noise.confidence_spread = 0.05;
  const auto spread = [&](bool hidden) {
    return std::sqrt((detected(exact, noise, 4, hidden).confidence.array() - 0.5).square().mean());
  };
  CHECK(spread(false) == near(0.05, 0.05));
  CHECK(spread(true) == near(0.1, 0.05));

  noise = noiseless();
  noise.stray_hidden = 0.3;
  noise.stray_size = 0.2;
  const Track2d strayed = detected(exact, noise, 5, true);
  CHECK((strayed.x_px.array() != exact.x_px.array()).cast<double>().mean() == near(0.3, 0.1));
  CHECK(same(detected(exact, noise, 5, false), exact));
}

TEST_CASE("joints go astray in the share, for the time and with the confidence that are set") {
  constexpr int kFrames = 40000;
  const Track2d exact = standing(kFrames);
  DetectorNoise noise = noiseless();
  noise.stray = 0.01;
  noise.stray_hands = 0.1;
  noise.stray_size = 0.2;
  noise.stray_s = 0.2;
  noise.confidence_stray = 0.3;
  const Track2d track = detected(exact, noise, 5);
  const auto astray = [&](Eigen::Index column) {
    return ((track.x_px - exact.x_px).col(column).array() != 0).eval();
  };
  double of_others = 0, of_hands = 0, episodes = 0;
  for (Eigen::Index column = 0; column < kLeftWrist; ++column)
    of_others += astray(column).cast<double>().mean() / kLeftWrist;
  CHECK(of_others == near(0.01, 0.3));
  std::vector<double> sizes;
  for (const int hand : {kLeftWrist, kRightWrist}) {
    const auto off_now = astray(hand);
    of_hands += off_now.cast<double>().mean() / 2;
    const auto place = [&](Eigen::Index t) {
      return Eigen::Vector2d(track.x_px(t, hand), track.y_px(t, hand));
    };
    for (Eigen::Index t = 0; t < off_now.size(); ++t) {
      CHECK(track.confidence(t, hand) == (off_now[t] ? 0.3 : 1.0));
      if (!off_now[t]) continue;
      if (t > 0 && off_now[t - 1]) {
        CHECK(place(t) == place(t - 1));  // it stays where it went
        continue;
      }
      ++episodes;
      const Eigen::Vector2d from(exact.x_px(t, hand), exact.y_px(t, hand));
      sizes.push_back((place(t) - from).norm() / kHeight_px);
    }
  }
  CHECK(of_hands == near(0.1, 0.15));
  // Half a frame more than is set: time comes in frames.
  CHECK(of_hands * 2 * kFrames / 30 / episodes == near(0.2 + 0.5 / 30, 0.15));
  std::ranges::sort(sizes);
  CHECK(sizes[sizes.size() / 2] == near(0.2, 0.1));
}

TEST_CASE("legs that are close are swapped in the share that is set, all that they carry at once") {
  Track2d exact = standing(20000);
  for (const int left : {kLeftKnee, kLeftAnkle})  // 10 px apart: close
    exact.x_px.col(left == kLeftKnee ? kRightKnee : kRightAnkle) =
        exact.x_px.col(left).array() + 10.0;
  DetectorNoise noise = noiseless();
  noise.swapped_legs = 0.2;
  const Track2d track = detected(exact, noise, 6);
  const auto moved = [&](Eigen::Index column) {
    return ((track.x_px - exact.x_px).col(column).array() != 0).eval();
  };
  const auto swapped = moved(kLeftKnee);
  CHECK(swapped.cast<double>().mean() == near(0.2, 0.1));
  CHECK(mean_episode(swapped) / 30 == near(noise.swap_s + 0.5 / 30, 0.1));
  for (const int other : {1, 2, kRightKnee, kLeftAnkle, kRightAnkle, kLeftHeel, kRightHeel})
    CHECK((moved(other) == swapped).all());
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    if (!swapped[t]) continue;
    CHECK(track.x_px(t, kLeftHeel) == exact.x_px(t, kRightHeel));
    CHECK(track.x_px(t, kRightAnkle) == exact.x_px(t, kLeftAnkle));
  }
  for (const int other : {0, kLeftWrist, kRightWrist}) CHECK(!moved(other).any());
  noise = noiseless();
  noise.swapped_arms = 0.2;
  CHECK(same(detected(exact, noise, 6), exact));  // they are 41 px apart: not close
  exact.x_px.col(kRightWrist) = exact.x_px.col(kLeftWrist).array() + 1.0;
  // Whether arms are has nothing to do with whether legs are.
  noise.swapped_legs = 0.2;
  const Track2d both = detected(exact, noise, 6);
  const auto arms = ((both.x_px - exact.x_px).col(kLeftWrist).array() != 0).eval(),
             legs = ((both.x_px - exact.x_px).col(kLeftKnee).array() != 0).eval();
  CHECK(arms.cast<double>().mean() == near(0.2, 0.1));
  CHECK((arms && legs).cast<double>().mean() == near(0.2 * 0.2, 0.3));
  exact = standing(2000);
  noise = noiseless();
  noise.swapped_legs = 0.5;
  for (const int joint : {kRightKnee, kRightAnkle}) exact.x_px.col(joint).array() += 300.0;
  CHECK(same(detected(exact, noise, 6), exact));
}

TEST_CASE("noise follows the seed, column by column, and what is missing stays missing") {
  Track2d exact = standing(100);
  exact.x_px(7, 2) = exact.y_px(7, 2) = std::nan("");
  exact.confidence(7, 2) = 0;
  const DetectorNoise noise = detectors().front().noise;
  CHECK(same(detected(exact, noise, 1), detected(exact, noise, 1)));
  CHECK(!same(detected(exact, noise, 1), detected(exact, noise, 2)));
  const Track2d track = detected(exact, noise, 1);
  CHECK(std::isnan(track.x_px(7, 2)));
  CHECK(track.confidence(7, 2) == 0);
  CHECK(off(track, exact, 3) != off(track, exact, 5));

  Flags hidden = nothing_hidden(exact);
  hidden.col(3).setConstant(true);
  Track2d other = exact;
  detect(other, hidden, heights(exact), noise, 1);
  CHECK((other.x_px.col(5).array() == track.x_px.col(5).array()).all());
  CHECK((other.x_px.col(3).array() != track.x_px.col(3).array()).any());
}

TEST_CASE("shapes and settings that will not do are refused") {
  Track2d track = standing(10);
  CHECK_THROWS_AS(
      detect(track, Flags::Constant(9, track.joint_count(), false), heights(track), {}, 1),
      ShapeError);
  CHECK_THROWS_AS(detect(track, nothing_hidden(track), Eigen::VectorXd::Ones(3), {}, 1),
                  ShapeError);
  DetectorNoise noise;
  noise.lost = 1;
  CHECK_THROWS_AS(detect(track, nothing_hidden(track), heights(track), noise, 1), ConfigError);
  track.keypoints.clear();
  CHECK_THROWS_AS(detect(track, nothing_hidden(track), heights(track), {}, 1), ShapeError);
}

}  // namespace detector_noise_test
