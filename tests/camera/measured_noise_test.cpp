// What a track's own noise is measured to be.

#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "base/near.hpp"
#include "camera/standing_body.hpp"
#include "mcdbn/base/errors.hpp"

namespace measured_noise_test {

using namespace mcdbn;
using namespace mcdbn::test;
using namespace mcdbn::test::standing_body;

TEST_CASE("a track's own noise is measured again: its size, its gaps and its confidence") {
  Track2d exact = standing(9000);
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
  // Taken where legs look longest, which noise makes longer.
  CHECK(person_height_px(track) == near(kHeight_px, 0.08));
  const DetectorNoise found = measured_noise(track, kHeight_px);
  // The track's own noise counts as speed, with which noise grows: it is found 12 % too small.
  CHECK(found.drift == near(noise.drift, 0.15));
  CHECK(found.bias == near(noise.bias, 0.15));
  CHECK(found.jitter == near(noise.jitter, 0.15));
  CHECK(found.hidden == near(2 * DetectorNoise{}.hidden, 0.15));
  CHECK(found.lost == near(0.1, 0.15));
  CHECK(found.lost_s == near(0.3 + 0.5 / 30, 0.15));  // half a frame more: time comes in frames
  CHECK(found.confidence == near(0.6, 0.02));
  CHECK(found.confidence_spread == near(0.05, 0.1));
  // Hidden joints are taken for those of the lowest tenth; what is astray is no surer than they.
  constexpr double kTenth = 1.2816;  // deviations of a normal distribution
  CHECK(found.confidence_hidden == near(0.6 - kTenth * 0.05, 0.02));
  CHECK(found.confidence_stray == DetectorNoise{}.confidence_stray);
  Track2d unsure = track;
  unsure.confidence *= 0.4;
  const DetectorNoise of_unsure = measured_noise(unsure, kHeight_px);
  CHECK(of_unsure.confidence_hidden == near(0.4 * found.confidence_hidden, 1e-9));
  CHECK(of_unsure.confidence_stray == of_unsure.confidence_hidden);
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
  CHECK(share == near(0.2, 0.1));
  track.confidence.leftCols(3).setZero();
  track.confidence.topRows(1000).setZero();
  CHECK(measured_noise(track, kHeight_px).lost == near(share, 0.1));
}

}  // namespace measured_noise_test
