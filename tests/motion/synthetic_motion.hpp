#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn::test {

using enum Channel;

inline Joint make_joint(std::string name, int parent, Eigen::Vector3d offset,
                        std::vector<Channel> channels) {
  Joint joint;
  joint.name = std::move(name);
  joint.parent = parent;
  joint.offset = offset;
  joint.channels = std::move(channels);
  return joint;
}

/// A body of about 170 units with three rotation orders, a joint without channels (Chest) and one
/// at its parent's position (LHip).
inline Skeleton small_body() {
  const std::vector<Channel> zxy{z_rotation, x_rotation, y_rotation};
  const std::vector<Channel> xyz{x_rotation, y_rotation, z_rotation};
  const std::vector<Channel> zyx{z_rotation, y_rotation, x_rotation};
  Skeleton body;
  body.joints = {
      make_joint("Hips", -1, {0, 0, 0},
                 {x_position, y_position, z_position, z_rotation, y_rotation, x_rotation}),
      make_joint("LHip", 0, {0, 0, 0}, zyx),
      make_joint("LLeg", 1, {9, -5, 0}, zxy),
      make_joint("LShin", 2, {0, -41.7, 0}, xyz),
      make_joint("LFoot", 3, {0, -41.8, 0}, zxy),
      make_joint("RLeg", 0, {-9, -5, 0}, zxy),
      make_joint("RShin", 5, {0, -41.7, 0}, xyz),
      make_joint("RFoot", 6, {0, -41.8, 0}, zxy),
      make_joint("Chest", 0, {0, 30, 1}, {}),
      make_joint("Neck", 8, {0, 20, -1}, zyx),
      make_joint("LArm", 8, {18, 15, 0}, xyz),
      make_joint("LHand", 10, {45, 0, 0}, zxy),
      make_joint("RArm", 8, {-18, 15, 0}, xyz),
      make_joint("RHand", 12, {-45, 0, 0}, zxy),
  };
  body.joints[9].end_sites.push_back({0, 20, 0});
  return body;
}

/// The same body below a joint that stands still, with position channels on every joint that
/// differ a little from the OFFSETs, as in the Bandai files.
inline Skeleton small_body_below_still_root() {
  Skeleton body = small_body();
  for (Joint& joint : body.joints) {
    ++joint.parent;
    if (joint.parent > 0) {
      joint.channels.insert(joint.channels.begin(), {x_position, y_position, z_position});
    }
  }
  body.joints[0].offset = {3, 90, -400};
  body.joints.insert(body.joints.begin(), make_joint("World", -1, {0, 0, 0},
                                                     {x_position, y_position, z_position,
                                                      z_rotation, x_rotation, y_rotation}));
  return body;
}

/// Every rotation of every joint but `still` swings, each at its own pace, while the root (the
/// first joint but "World") walks along a curve, turning by 500 degrees on the way.
inline Motion swinging(const Skeleton& skeleton, int frames, double fps = 30,
                       const std::vector<std::string>& still = {}) {
  Motion motion{skeleton, 1 / fps, MatrixD::Zero(frames, skeleton.channel_count())};
  for (int frame = 0; frame < frames; ++frame) {
    const double time_s = frame / fps;
    int column = 0;
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      const Joint& joint = skeleton.joints[j];
      const bool is_root = joint.name == "Hips";
      bool is_still = joint.name == "World";
      for (const std::string& name : still) is_still = is_still || name == joint.name;
      for (const Channel channel : joint.channels) {
        const int axis = axis_of(channel);
        double value = 0;
        if (is_rotation(channel)) {
          value = is_still ? (joint.name == "World" ? 0 : 10.0 * (axis + 1))
                           : 35 * std::sin((2 + 0.3 * j + axis) * time_s + j);
          if (is_root && channel == y_rotation) value = 500.0 * frame / frames;
        } else if (is_root) {
          value = axis == 1 ? 90 + 2 * std::sin(12 * time_s)
                            : 60 * std::sin(0.7 * time_s + 2 * axis) + 80 * time_s * (axis == 2);
        } else if (joint.name != "World") {
          value = joint.offset[axis] + 0.3;
        }
        motion.channels(frame, column++) = value;
      }
    }
  }
  return motion;
}

}  // namespace mcdbn::test
