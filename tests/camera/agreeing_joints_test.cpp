// Unsure joints beside an answer.

#include "camera/agreeing_joints.hpp"

#include <doctest/doctest.h>

#include <utility>

using namespace mcdbn;

TEST_CASE("agreeing joints: only what is unsure and lies elsewhere is left out") {
  Track2d answer;
  answer.joint_names = {"head", "hand", "foot"};
  answer.confidence = MatrixD::Ones(2, 3);
  answer.x_px.resize(2, 3);
  answer.x_px << 500, 600, 500, 500, 600, 500;
  answer.y_px.resize(2, 3);
  answer.y_px << 100, 300, 1100, 100, 300, 1100;  // 1000 px tall: 30 px are elsewhere
  Track2d joints = answer;
  joints.joint_names[2] = "tail";  // the answer has none
  joints.confidence << 0.5, 0.5, 0.5, 0.5, 1.0, 0.5;
  joints.x_px.col(1).array() += 31;
  joints.x_px.col(0).array() += 29;
  joints.x_px.col(2).array() += 500;
  const Track2d left = agreeing_joints(joints, answer);
  MatrixD wanted = joints.confidence;
  wanted(0, 1) = 0;
  CHECK(left.confidence == wanted);
  CHECK(left.x_px == joints.x_px);
  // A person who lies is as large in the image.
  std::swap(answer.x_px, answer.y_px);
  std::swap(joints.x_px, joints.y_px);
  CHECK(agreeing_joints(joints, answer).confidence == wanted);
}
