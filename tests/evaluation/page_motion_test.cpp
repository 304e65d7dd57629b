#include "evaluation/page_motion.hpp"

#include <doctest/doctest.h>

#include "evaluation/motion_code.hpp"

using namespace mcdbn;

TEST_CASE("the page has each point's side; an end is on its joint's") {
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

TEST_CASE(
    "the page holds an answer's uncertainty, every so manieth frame of it, where it is given") {
  ReportClip clip;
  clip.name = "clip";
  clip.point_names = {"Hips", "Head"};
  clip.parents = {-1, 0};
  clip.joints = 2;
  clip.truth_mm = MatrixD::Zero(4, 6);
  clip.track_px = MatrixD::Zero(4, 4);
  MatrixD deviation_mm = MatrixD::Zero(4, 6);
  deviation_mm.rightCols(3) << 10, 20, 30, 11, 21, 31, 12, 22, 32, 14, 24, 34;
  clip.samples = {{clip.truth_mm, {}, deviation_mm}, {clip.truth_mm, {}}};
  const auto motions = page_motion({clip}, 1'000'000).clips.at(0).at("motions");
  CHECK(motions.at(0).at("deviation_mm") == encode_series(deviation_mm));
  CHECK(!motions.at(1).contains("deviation_mm"));
}

TEST_CASE("the page holds the simpler methods' answers while there is room, and tells where not") {
  ReportClip clip;
  clip.name = "clip";
  clip.point_names = {"Hips", "Head"};
  clip.parents = {-1, 0};
  clip.joints = 2;
  clip.truth_mm = MatrixD::Random(600, 6) * 1000;
  clip.track_px = MatrixD::Random(600, 4) * 1000;
  clip.samples = {{clip.truth_mm, {}}};
  const std::size_t alone = std::size_t{10} * 600;  // less than all frames take, more than a sixth
  CHECK(page_motion({clip}, alone).others);         // there are none
  clip.others["ridge_window"] = {clip.truth_mm, {}};
  CHECK(page_motion({clip}, 1'000'000).others);
  const PageMotion small = page_motion({clip}, alone);
  CHECK_FALSE(small.others);
  CHECK(small.left_out_clips == 0);
  CHECK(small.clips.at(0).at("motions").size() == 1);
}
