#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/numbers.hpp"

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {
namespace {

/// Below this cosine of the middle angle only the sum or difference of the outer two is known.
constexpr double kGimbalCosine = 1e-6;

/// The rotation channels of a joint: their axes, and their channel_indices among all its channels.
struct RotationChannels {
  std::vector<int> axes;
  std::vector<std::size_t> channel_indices;
};

RotationChannels rotation_channels(const Joint& joint) {
  RotationChannels found;
  for (std::size_t i = 0; i < joint.channels.size(); ++i) {
    if (!is_rotation(joint.channels[i])) continue;
    found.axes.push_back(axis_of(joint.channels[i]));
    found.channel_indices.push_back(i);
  }
  return found;
}

/// Multiplies `rotation` from the right by a turn about an axis, which leaves that axis' column.
void turn_about(Eigen::Matrix3d& rotation, int axis, double angle_rad) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double cosine = std::cos(angle_rad), sine = std::sin(angle_rad);
  const Eigen::Vector3d before = rotation.col(u);
  rotation.col(u) = cosine * before + sine * rotation.col(v);
  rotation.col(v) = cosine * rotation.col(v) - sine * before;
}

/// `angle` plus the whole turns that bring it nearest to `reference`.
double nearest_turn(double angle_rad, double reference_rad) {
  const double change = angle_rad - reference_rad;
  if (std::abs(change) <= std::numbers::pi) return angle_rad;  // a remainder takes long
  return reference_rad + std::remainder(change, 2 * std::numbers::pi);
}

using Triple = std::array<double, 3>;

double squared_distance(const Triple& a, const Triple& b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

/// Angles of R = R_i(a)·R_j(b)·R_k(c) for three distinct axes; without `previous` the branch with
/// |b| <= 90° is taken, in -180° to 180°.
Triple distinct_axes_angles(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes,
                            const Triple* previous) {
  const int i = axes[0], j = axes[1], k = axes[2];
  const double parity = (i + 1) % 3 == j ? 1.0 : -1.0;
  const double cosine = std::hypot(rotation(i, i), rotation(i, j));
  const double b = std::atan2(parity * rotation(i, k), cosine);

  if (cosine < kGimbalCosine) {
    // Here R depends on a + sign·c alone: the remaining freedom keeps both near what they were.
    const double sign = b > 0 ? parity : -parity;
    const double total = std::atan2(parity * rotation(k, j), rotation(j, j));
    if (!previous) return {total, b, 0.0};
    const double previous_total = (*previous)[0] + sign * (*previous)[2];
    const double half_change = (nearest_turn(total, previous_total) - previous_total) / 2;
    return {(*previous)[0] + half_change, nearest_turn(b, (*previous)[1]),
            (*previous)[2] + sign * half_change};
  }

  Triple first{std::atan2(-parity * rotation(j, k), rotation(k, k)), b,
               std::atan2(-parity * rotation(i, j), rotation(i, i))};
  if (!previous) return first;
  Triple second{first[0] + std::numbers::pi, std::numbers::pi - b, first[2] + std::numbers::pi};
  for (int n = 0; n < 3; ++n) {
    first[n] = nearest_turn(first[n], (*previous)[n]);
    second[n] = nearest_turn(second[n], (*previous)[n]);
  }
  return squared_distance(first, *previous) <= squared_distance(second, *previous) ? first : second;
}

Eigen::Matrix3d product(const std::vector<int>& axes, const std::vector<double>& angles_rad,
                        std::size_t begin, std::size_t end) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  for (std::size_t n = begin; n < end; ++n) turn_about(result, axes[n], angles_rad[n]);
  return result;
}

/// The angle about `axis` that comes nearest to `rotation` (largest trace of RᵀR_axis).
double nearest_axis_angle(const Eigen::Matrix3d& rotation, int axis, double otherwise_rad) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double cosine = rotation(u, u) + rotation(v, v), sine = rotation(v, u) - rotation(u, v);
  return std::hypot(cosine, sine) < kGimbalCosine ? otherwise_rad : std::atan2(sine, cosine);
}

