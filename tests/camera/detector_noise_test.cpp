#include "camera/detector_noise.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "camera/keypoint_pairs.hpp"
#include "mcdbn/base/errors.hpp"

namespace detector_noise_test {

using namespace mcdbn;

namespace {

constexpr double kHeight_px = 400;
using enum JointRole;

Keypoint keypoint(const char* name, JointRole role, Eigen::Vector3d offset = {0, 0, 0}) {
  Keypoint made;
  made.name = name;
  made.role = role;
  made.offset = offset;
  return made;
}

const std::vector<Keypoint> kBody = {
    keypoint("nose", head, {0, 0, 0.07}),
    keypoint("LHip", left_hip),
    keypoint("RHip", right_hip),
    keypoint("LKnee", left_knee),
    keypoint("RKnee", right_knee),
    keypoint("LAnkle", left_ankle),
    keypoint("LHeel", left_ankle, {0, -0.02, -0.03}),
    keypoint("RHeel", right_ankle, {0, -0.02, -0.03}),
    keypoint("RAnkle", right_ankle),
    keypoint("LWrist", left_wrist),
    keypoint("RWrist", right_wrist),
};
constexpr int kLeftKnee = 3, kRightKnee = 4, kLeftAnkle = 5, kLeftHeel = 6, kRightHeel = 7,
              kRightAnkle = 8, kLeftWrist = 9, kRightWrist = 10;

/// A body that stands still, its joints 40 px from each other.
Track2d standing(int frames, double fps = 30) {
  Track2d track;
  track.keypoints = kBody;
  track.fps = fps;
  for (const Keypoint& point : kBody) track.joint_names.push_back(point.name);
  const auto joints = static_cast<Eigen::Index>(kBody.size());
  track.x_px = MatrixD::Constant(frames, joints, 500);
  track.y_px = MatrixD::Constant(frames, joints, 300);
  for (Eigen::Index j = 0; j < joints; ++j) track.x_px.col(j).array() += 41.0 * j;
  track.confidence = MatrixD::Ones(frames, joints);
  return track;
}

Flags nothing_hidden(const Track2d& track) {
  return Flags::Constant(track.frames(), track.joint_count(), false);
}

Eigen::VectorXd heights(const Track2d& track) {
  return Eigen::VectorXd::Constant(track.frames(), kHeight_px);
}

DetectorNoise noiseless() {
  DetectorNoise none;
  visit_settings(none, [](const Setting& setting, double& value) {
    if (setting.range.contains(0)) value = 0;
  });
  none.confidence = 1;
  return none;
}

Track2d detected(const Track2d& exact, const DetectorNoise& noise, std::uint64_t seed,
                 bool hidden = false) {
  Track2d track = exact;
  detect(track, Flags::Constant(track.frames(), track.joint_count(), hidden), heights(track), noise,
         seed);
  return track;
}

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

}  // namespace

TEST_CASE("a detector without noise gives the joints' places") {
  const Track2d exact = standing(50);
  CHECK(same(detected(exact, noiseless(), 1), exact));
}

TEST_CASE("each part of a detector's noise has the deviation and the duration of its setting") {
  const Track2d exact = standing(6000);
  DetectorNoise jitter = noiseless();
  jitter.jitter = 0.01;
  const Track2d jittered = detected(exact, jitter, 1);
  CHECK(rms_of_all(jittered, exact) == doctest::Approx(0.01).epsilon(0.02));
  CHECK(rms_change(jittered, exact, 1) == doctest::Approx(0.01 * std::sqrt(2)).epsilon(0.02));

  DetectorNoise drift = noiseless();
  drift.drift = 0.01;
  drift.drift_s = 0.5;
  const Track2d drifted = detected(exact, drift, 2);
  CHECK(rms_of_all(drifted, exact) == doctest::Approx(0.01).epsilon(0.06));
  // Of an autoregression: the correlation is exp(-t / time).
  for (const int lag : {1, 5, 15, 60})
    CHECK(rms_change(drifted, exact, lag) ==
          doctest::Approx(0.01 * std::sqrt(2 * (1 - std::exp(-lag / 15.0)))).epsilon(0.07));

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
  CHECK(std::sqrt(sum) == doctest::Approx(0.01).epsilon(0.05));
}

TEST_CASE("noise does not hang on the frame rate, but for what is new in every frame") {
  DetectorNoise noise = noiseless();
  noise.drift = 0.01;
  const Track2d slow = standing(4000, 30), fast = standing(16000, 120);
  CHECK(rms_change(detected(slow, noise, 1), slow, 3) ==
        doctest::Approx(rms_change(detected(fast, noise, 1), fast, 12)).epsilon(0.05));
}

TEST_CASE("noise grows with speed") {
  Track2d exact = standing(4000);
  // One body height a second, there and back.
  for (int t = 0; t < exact.frames(); ++t)
    exact.x_px.row(t).array() += kHeight_px / 30.0 * (t % 400 < 200 ? t % 200 : 200 - t % 200);
  DetectorNoise noise = noiseless();
  noise.jitter = 0.002;
  noise.jitter_speed = 0.004;
  CHECK(rms_of_all(detected(exact, noise, 1), exact) == doctest::Approx(0.006).epsilon(0.03));
  noise = noiseless();
  noise.drift = 0.01;
  noise.drift_speed = 0.5;
  CHECK(rms_of_all(detected(exact, noise, 1), exact) == doctest::Approx(0.015).epsilon(0.06));
}

TEST_CASE("what is hidden is less sure: further off, lost and astray more often, less confident") {
  const Track2d exact = standing(4000);
  DetectorNoise noise = noiseless();
  noise.hidden = 0.02;
  CHECK(rms_of_all(detected(exact, noise, 1, true), exact) == doctest::Approx(0.02).epsilon(0.08));
  CHECK(same(detected(exact, noise, 1, false), exact));

  noise = noiseless();
  noise.lost = 0.05;
  noise.lost_hidden = 0.3;
  const auto missing = [&](bool hidden) {
    const Track2d track = detected(exact, noise, 3, hidden);
    CHECK(((track.confidence.array() == 0) == track.x_px.array().isNaN()).all());
    CHECK((track.x_px.array().isNaN() == track.y_px.array().isNaN()).all());
    return (track.confidence.array() == 0).cast<double>().mean();
  };
  CHECK(missing(false) == doctest::Approx(0.05).epsilon(0.1));
  CHECK(missing(true) == doctest::Approx(0.3).epsilon(0.05));

  noise = noiseless();
  noise.confidence = 0.8;
  noise.confidence_hidden = 0.4;
  CHECK(detected(exact, noise, 4, false).confidence.mean() == doctest::Approx(0.8));
  CHECK(detected(exact, noise, 4, true).confidence.mean() == doctest::Approx(0.4));
}

TEST_CASE("joints go astray in the share, for the time and with the confidence that are set") {
  const Track2d exact = standing(20000);
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
  CHECK(astray(kLeftKnee).cast<double>().mean() == doctest::Approx(0.01).epsilon(0.3));
  double episodes = 0;
  std::vector<double> sizes;
  for (const int hand : {kLeftWrist, kRightWrist}) {
    const auto off_now = astray(hand);
    CHECK(off_now.cast<double>().mean() == doctest::Approx(0.1).epsilon(0.15));
    for (Eigen::Index t = 0; t < off_now.size(); ++t) {
      CHECK(track.confidence(t, hand) == (off_now[t] ? 0.3 : 1.0));
      if (!off_now[t] || (t > 0 && off_now[t - 1])) continue;
      ++episodes;
      sizes.push_back(std::hypot(track.x_px(t, hand) - exact.x_px(t, hand),
                                 track.y_px(t, hand) - exact.y_px(t, hand)) /
                      kHeight_px);
    }
  }
  // Half a frame more than is set: time comes in frames.
  CHECK(0.1 * 2 * 20000 / 30 / episodes == doctest::Approx(0.2).epsilon(0.2));
  std::ranges::sort(sizes);
  CHECK(sizes[sizes.size() / 2] == doctest::Approx(0.2).epsilon(0.1));
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
  CHECK(swapped.cast<double>().mean() == doctest::Approx(0.2).epsilon(0.1));
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
  CHECK(!same(detected(exact, noise, 6), exact));
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

TEST_CASE("a track's own noise is measured again: its size, its gaps and its confidence") {
  Track2d exact = standing(3000);
  // A leg of 0.491 body heights.
  for (const auto& [hip, knee, ankle] :
       {std::array{1, kLeftKnee, kLeftAnkle}, std::array{2, kRightKnee, kRightAnkle}}) {
    exact.x_px.col(knee) = exact.x_px.col(ankle) = exact.x_px.col(hip);
    exact.y_px.col(knee) = exact.y_px.col(hip).array() + 0.25 * kHeight_px;
    exact.y_px.col(ankle) = exact.y_px.col(hip).array() + 0.491 * kHeight_px;
  }
  CHECK(person_height_px(exact) == doctest::Approx(kHeight_px));
  DetectorNoise noise;  // OpenPose's, twice as much
  for (double* part : {&noise.bias, &noise.drift, &noise.jitter, &noise.jitter_speed}) *part *= 2;
  noise.lost = 0.1;
  noise.lost_s = 0.3;
  noise.confidence = 0.6;
  noise.confidence_spread = 0.05;
  const Track2d track = detected(exact, noise, 9);
  CHECK(person_height_px(track) == doctest::Approx(kHeight_px).epsilon(0.05));
  const DetectorNoise found = measured_noise(track, kHeight_px);
  CHECK(found.drift == doctest::Approx(noise.drift).epsilon(0.1));
  CHECK(found.bias == doctest::Approx(noise.bias).epsilon(0.1));
  CHECK(found.lost == doctest::Approx(0.1).epsilon(0.15));
  CHECK(found.lost_s == doctest::Approx(0.3).epsilon(0.15));
  CHECK(found.confidence == doctest::Approx(0.6).epsilon(0.02));
  CHECK(found.confidence_spread == doctest::Approx(0.05).epsilon(0.1));
  CHECK_THROWS_AS(measured_noise(standing(5), kHeight_px), InputError);
}

TEST_CASE("a track's gaps are those of joints that it has, while it shows anybody") {
  Track2d track = standing(40, 20);
  const auto hide = [&](Eigen::Index column, Eigen::Index first, Eigen::Index frames) {
    track.confidence.col(column).segment(first, frames).setZero();
    for (MatrixD* values : {&track.x_px, &track.y_px})
      values->col(column).segment(first, frames).setConstant(std::nan(""));
  };
  for (const int never : {0, kLeftHeel, kRightHeel}) hide(never, 0, 40);
  hide(kLeftKnee, 5, 6);
  hide(kRightWrist, 28, 2);  // to where nobody is seen any more
  for (Eigen::Index column = 0; column < track.joint_count(); ++column) hide(column, 30, 10);
  const DetectorNoise found = measured_noise(track, kHeight_px);
  const double seen_columns = 8, frames_of_anybody = 30, lost = 6 + 2, gaps = 2, fps = 20;
  CHECK(found.lost == doctest::Approx(lost / (seen_columns * frames_of_anybody)));
  CHECK(found.lost_hidden == found.lost);
  CHECK(found.lost_s == doctest::Approx(lost / gaps / fps));
  // A detector like that one has the same columns, and never sees those.
  const std::vector<Keypoint> keypoints = seen_keypoints(track);
  REQUIRE(keypoints.size() == kBody.size());
  for (std::size_t i = 0; i < kBody.size(); ++i) {
    const bool never = i == 0 || i == kLeftHeel || i == kRightHeel;
    CHECK(keypoints[i].name == kBody[i].name);
    CHECK(keypoints[i].role == (never ? std::nullopt : kBody[i].role));
    CHECK(keypoints[i].offset == (never ? Eigen::Vector3d(0, 0, 0) : kBody[i].offset));
  }
}

TEST_CASE("a track's gaps: the share that is lost is found, whatever columns are never seen") {
  const Track2d exact = standing(4000);
  DetectorNoise noise = noiseless();
  noise.lost = 0.2;
  Track2d track = detected(exact, noise, 3);
  const double share = measured_noise(track, kHeight_px).lost;
  CHECK(share == doctest::Approx(0.2).epsilon(0.1));
  track.confidence.leftCols(3).setZero();
  track.confidence.topRows(1000).setZero();
  CHECK(measured_noise(track, kHeight_px).lost == doctest::Approx(share).epsilon(0.1));
}

}  // namespace detector_noise_test
