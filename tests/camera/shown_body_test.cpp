#include "camera/shown_body.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "mcdbn/camera/joint_sets.hpp"

namespace shown_body_test {

using namespace mcdbn;

namespace {

using Names = std::vector<std::string>;

/// OpenPose's joints: of each frame those of that name are seen, or all where there are none.
Track2d seen(const std::vector<Names>& frames) {
  Track2d track;
  track.keypoints = joint_set("BODY_25").keypoints;
  for (const Keypoint& keypoint : track.keypoints) track.joint_names.push_back(keypoint.name);
  const auto count = static_cast<Eigen::Index>(frames.size());
  track.x_px = track.y_px = MatrixD::Zero(count, track.joint_count());
  track.confidence = MatrixD::Zero(count, track.joint_count());
  for (Eigen::Index t = 0; t < count; ++t)
    for (Eigen::Index joint = 0; joint < track.joint_count(); ++joint) {
      const Names& names = frames[static_cast<std::size_t>(t)];
      const std::string& name = track.joint_names[static_cast<std::size_t>(joint)];
      track.confidence(t, joint) = names.empty() || std::ranges::count(names, name) > 0 ? 0.1 : 0;
    }
  return track;
}

using Bodies = std::vector<bool>;

}  // namespace

TEST_CASE("shown body: half of the limbs' joints are one; what a foot carries is one joint") {
  const Names foot{"RHeel", "RBigToe", "RSmallToe"}, leg{"RKnee", "RAnkle", "RHeel", "RBigToe"},
      face{"Nose", "REye", "LEye", "REar", "LEar", "Neck", "MidHip"};
  Names arms{"RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist"};
  CHECK(frames_of_a_body(seen({{}, foot, leg, face, arms})) ==
        Bodies{true, false, false, false, true});
  arms.pop_back();  // five of twelve
  CHECK(frames_of_a_body(seen({{}, arms})) == Bodies{true, false});
}

TEST_CASE("shown body: joints that no frame shows do not count") {
  const Names arms{"RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist"};
  CHECK(frames_of_a_body(seen({arms, {"RShoulder", "RElbow", "RWrist"}, {"RElbow", "RWrist"}})) ==
        Bodies{true, true, false});
  CHECK(frames_of_a_body(seen({{"Tail"}, {"Tail"}})) == Bodies{false, false});
  CHECK(frames_of_a_body(seen({})).empty());
}

TEST_CASE("shown body: ankles and toes are feet, in the frames that show them") {
  const Names legs{"MidHip", "RHip", "LHip", "RKnee", "LKnee"};
  CHECK(!shows_feet(seen({legs, legs})));
  for (const char* foot : {"LAnkle", "RAnkle", "LBigToe", "RHeel"})
    CHECK(frames_of_feet(seen({legs, {foot}, legs})) == Bodies{false, true, false});
  CHECK(shows_feet(seen({legs, {"LAnkle"}, legs})));
  Track2d track = seen({{}});
  track.keypoints.clear();
  CHECK(!shows_feet(track));
}

TEST_CASE("shown body: without a detector's joints all columns count") {
  Track2d track = seen({{}, {"Nose"}, {}});
  track.keypoints.clear();
  track.confidence.row(2).head(12).setZero();
  CHECK(frames_of_a_body(track) == Bodies{true, false, true});
  track.confidence.row(2).head(13).setZero();
  CHECK(frames_of_a_body(track) == Bodies{true, false, false});
}

}  // namespace shown_body_test