/// Improves the angles one axis at a time; each step is exact, so the fit never gets worse.
void coordinate_ascent(const Eigen::Matrix3d& rotation, const std::vector<int>& axes,
                       std::vector<double>& angles_rad) {
  constexpr int kSweeps = 200;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0;
    for (std::size_t n = 0; n < axes.size(); ++n) {
      const Eigen::Matrix3d rest = product(axes, angles_rad, 0, n).transpose() * rotation *
                                   product(axes, angles_rad, n + 1, axes.size()).transpose();
      const double angle = nearest_axis_angle(rest, axes[n], angles_rad[n]);
      change =
          std::max(change, std::abs(std::remainder(angle - angles_rad[n], 2 * std::numbers::pi)));
      angles_rad[n] = angle;
    }
    if (change < 1e-12) return;
  }
}

/// The angles of any list of axes that come nearest to `rotation`; begins at `previous` and at
/// quarter turns of the last axis, as with two axes a single start may end in a lesser maximum.
std::vector<double> nearest_angles(const Eigen::Matrix3d& rotation, const std::vector<int>& axes,
                                   const std::vector<double>& previous_rad) {
  std::vector<double> best;
  double best_fit = -std::numeric_limits<double>::infinity();
  for (int quarter = 0; quarter < 4; ++quarter) {
    std::vector<double> angles = previous_rad;
    angles.back() += quarter * std::numbers::pi / 2;
    coordinate_ascent(rotation, axes, angles);
    const double fit = (rotation.transpose() * product(axes, angles, 0, axes.size())).trace();
    if (fit > best_fit + 1e-9) {
      best_fit = fit;
      best = angles;
    }
  }
  for (std::size_t n = 0; n < best.size(); ++n) best[n] = nearest_turn(best[n], previous_rad[n]);
  return best;
}

/// Where a joint that turns about three distinct axes has their channels; most joints do.
std::optional<std::array<std::size_t, 3>> three_distinct(const Joint& joint) {
  std::array<std::size_t, 3> at{};
  std::array<bool, 3> has{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < joint.channels.size(); ++i) {
    if (!is_rotation(joint.channels[i])) continue;
    const auto axis = static_cast<std::size_t>(axis_of(joint.channels[i]));
    if (count == at.size() || has[axis]) return {};
    has[axis] = true;
    at[count++] = i;
  }
  if (count < at.size()) return {};
  return at;
}

void set_distinct_axes(const Joint& joint, const std::array<std::size_t, 3>& at,
                       const Eigen::Matrix3d& parent_from_joint, const double* previous,
                       double* joint_channels) {
  std::array<int, 3> axes{};
  Triple before{};
  for (std::size_t n = 0; n < at.size(); ++n) {
    axes[n] = axis_of(joint.channels[at[n]]);
    if (previous) before[n] = previous[at[n]] * kRadiansPerDegree;
  }
  const Triple angles_rad =
      distinct_axes_angles(parent_from_joint, axes, previous ? &before : nullptr);
  for (std::size_t n = 0; n < at.size(); ++n)
    joint_channels[at[n]] = angles_rad[n] / kRadiansPerDegree;
}

}  // namespace

Eigen::Matrix3d local_rotation(const Joint& joint, const double* joint_channels) {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (std::size_t i = 0; i < joint.channels.size(); ++i) {
    const Channel channel = joint.channels[i];
    if (is_rotation(channel))
      turn_about(rotation, axis_of(channel), joint_channels[i] * kRadiansPerDegree);
  }
  return rotation;
}

void set_local_rotation(const Joint& joint, const Eigen::Matrix3d& parent_from_joint,
                        const double* previous, double* joint_channels) {
  if (const auto at = three_distinct(joint))
    return set_distinct_axes(joint, *at, parent_from_joint, previous, joint_channels);
  const RotationChannels rotations = rotation_channels(joint);
  if (rotations.axes.empty()) return;
  std::vector<double> angles_rad(rotations.axes.size(), 0.0);
  for (std::size_t n = 0; previous && n < angles_rad.size(); ++n) {
    angles_rad[n] = previous[rotations.channel_indices[n]] * kRadiansPerDegree;
  }
  angles_rad = nearest_angles(parent_from_joint, rotations.axes, angles_rad);
  for (std::size_t n = 0; n < angles_rad.size(); ++n) {
    joint_channels[rotations.channel_indices[n]] = angles_rad[n] / kRadiansPerDegree;
  }
}

}  // namespace mcdbn
