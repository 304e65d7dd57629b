#include "evaluation/page_motion.hpp"

#include <doctest/doctest.h>

using namespace mcdbn;

TEST_CASE("the page knows whose side each point is on; an end is on its joint's") {
  ReportClip clip;
  clip.name = "clip";
  clip.point_names = {"Hips", "LeftArm", "RHand", "LeftToe end", "odd end"};
  clip.parents = {-1, 0, 0, 1, 2};
  clip.joints = 3;
  clip.truth_mm = MatrixD::Zero(4, 15);
  clip.track_px = MatrixD::Zero(4, 6);
  const PageMotion motion = page_motion({clip}, 1'000'000);
  REQUIRE(motion.clips.size() == 1);
  CHECK(motion.clips[0].at("sides") == std::vector<int>{0, -1, 1, -1, 1});
}
