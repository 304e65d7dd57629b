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

TEST_CASE("the page leaves out a clip that is too long, and shows those after it") {
  const auto clip_of = [](const char* name, int frames) {
    ReportClip clip;
    clip.name = name;
    clip.point_names = {"Hips", "Head"};
    clip.parents = {-1, 0};
    clip.joints = 2;
    clip.truth_mm = MatrixD::Random(frames, 6) * 1000;
    clip.track_px = MatrixD::Random(frames, 4) * 1000;
    clip.samples = {{clip.truth_mm, {}}};
    return clip;
  };
  const ReportClip endless = clip_of("endless", 60'000), one = clip_of("one", 60),
                   other = clip_of("other", 60);
  const std::size_t room = std::size_t{100} * 60;  // for both, with every frame
  const PageMotion motion = page_motion({endless, one, endless, other}, room);
  REQUIRE(motion.clips.size() == 2);
  CHECK(motion.clips[0].at("name") == "one");
  CHECK(motion.clips[1].at("name") == "other");
  CHECK(motion.left_out_clips == 2);
  CHECK(motion.frame_step == 1);  // fewer frames would not make room for another clip
  CHECK(motion.clips[1].at("frames") == 60);
}
