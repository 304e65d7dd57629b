#include "mcdbn/camera/track_stretches.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "camera/keypoint_track.hpp"
#include "camera/role_body.hpp"
#include "camera/show_only.hpp"
#include "mcdbn/camera/joint_sets.hpp"

namespace track_stretches_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr double kHeight_px = 300;

/// Somebody 300 px tall who walks to the right at a height in two seconds, 30 frames a second.
Track2d walking(int frames) {
  Track2d track;
  track.joint_names = {"Hips", "LHand", "RHand", "LFoot", "RFoot"};
  const double x[]{0, -40, 40, -30, 30}, y[]{150, 140, 145, 300, 0};
  track.x_px.resize(frames, 5);
  track.y_px.resize(frames, 5);
  track.confidence = MatrixD::Ones(frames, 5);
  for (int t = 0; t < frames; ++t)
    for (int joint = 0; joint < 5; ++joint) {
      track.x_px(t, joint) = 400 + kHeight_px * t / 60 + x[joint];
      track.y_px(t, joint) = 200 + y[joint];
    }
  return track;
}

void move(Track2d& track, int first, int frames, double heights) {
  track.x_px.middleRows(first, frames).array() += heights * kHeight_px;
}

/// OpenPose's joints of somebody about as tall who stands still.
Track2d standing(int frames) {
  Track2d track;
  track.keypoints = joint_set("BODY_25").keypoints;
  for (const Keypoint& keypoint : track.keypoints) track.joint_names.push_back(keypoint.name);
  track.x_px = track.y_px = track.confidence = MatrixD::Ones(frames, track.joint_count());
  for (int joint = 0; joint < track.joint_count(); ++joint) {
    track.x_px.col(joint).setConstant(600 + 20 * (joint % 4));
    track.y_px.col(joint).setConstant(200 + 12 * joint);
  }
  return track;
}

/// From that frame on so many times larger, about the hips.
void magnify(Track2d& track, int first, int frames, double times) {
  const int hips = track.find("MidHip");
  for (MatrixD* values : {&track.x_px, &track.y_px})
    for (int t = first; t < first + frames; ++t) {
      const double centre = (*values)(t, hips);
      values->row(t) = centre + times * (values->row(t).array() - centre);
    }
}

}  // namespace

TEST_CASE("stretches: frames that show nobody are those without any joint") {
  Track2d track = walking(20);
  CHECK(frames_of_nobody(track).empty());
  track.confidence.topRows(3).setZero();
  track.confidence.row(8).setZero();
  track.confidence.row(10).head(4).setZero();  // a foot is left
  track.confidence.bottomRows(1).setZero();
  CHECK(frames_of_nobody(track) == std::vector<FrameRange>{{0, 3}, {8, 1}, {19, 1}});
  track.confidence.setZero();
  CHECK(frames_of_nobody(track) == std::vector<FrameRange>{{0, 20}});
  CHECK(frames_of_nobody(walking(0)).empty());
}

TEST_CASE("stretches: a person who goes on is one, whatever joints come and go") {
  Track2d track = walking(90);
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 90}});
  track.confidence.middleRows(20, 30).setZero();
  track.confidence.col(3).tail(20).setZero();
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 90}});
  track.confidence.setZero();
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 90}});
  CHECK(find_stretches(walking(1)).stretches == std::vector<FrameRange>{{0, 1}});
  CHECK(find_stretches(walking(0)).stretches.empty());
}

TEST_CASE("stretches: who is suddenly elsewhere begins another") {
  Track2d track = walking(90);
  move(track, 40, 50, 1.1);
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 40}, {40, 50}});
  // Frames between that show no person belong to the former.
  track.confidence.middleRows(37, 3).setZero();
  move(track, 40, 50, 1);
  const TrackStretches found = find_stretches(track);
  CHECK(found.stretches == std::vector<FrameRange>{{0, 40}, {40, 50}});
  CHECK(found.strays.empty());
  // In two seconds one can go there.
  track.confidence.middleRows(0, 37).setZero();
  track.confidence.middleRows(37, 3).setOnes();
  track.confidence.topRows(10).setOnes();
  track.confidence.middleRows(10, 60).setZero();
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 90}});
}

TEST_CASE("stretches: who is suddenly of another size begins another") {
  for (const double times : {2.5, 0.4}) {
    CAPTURE(times);
    Track2d track = standing(110);
    magnify(track, 60, 50, times);
    CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 60}, {60, 50}});
    // The close-up shows hips and arms alone.
    show_only(track, 60, 50,
              {"LHip", "RHip", "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist"});
    CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 60}, {60, 50}});
    // In a second one can come near.
    track.confidence.middleRows(45, 30).setZero();
    CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 110}});
    Track2d moment = standing(110);
    magnify(moment, 60, 4, times);
    CHECK(find_stretches(moment).stretches == std::vector<FrameRange>{{0, 110}});
    CHECK(find_stretches(moment).strays == std::vector<FrameRange>{{60, 4}});
  }
}

TEST_CASE("stretches: who becomes larger within a second, or wavers in size, is one") {
  Track2d track = standing(110);
  for (int t = 0; t < 30; ++t) magnify(track, 40 + t, 1, 1 + 3.0 * t / 30);
  magnify(track, 70, 40, 4);
  for (int t = 0; t < 30; t += 2) magnify(track, t, 1, 1.3);
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 110}});
  CHECK(find_stretches(track).strays.empty());
}

