#include "motion/turned_motion.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "mcdbn/base/errors.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// The body with its root below other nodes, whose channels hold the same in all frames.
Motion below(const std::vector<Joint>& nodes, const RowVectorD& held, Motion motion) {
  const auto count = static_cast<int>(nodes.size());
  for (Joint& joint : motion.skeleton.joints) joint.parent += count;
  motion.skeleton.joints.insert(motion.skeleton.joints.begin(), nodes.begin(), nodes.end());
  MatrixD channels(motion.frames(), held.size() + motion.channels.cols());
  channels << held.replicate(motion.frames(), 1), motion.channels;
  motion.channels = std::move(channels);
  return motion;
}

/// The largest distance of a turn's matrix or place from the one that is wanted, of joints from
/// `first` on.
double largest_error(const Motion& before, const Motion& after, const Eigen::Matrix3d& turn,
                     std::size_t first, const Eigen::VectorXd& raised_by = {}) {
  double error = 0;
  for (int t = 0; t < before.frames(); ++t) {
    const WorldPose was = forward_kinematics(before.skeleton, before.channels.row(t)),
                    is = forward_kinematics(after.skeleton, after.channels.row(t));
    const Eigen::Vector3d raised(0, raised_by.size() > 0 ? raised_by[t] : 0, 0);
    for (std::size_t j = first; j < was.position.size(); ++j) {
      error = std::max(error, (turn * was.position[j] + raised - is.position[j]).norm());
      error = std::max(error, (turn * was.world_from_joint[j] - is.world_from_joint[j]).norm());
    }
  }
  return error;
}

}  // namespace

TEST_CASE("turned motion: every joint is where the turn takes it, in every frame") {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.2, -0.9, 0.4).normalized()).toRotationMatrix();
  const Motion motion = swinging(small_body(), 40);
  const Motion turned = turned_motion(motion, turn);
  const MatrixD before = joint_positions(motion), after = joint_positions(turned);
  for (Eigen::Index joint = 0; joint < before.cols(); joint += 3)
    CHECK((after.middleCols(joint, 3) - before.middleCols(joint, 3) * turn.transpose())
              .cwiseAbs()
              .maxCoeff() < 1e-9);
  // Its own joints do not know of it.
  const int own = motion.skeleton.first_channel(1);
  CHECK(turned.channels.rightCols(turned.channels.cols() - own) ==
        motion.channels.rightCols(motion.channels.cols() - own));
  CHECK(turned.frame_time_s == motion.frame_time_s);
}

TEST_CASE("turned motion: angles run on without jumps") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(3.0, Eigen::Vector3d::UnitY()).toRotationMatrix();
  // Turns by 500 degrees on its way.
  const Motion turned = turned_motion(swinging(small_body(), 200), turn);
  const MatrixD steps = turned.channels.bottomRows(199) - turned.channels.topRows(199);
  for (int k = 0; k < 6; ++k)
    if (is_rotation(turned.skeleton.joints[0].channels[static_cast<std::size_t>(k)]))
      CHECK(steps.col(k).cwiseAbs().maxCoeff() < 90);
}

TEST_CASE("turned motion: a body below nodes that stand turns, and they stay") {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.3, Eigen::Vector3d(0.6, 0.7, -0.2).normalized()).toRotationMatrix();
  const Motion body = swinging(small_body(), 20);
  const Joint scene = make_joint("Scene", -1, {0, 0, 0}, {}),
              aside = make_joint("Scene", -1, {40, -3, 200}, {}),
              turned_scene = make_joint("Scene", -1, {40, -3, 200}, {y_rotation}),
              group = make_joint("Group", 0, {0, 10, 5}, {x_rotation});
  for (const Motion& motion :
       {below({scene}, RowVectorD(), body), below({aside}, RowVectorD(), body),
        below({turned_scene, group}, RowVectorD{{70, -25}}, body)}) {
    const int nodes = motion.skeleton.find("Hips"), own = motion.skeleton.first_channel(nodes);
    CAPTURE(nodes);
    const Motion turned = turned_motion(motion, turn);
    CHECK(largest_error(motion, turned, turn, static_cast<std::size_t>(nodes)) < 1e-8);
    CHECK(turned.channels.leftCols(own) == motion.channels.leftCols(own));
  }
}

TEST_CASE("turned motion: a node that moves the body without turning it carries it round") {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(-2.2, Eigen::Vector3d(0.1, 0.9, 0.3).normalized()).toRotationMatrix();
  Motion motion = swinging(small_body(), 20);
  // The same channels: positions of a node, rotations of the hips below it.
  Joint& hips = motion.skeleton.joints[0];
  const Joint node = make_joint("Node", -1, {0, 0, 0}, {x_position, y_position, z_position});
  hips.channels.erase(hips.channels.begin(), hips.channels.begin() + 3);
  hips.offset = {2, -7, 1};
  motion = below({node}, RowVectorD(), std::move(motion));
  CHECK(largest_error(motion, turned_motion(motion, turn), turn, 1) < 1e-8);
}

TEST_CASE("turned motion: it stands higher by as much as is asked for, frame by frame") {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const Eigen::VectorXd raised_by = Eigen::VectorXd::LinSpaced(20, -5, 30);
  const Motion body = swinging(small_body(), 20);
  const Motion under =
      below({make_joint("Scene", -1, {1, 2, 3}, {z_rotation})}, RowVectorD::Constant(1, 35), body);
  CHECK(largest_error(body, turned_motion(body, turn, raised_by), turn, 0, raised_by) < 1e-8);
  CHECK(largest_error(under, turned_motion(under, turn, raised_by), turn, 1, raised_by) < 1e-8);
}

TEST_CASE("turned motion: a body that no joint turns as a whole is an error") {
  Motion motion = swinging(small_body(), 2);
  motion.skeleton.joints[0].channels = {x_position, y_position, z_position};
  CHECK_THROWS_WITH_AS(turned_motion(motion, Eigen::Matrix3d::Identity()),
                       doctest::Contains("no joint turns the whole body"), InputError);
}
