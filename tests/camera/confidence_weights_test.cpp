#include "camera/confidence_weights.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mcdbn;

TEST_CASE("confidence weights: 1 at the median, less below it, bounded above, 0 unseen") {
  Track2d track;
  track.joint_names = {"a", "b"};
  track.confidence = MatrixD::Constant(4, 2, 0.6);
  track.confidence.row(0) << 0.0, 0.3;
  track.confidence.row(1) << 0.64, 1.0;
  track.x_px = track.y_px = MatrixD::Ones(4, 2);
  const Track2d weighted = weighted_by_confidence(track);
  CHECK(weighted.confidence(0, 0) == 0);
  CHECK(weighted.confidence(0, 1) == doctest::Approx(std::pow(0.5, 2.5)));
  CHECK(weighted.confidence(1, 0) == doctest::Approx(std::pow(0.64 / 0.6, 2.5)));
  CHECK(weighted.confidence(1, 1) == 1.5);
  CHECK(weighted.confidence(2, 0) == 1);
  CHECK(weighted.x_px == track.x_px);
  // On whatever scale.
  track.confidence *= 4;
  CHECK((weighted_by_confidence(track).confidence - weighted.confidence).norm() < 1e-12);
  track.confidence.setZero();
  CHECK(weighted_by_confidence(track).confidence == track.confidence);
  CHECK(weighted_by_confidence(Track2d{}).frames() == 0);
}

TEST_CASE("confidence weights: hidden joints do not give the scale, however many there are") {
  Track2d track;
  track.joint_names = {"a", "b", "c", "d", "e"};
  track.confidence = MatrixD::Constant(6, 5, 0.1);
  track.confidence.col(0).setConstant(0.8);
  track.confidence.col(1).setConstant(0.7);
  track.x_px = track.y_px = MatrixD::Ones(6, 5);
  const Track2d weighted = weighted_by_confidence(track);
  CHECK(weighted.confidence(0, 0) == 1);
  CHECK(weighted.confidence(0, 1) == doctest::Approx(std::pow(0.7 / 0.8, 2.5)));
  CHECK(weighted.confidence(0, 2) == doctest::Approx(std::pow(0.1 / 0.8, 2.5)));
}
