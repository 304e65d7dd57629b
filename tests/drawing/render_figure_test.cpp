// What of a skeleton is drawn.
#include "drawing/render_figure.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "motion/synthetic_motion.hpp"

namespace render_figure_test {

using namespace mcdbn;
using rendering::Figure;

namespace {

double longest_bone(const Figure& figure) {
  double longest = 0;
  for (int frame = 0; frame < static_cast<int>(figure.points.rows()); ++frame)
    for (const Figure::Bone& bone : figure.bones)
      longest =
          std::max(longest, (figure.point(frame, bone.from) - figure.point(frame, bone.to)).norm());
  return longest;
}

double lowest(const MatrixD& joints) {
  return joints(Eigen::all, Eigen::seqN(1, joints.cols() / 3, 3)).minCoeff();
}

}  // namespace

TEST_CASE("figure: a root that stays while the body walks is no part of it") {
  const Motion whole = test::swinging(test::small_body(), 40);
  const Motion below = test::swinging(test::small_body_below_still_root(), 40);
  REQUIRE(moving_root({&below}) == 1);
  const Figure figure(below), same(whole);
  // All bones but the one to the still root.
  CHECK(figure.bones.size() == same.bones.size());
  CHECK(std::ranges::none_of(
      figure.bones, [](const Figure::Bone& bone) { return bone.from == 0 || bone.to == 0; }));
  CHECK(longest_bone(figure) < 60);
  CHECK(joint_positions(below).leftCols(3).isZero());
  CHECK(figure.points.leftCols(3) == figure.points.middleCols(3, 3));
  CHECK(figure.ground_y == doctest::Approx(lowest(joint_positions(below).rightCols(42))));
  CHECK(figure.root.col(0) == figure.points.col(3));
  // Elsewhere every joint is drawn where it is.
  CHECK(same.bones.size() == 14);
  CHECK(same.points.leftCols(42) == joint_positions(whole));
}

}  // namespace render_figure_test