TEST_CASE("stretches: who squats or turns is as large as before") {
  const Skeleton body = role_body();
  Motion motion = standing_still(body, 90);
  motion.frame_time_s = 1.0 / 30;
  const auto turn = [&](const std::string& joint, int axis, double angle_deg) {
    motion.channels.col(body.first_channel(body.find(joint)) + axis)
        .tail(45)
        .setConstant(angle_deg);
  };
  const auto stretches = [&] {
    return find_stretches(keypoint_track(motion, place_camera(motion, {}), coco_keypoints()))
        .stretches;
  };
  for (const std::string& side : {std::string("Left"), std::string("Right")}) {
    turn(side + "UpLeg", 1, -110);
    turn(side + "Leg", 1, 130);
  }
  CHECK(stretches() == std::vector<FrameRange>{{0, 90}});
  motion = standing_still(body, 90);
  motion.frame_time_s = 1.0 / 30;
  turn("Hips", 5, 90);  // to the side
  CHECK(stretches() == std::vector<FrameRange>{{0, 90}});
}

TEST_CASE("stretches: no runner is cut in two, and nothing where no person stays") {
  Track2d track = walking(90);
  for (int t = 0; t < 90; ++t) move(track, t, 1, 6.0 * t / track.fps);
  CHECK(find_stretches(track).stretches.size() == 1);
  for (int t = 45; t < 90; ++t) move(track, t, 1, 60.0 * t / track.fps);
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 90}});
  CHECK(find_stretches(track).strays.size() == 45);
  for (int t = 0; t < 45; ++t) move(track, t, 1, 60.0 * t / track.fps);
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 90}});
  CHECK(find_stretches(track).strays.empty());
}

TEST_CASE("stretches: some frames elsewhere are strays, and the others are one") {
  Track2d track = walking(90);
  move(track, 40, 5, 2);
  move(track, 60, 1, -3);
  const TrackStretches found = find_stretches(track);
  CHECK(found.stretches == std::vector<FrameRange>{{0, 90}});
  CHECK(found.strays == std::vector<FrameRange>{{40, 5}, {60, 1}});
  // Neither is the beginning lost, nor the end, nor what lies between two.
  Track2d often = walking(90);
  for (const int at : {5, 30, 32, 36, 86}) move(often, at, 1, at % 4 == 0 ? -2 : 3);
  CHECK(find_stretches(often).stretches == std::vector<FrameRange>{{0, 90}});
  CHECK(find_stretches(often).strays ==
        std::vector<FrameRange>{{5, 1}, {30, 1}, {32, 1}, {36, 1}, {86, 1}});
  leave_out(track, found.strays);
  CHECK(track.confidence.rowwise().sum().isApprox([] {
    Eigen::VectorXd seen = Eigen::VectorXd::Constant(90, 5);
    seen.segment(40, 5).setZero();
    seen[60] = 0;
    return seen;
  }()));
  CHECK(track.x_px.row(42).array().isNaN().all());
  CHECK(track.y_px.row(60).array().isNaN().all());
}

TEST_CASE("stretches: a part of a body elsewhere is a stray, however long it is there") {
  using Names = std::vector<std::string>;
  const std::vector<Names> parts{{"RHeel", "RBigToe", "RSmallToe"},
                                 {"RKnee", "RAnkle", "RHeel"},
                                 {"RShoulder", "RElbow", "RWrist"},
                                 {"RShoulder", "RElbow", "RWrist", "LShoulder"}};
  for (const FrameRange& range :
       std::vector<FrameRange>{{98, 12}, {60, 12}, {60, 40}, {0, 12}, {50, 60}})
    for (const Names& part : parts) {
      CAPTURE(range.first);
      CAPTURE(range.frames);
      CAPTURE(part.front());
      Track2d track = standing(110);
      show_only(track, range.first, range.frames, part);
      move(track, range.first, range.frames, -3);
      const TrackStretches found = find_stretches(track);
      CHECK(found.stretches == std::vector<FrameRange>{{0, 110}});
      CHECK(found.strays == std::vector<FrameRange>{range});
    }
  // With the other arm it is half of the limbs' joints: a person behind a table.
  Track2d track = standing(110);
  show_only(track, 60, 50,
            {"Nose", "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist"});
  move(track, 60, 50, -3);
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 60}, {60, 50}});
}

TEST_CASE("stretches: a track that never shows more than an arm is not all strays") {
  Track2d track = standing(110);
  show_only(track, 0, 110, {"RShoulder", "RElbow", "RWrist"});
  move(track, 60, 50, -3);
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 60}, {60, 50}});
  CHECK(find_stretches(track).strays.empty());
}

TEST_CASE("stretches: frames are described by the first and the last") {
  CHECK(described(std::vector<FrameRange>{}).empty());
  CHECK(described(std::vector<FrameRange>{{0, 12}, {30, 1}, {40, 13}}) == "0-11, 30, 40-52");
  // By the file's numbers, which may be those of days.
  const std::vector<long long> numbers{3'487'918'223, 3'487'918'224, 3'487'918'230};
  CHECK(described(std::vector<FrameRange>{{0, 2}, {2, 1}}, numbers) ==
        "3487918223-3487918224, 3487918230");
}

TEST_CASE("stretches: of a detector's joints those of the limbs decide") {
  Track2d track = walking(90);
  track.keypoints.resize(5);
  using enum JointRole;
  const JointRole roles[]{pelvis, left_wrist, right_wrist, left_ankle, right_ankle};
  for (int joint = 0; joint < 5; ++joint) track.keypoints[joint].role = roles[joint];
  track.x_px.col(0).tail(30).array() += 100 * kHeight_px;
  CHECK(find_stretches(track).stretches.size() == 1);
  move(track, 60, 30, 2);
  CHECK(find_stretches(track).stretches == std::vector<FrameRange>{{0, 60}, {60, 30}});
}

}  // namespace track_stretches_test
