#include "synthesis/synthesize_rig.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"

namespace mcdbn::synthesis {
namespace {

/// Legs are never straighter than this fraction of their length: a knee that locks would snap.
constexpr double kLongestReach = 0.998;

using Rotations = std::array<Eigen::Matrix3d, kJointCount>;  ///< parent_from_joint

/// Angle between the sides `a` and `b` of a triangle whose third side is `c`, degrees.
double triangle_angle_deg(double a, double b, double c) {
  return std::acos(std::clamp((a * a + b * b - c * c) / (2 * a * b), -1.0, 1.0)) /
         kRadiansPerDegree;
}

Eigen::Matrix3d world_from_pelvis(const Frame& frame) {
  return rotation_y(frame.heading_deg + frame.posture[kPelvisTurn]) *
         rotation_x(frame.posture[kPelvisTilt]) * rotation_z(frame.posture[kPelvisLean]);
}

Eigen::Matrix3d world_from_foot(const Foot& foot) {
  return rotation_y(foot.turn_deg) * rotation_x(-foot.pitch_deg);
}

Eigen::Vector3d hip_position(const Body& body, const Frame& frame, Side side) {
  return frame.hips + world_from_pelvis(frame) * body.hip_offset(side);
}

/// A frame whose columns are x ⟂ both, y = −`down`, z as near to `forward` as can be.
Eigen::Matrix3d frame_along(const Eigen::Vector3d& down, const Eigen::Vector3d& forward) {
  Eigen::Matrix3d result;
  result.col(1) = -down.normalized();
  result.col(0) = result.col(1).cross(forward).normalized();
  result.col(2) = result.col(0).cross(result.col(1));
  return result;
}

void solve_leg(const Body& body, const Frame& frame, Side side, Rotations& rotations) {
  const Foot& foot = frame.feet[side];
  const Eigen::Matrix3d pelvis = world_from_pelvis(frame);
  const Eigen::Vector3d reach = foot.ankle - hip_position(body, frame, side);
  const double length = std::min(reach.norm(), kLongestReach * body.leg());
  const double knee_deg = 180 - triangle_angle_deg(body.thigh, body.shank, length);
  const double thigh_lead_deg = triangle_angle_deg(body.thigh, length, body.shank);
  // The knee points between where the pelvis and where the foot points.
  const double pelvis_turn_deg = frame.heading_deg + frame.posture[kPelvisTurn];
  const double knee_turn_deg = 0.5 * (pelvis_turn_deg + foot.turn_deg);
  const Eigen::Vector3d forward = rotation_y(knee_turn_deg) * Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d thigh = frame_along(reach, forward) * rotation_x(-thigh_lead_deg);
  const Eigen::Matrix3d shank = thigh * rotation_x(knee_deg);
  const int first = leg_block(side);
  rotations[first] = pelvis.transpose() * thigh;
  rotations[first + 1] = rotation_x(knee_deg);
  rotations[first + 2] = shank.transpose() * world_from_foot(foot);
  rotations[first + 3] = rotation_x(-foot.toe_bend_deg);
}

void set_arm(const Frame& frame, Side side, Rotations& rotations) {
  const ArmPose arm = frame.arms[side].value_or(arm_pose(frame.posture, side));
  const double sign = sign_of(side);
  const int first = arm_block(side);
  rotations[first] = rotation_z(sign * frame.posture[arm_dof(side, kShrug)]);
  rotations[first + 1] = arm.upper;
  rotations[first + 2] = rotation_y(-sign * arm.elbow_deg);
  rotations[first + 3] = arm.hand;
}

Rotations local_rotations(const Body& body, const Frame& frame) {
  const Posture& posture = frame.posture;
  Rotations rotations;
  rotations[kHips] = world_from_pelvis(frame);
  rotations[kSpine] = rotations[kChest] = rotation_y(posture[kTrunkTwist] / 2) *
                                          rotation_x(posture[kTrunkFlex] / 2) *
                                          rotation_z(posture[kTrunkBend] / 2);
  rotations[kNeck] = rotations[kHead] = rotation_y(posture[kHeadTurn] / 2) *
                                        rotation_x(posture[kHeadNod] / 2) *
                                        rotation_z(posture[kHeadTilt] / 2);
  for (const Side side : kSides) {
    set_arm(frame, side, rotations);
    solve_leg(body, frame, side, rotations);
  }
  return rotations;
}

/// How far the hips have to come down for the planted feet to be in reach.
double excess_height(const Body& body, const Frame& frame) {
  double excess = 0;
  for (const Side side : kSides) {
    if (!frame.feet[side].planted) continue;
    const Eigen::Vector3d down = hip_position(body, frame, side) - frame.feet[side].ankle;
    const double reach = kLongestReach * body.leg();
    const double across = std::hypot(down.x(), down.z());
    excess = std::max(excess, down.y() - std::sqrt(std::max(0.0, reach * reach - across * across)));
  }
  return excess;
}

/// Running maximum, then running mean over the same window: smooth and never below `values`.
std::vector<double> smooth_upper_envelope(const std::vector<double>& values, int radius) {
  const int count = static_cast<int>(values.size());
  const auto over_window = [&](const std::vector<double>& from, auto reduce) {
    std::vector<double> result(from.size());
    for (int i = 0; i < count; ++i) {
      const auto first = from.begin() + std::max(0, i - radius);
      const auto last = from.begin() + std::min(count, i + radius + 1);
      result[i] = reduce(first, last);
    }
    return result;
  };
  const auto maximum =
      over_window(values, [](auto first, auto last) { return *std::max_element(first, last); });
  return over_window(maximum, [](auto first, auto last) {
    double sum = 0;
    for (auto it = first; it != last; ++it) sum += *it;
    return sum / static_cast<double>(last - first);
  });
}

void lower_hips_into_reach(const Body& body, std::vector<Frame>& frames, double fps) {
  std::vector<double> excess(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) excess[i] = excess_height(body, frames[i]);
  constexpr double kWindow_s = 0.07;
  const auto lowering =
      smooth_upper_envelope(excess, static_cast<int>(std::lround(kWindow_s * fps)));
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].hips.y() -= lowering[i];
}

}  // namespace

