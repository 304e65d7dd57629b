// Joints outside of the image, which a detector puts on its edge.

#include "camera/cut_off.hpp"

#include <doctest/doctest.h>

#include <utility>

using namespace mcdbn;

TEST_CASE(
    "cut off: unsure joints on the image's edge are unseen, but a limb's end after a seen joint") {
  Track2d track;
  track.width_px = 1000;
  track.height_px = 600;
  using enum JointRole;
  for (const auto& [name, role] : {std::pair{"hip", left_hip},
                                   {"knee", left_knee},
                                   {"ankle", left_ankle},
                                   {"toe", left_toe},
                                   {"wrist", right_wrist},
                                   {"elbow", right_elbow}}) {
    track.joint_names.emplace_back(name);
    track.keypoints.push_back({name, role, Eigen::Vector3d::Zero(), {}});
  }
  // Down to the feet; down to the knees; on the edge and sure; unsure inside, and beyond the edge.
  track.x_px = MatrixD::Constant(4, 6, 500);
  track.y_px = MatrixD::Constant(4, 6, 300);
  track.y_px.row(0).segment(2, 2).setConstant(599);
  track.y_px.row(1).segment(1, 3).setConstant(596);
  track.x_px.row(2).setConstant(1);
  track.x_px.row(3).setConstant(1100);
  track.x_px(3, 0) = 100;
  track.confidence = MatrixD::Ones(4, 6);
  track.confidence.row(0).segment(2, 2).setConstant(0.05);
  track.confidence.row(1).segment(1, 3).setConstant(0.05);
  track.confidence.row(2).setConstant(0.15);
  track.confidence.row(3).setConstant(0.05);
  MatrixD wanted = track.confidence;
  wanted(0, 3) = 0;  // the ankle before it is cut off itself
  wanted.row(1).segment(1, 3).setZero();
  CHECK(without_cut_off(track).confidence == wanted);
  // Without its elbow seen, a wrist on the edge is unseen, too.
  track.y_px(0, 4) = 1;
  track.confidence(0, 4) = 0.05;
  CHECK(without_cut_off(track).confidence(0, 4) == 0.05);
  track.confidence(0, 5) = 0;
  CHECK(without_cut_off(track).confidence(0, 4) == 0);
  // Of columns that are a skeleton's joints nothing is known.
  track.keypoints.clear();
  CHECK(without_cut_off(track).confidence == track.confidence);
}
