#include "evaluation/track_error.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace {

Track2d track(const std::vector<std::string>& names, const MatrixD& x_px, const MatrixD& y_px) {
  Track2d result;
  result.joint_names = names;
  result.x_px = x_px;
  result.y_px = y_px;
  result.confidence = MatrixD::Ones(x_px.rows(), x_px.cols());
  return result;
}

}  // namespace

TEST_CASE("track error: mean distance of the joints relative to each track's own root") {
  // The truth has a joint more, and another order.
  const Track2d truth =
      track({"Tail", "Hand", "Hips", "Foot"}, MatrixD{{900, 30, 0, 5}, {900, 130, 100, 105}},
            MatrixD{{900, 10, 0, 40}, {900, 10, 0, 40}});
  // Elsewhere on the image; the hand 3 and 4 px off in the first frame, the foot 12 in the second.
  const Track2d other = track({"Hips", "Hand", "Foot"}, MatrixD{{7, 40, 12}, {50, 80, 67}},
                              MatrixD{{2, 16, 42}, {-3, 7, 37}});
  CHECK(track_error_px(truth, other, "Hips") == doctest::Approx((5.0 + 12.0) / 4));
  CHECK(track_error_px(other, other, "Hips") == 0.0);

  Track2d hidden = truth;  // behind the camera: not counted
  hidden.x_px(0, 1) = std::numeric_limits<double>::quiet_NaN();
  CHECK(track_error_px(hidden, other, "Hips") == doctest::Approx(12.0 / 3));
  hidden.x_px.setConstant(std::numeric_limits<double>::quiet_NaN());
  CHECK(std::isnan(track_error_px(hidden, other, "Hips")));
}

TEST_CASE("track error: what cannot be compared is an error") {
  const Track2d one = track({"Hips", "Hand"}, MatrixD::Zero(3, 2), MatrixD::Zero(3, 2));
  const Track2d shorter = track({"Hips", "Hand"}, MatrixD::Zero(2, 2), MatrixD::Zero(2, 2));
  const Track2d foot = track({"Hips", "Foot"}, MatrixD::Zero(3, 2), MatrixD::Zero(3, 2));
  CHECK_THROWS_AS(track_error_px(one, shorter, "Hips"), ShapeError);
  CHECK_THROWS_WITH_AS(track_error_px(one, foot, "Hips"), doctest::Contains("Foot"), InputError);
  CHECK_THROWS_AS(track_error_px(one, one, "Pelvis"), InputError);
}