Posture standing_posture(const Style& style) {
  Posture posture = Posture::Zero();
  posture[kPelvisTilt] = 0.5 * style.lean_deg;
  posture[kTrunkFlex] = 0.5 * style.lean_deg;
  posture[kHeadNod] = style.head_nod_deg;
  for (const Side side : kSides) {
    posture[arm_dof(side, kAbduction)] = style.arm_out_deg;
    posture[arm_dof(side, kElbow)] = style.elbow_deg;
    posture[arm_dof(side, kTwist)] = 15;  // hands hang somewhat before the thighs
  }
  return posture;
}

Foot planted_foot(const Body& body, const FootPrint& print, double pitch_deg) {
  Foot foot{print.ankle, print.turn_deg, pitch_deg, std::max(0.0, -pitch_deg), true};
  const Eigen::Vector3d pivot = pitch_deg > 0 ? body.heel_offset() : body.ball_offset();
  const Eigen::Matrix3d flat = rotation_y(print.turn_deg);
  foot.ankle = print.ankle + flat * pivot - world_from_foot(foot) * pivot;
  return foot;
}

ArmPose arm_pose(const Posture& posture, Side side) {
  const double sign = sign_of(side);
  const double hang_deg = posture[arm_dof(side, kAbduction)] - 90;
  return {rotation_x(-posture[arm_dof(side, kFlexion)]) * rotation_z(sign * hang_deg) *
              rotation_x(posture[arm_dof(side, kTwist)]),
          posture[arm_dof(side, kElbow)], rotation_z(-sign * posture[arm_dof(side, kWrist)])};
}

ArmPose reaching_arm(const Body& body, Side side, const Eigen::Vector3d& wrist,
                     const Eigen::Vector3d& elbow_direction,
                     const Eigen::Vector3d& hand_direction) {
  const double sign = sign_of(side);
  const Eigen::Vector3d reach = wrist - body.clavicle_offset(side) - body.shoulder_offset(side);
  const double length = std::min(reach.norm(), 0.999 * (body.upper_arm + body.forearm));
  const double elbow_deg = 180 - triangle_angle_deg(body.upper_arm, body.forearm, length);
  const double lead_deg = triangle_angle_deg(body.upper_arm, length, body.forearm);
  // The straight arm lies along ±x and its elbow bends towards +z, so it points towards −z.
  Eigen::Matrix3d along;
  along.col(0) = sign * reach.normalized();
  along.col(1) = -elbow_direction.cross(along.col(0)).normalized();
  along.col(2) = along.col(0).cross(along.col(1));
  const Eigen::Matrix3d upper = along * rotation_y(sign * lead_deg);
  const Eigen::Matrix3d chest_from_forearm = upper * rotation_y(-sign * elbow_deg);
  const Eigen::Quaterniond bend = Eigen::Quaterniond::FromTwoVectors(
      sign * Eigen::Vector3d::UnitX(), chest_from_forearm.transpose() * hand_direction);
  return {upper, elbow_deg, bend.toRotationMatrix()};
}

ArmPose blend(const ArmPose& from, const ArmPose& to, double weight) {
  const auto slerp = [&](const Eigen::Matrix3d& start, const Eigen::Matrix3d& end) {
    return Eigen::Quaterniond(start).slerp(weight, Eigen::Quaterniond(end)).toRotationMatrix();
  };
  return {slerp(from.upper, to.upper), std::lerp(from.elbow_deg, to.elbow_deg, weight),
          slerp(from.hand, to.hand)};
}

std::array<FootPrint, 2> standing_prints(const Body& body, const Style& style) {
  std::array<FootPrint, 2> prints;
  for (const Side side : kSides) {
    const double out = style.stance_width * body.hip_half_width;
    // The ankle stands a little behind the hips, so that the weight is over the foot.
    prints[side] = {{sign_of(side) * out, body.ankle_height, -0.02 * body.stature},
                    sign_of(side) * style.toe_out_deg};
  }
  return prints;
}

Motion assemble(const Body& body, std::vector<Frame> frames, double fps) {
  lower_hips_into_reach(body, frames, fps);
  Motion motion{make_skeleton(body), 1 / fps, {}};
  const Skeleton& skeleton = motion.skeleton;
  motion.channels.setZero(static_cast<Eigen::Index>(frames.size()), skeleton.channel_count());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Rotations rotations = local_rotations(body, frames[f]);
    const auto row = static_cast<Eigen::Index>(f);
    motion.channels.row(row).head<3>() = frames[f].hips.transpose();
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      const int column = skeleton.first_channel(j);
      const double* previous = f > 0 ? &motion.channels(row - 1, column) : nullptr;
      set_local_rotation(skeleton.joints[j], rotations[j], previous, &motion.channels(row, column));
    }
  }
  return motion;
}

}  // namespace mcdbn::synthesis
