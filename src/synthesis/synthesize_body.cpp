#include "synthesis/synthesize_body.hpp"

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "base/numbers.hpp"

namespace mcdbn::synthesis {
namespace {

// About coordinate axis 0, 1 or 2.
Eigen::Matrix3d rotation(double angle_deg, int axis) {
  const double angle = angle_deg * kRadiansPerDegree;
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn(next, next) = turn(last, last) = std::cos(angle);
  turn(last, next) = std::sin(angle);
  turn(next, last) = -turn(last, next);
  return turn;
}

const std::vector<Channel> kZxy{Channel::z_rotation, Channel::x_rotation, Channel::y_rotation};
/// For upper arms: in the order Z X Y a raised forearm would be the singular pose, in this one it
/// is the arm that points straight forward.
const std::vector<Channel> kZyx{Channel::z_rotation, Channel::y_rotation, Channel::x_rotation};

void add_joint(Skeleton& skeleton, std::string name, int parent, const Eigen::Vector3d& offset,
               std::vector<Eigen::Vector3d> end_sites = {}) {
  skeleton.joints.push_back({std::move(name), parent, offset, kZxy, std::move(end_sites)});
}

void add_arm(Skeleton& skeleton, const Body& body, Side side) {
  const std::string prefix = side == kLeft ? "Left" : "Right";
  const double sign = sign_of(side);
  const int first = arm_block(side);
  add_joint(skeleton, prefix + "Shoulder", kChest, body.clavicle_offset(side));
  add_joint(skeleton, prefix + "Arm", first, body.shoulder_offset(side));
  skeleton.joints.back().channels = kZyx;
  add_joint(skeleton, prefix + "ForeArm", first + 1, {sign * body.upper_arm, 0, 0});
  add_joint(skeleton, prefix + "Hand", first + 2, {sign * body.forearm, 0, 0},
            {{sign * body.hand, 0, 0}});
}

void add_leg(Skeleton& skeleton, const Body& body, Side side) {
  const std::string prefix = side == kLeft ? "Left" : "Right";
  const int first = leg_block(side);
  add_joint(skeleton, prefix + "UpLeg", kHips, body.hip_offset(side));
  add_joint(skeleton, prefix + "Leg", first, {0, -body.thigh, 0});
  add_joint(skeleton, prefix + "Foot", first + 1, {0, -body.shank, 0});
  add_joint(skeleton, prefix + "ToeBase", first + 2, body.ball_offset(),
            {{0, -Body::kBallHeight / 2, body.toe_length}});
}

}  // namespace

Eigen::Matrix3d rotation_x(double angle_deg) {
  return rotation(angle_deg, 0);
}
Eigen::Matrix3d rotation_y(double angle_deg) {
  return rotation(angle_deg, 1);
}
Eigen::Matrix3d rotation_z(double angle_deg) {
  return rotation(angle_deg, 2);
}

Body Body::draw(Random& random) {
  Body body{};
  body.stature = random.normal(171, 8);
  // Limbs differ between people by a few per cent at the same stature.
  const double legs = body.stature * random.normal(1, 0.02);
  const double trunk = body.stature * random.normal(1, 0.02);
  const double arms = body.stature * random.normal(1, 0.025);
  const double breadth = body.stature * random.normal(1, 0.05);
  body.thigh = 0.245 * legs;
  body.shank = 0.246 * legs;
  body.ankle_height = 0.039 * body.stature;
  body.heel_back = 0.035 * body.stature;
  body.ball_forward = 0.075 * body.stature;
  body.toe_length = 0.042 * body.stature;
  body.hip_half_width = 0.052 * breadth;
  body.hip_drop = 0.012 * trunk;
  body.spine_rise = 0.065 * trunk;
  body.chest_rise = 0.115 * trunk;
  body.neck_rise = 0.125 * trunk;
  body.head_rise = 0.05 * body.stature;
  body.head_length = 0.105 * body.stature;
  body.clavicle_out = 0.02 * breadth;
  body.clavicle_rise = 0.09 * trunk;
  body.shoulder_out = 0.105 * breadth;
  body.upper_arm = 0.186 * arms;
  body.forearm = 0.146 * arms;
  body.hand = 0.108 * arms;
  return body;
}

Eigen::Vector3d Body::hip_offset(Side side) const {
  return {sign_of(side) * hip_half_width, -hip_drop, 0};
}

Eigen::Vector3d Body::clavicle_offset(Side side) const {
  return {sign_of(side) * clavicle_out, clavicle_rise, 0.01 * stature};
}

Eigen::Vector3d Body::shoulder_offset(Side side) const {
  return {sign_of(side) * shoulder_out, 0.006 * stature, -0.012 * stature};
}

Style Style::draw(Random& random) {
  Style style{};
  style.tempo = random.normal(1, 0.06);
  style.amplitude = random.normal(1, 0.08);
  style.lean_deg = random.normal(2, 2);
  style.head_nod_deg = random.normal(4, 4);
  style.arm_out_deg = random.normal(8, 1.5);
  style.elbow_deg = random.normal(16, 5);
  style.arm_swing = random.normal(1, 0.25);
  style.toe_out_deg = random.normal(7, 3);
  style.stance_width = random.normal(1.35, 0.2);
  return style;
}

Skeleton make_skeleton(const Body& body) {
  Skeleton skeleton;
  skeleton.joints.reserve(kJointCount);
  add_joint(skeleton, "Hips", -1, {0, body.straight_hips_height(), 0});
  skeleton.joints[kHips].channels.insert(
      skeleton.joints[kHips].channels.begin(),
      {Channel::x_position, Channel::y_position, Channel::z_position});
  add_joint(skeleton, "Spine", kHips, {0, body.spine_rise, -0.008 * body.stature});
  add_joint(skeleton, "Chest", kSpine, {0, body.chest_rise, 0});
  add_joint(skeleton, "Neck", kChest, {0, body.neck_rise, 0});
  add_joint(skeleton, "Head", kNeck, {0, body.head_rise, 0.01 * body.stature},
            {{0, body.head_length, 0}});
  for (const Side side : kSides) add_arm(skeleton, body, side);
  for (const Side side : kSides) add_leg(skeleton, body, side);
  return skeleton;
}

}  // namespace mcdbn::synthesis
