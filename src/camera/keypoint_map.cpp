#include "camera/keypoint_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "base/numbers.hpp"
#include "base/shown.hpp"
#include "camera/keypoint_places.hpp"
#include "camera/track_columns.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

using enum JointRole;

constexpr std::size_t kFewestJoints = 3;
/// Joints that lie between two others, by the left one of them.
constexpr std::array kBetween{std::pair{pelvis, left_hip}, std::pair{neck, left_shoulder}};
/// The deviation of a detector from its place, in body heights.
constexpr double kHit = 0.01;
/// The error of the orientations of an answer's joints: it moves a place by its distance times
/// this.
constexpr double kTurn_rad = 0.3;

/// The weight of a place whose offset from its joint is uncertain by so much, in body heights,
/// relative to that of the joint itself.
double weight_of_uncertainty(double uncertain) {
  return kHit * kHit / (kHit * kHit + uncertain * uncertain);
}

/// The column whose keypoint is the joint itself, or -1.
int column_of(const std::vector<Keypoint>& keypoints, JointRole role) {
  const auto found = std::ranges::find_if(keypoints, [&](const Keypoint& keypoint) {
    return keypoint.role == role && !keypoint.halfway && keypoint.offset.norm() < 0.02;
  });
  return found == keypoints.end() ? -1 : static_cast<int>(found - keypoints.begin());
}

bool seen(const Track2d& track, Eigen::Index frame, int column) {
  return track.confidence(frame, column) > 0 && std::isfinite(track.x_px(frame, column)) &&
         std::isfinite(track.y_px(frame, column));
}

/// The middle of two columns; NaN unless both are seen.
Eigen::Vector2d middle(const Track2d& track, Eigen::Index frame, int left, int right) {
  if (left < 0 || right < 0 || !seen(track, frame, left) || !seen(track, frame, right))
    return {kNan, kNan};
  return 0.5 * (pixel_at(track, frame, left) + pixel_at(track, frame, right));
}

/// What to do where most columns have names that are not known; none otherwise.
std::string advice_on_names(const std::vector<Keypoint>& keypoints) {
  constexpr std::size_t kMost = 5;
  std::vector<std::string> unknown;
  for (const Keypoint& keypoint : keypoints)
    if (!keypoint.role) unknown.push_back(shown(keypoint.name));
  if (2 * unknown.size() <= keypoints.size()) return {};
  const bool more = unknown.size() > kMost;
  unknown.resize(std::min(kMost, unknown.size()));
  return fmt::format(
      "; its columns {}{} are no known joints: call them as the model's, or as in left_hip, LHip, "
      "hip.L",
      fmt::join(unknown, ", "), more ? ", …" : "");
}

void hide_column(Track2d& track, int column) {
  track.x_px.col(column).setConstant(kNan);
  track.y_px.col(column).setConstant(kNan);
  track.confidence.col(column).setZero();
}

}  // namespace

/// The skeleton at rest, as places on the body are read from it.
struct KeypointMap::RestBody {
  RestBody(const Skeleton& of, const SkeletonRoles& roles, const std::vector<Keypoint>& keypoints)
      : skeleton(of),
        pose(unturned_pose(of)),
        trunk(trunk_axes(pose, roles).value_or(Eigen::Matrix3d::Identity())),
        places(rest_places(of, roles, keypoints)),
        height(body_height(of)) {}

  const Skeleton& skeleton;
  WorldPose pose;
  Eigen::Matrix3d trunk;  ///< left, up, forward
  MatrixD places;         ///< of the keypoints [1 x 3·keypoints]
  double height;
};

KeypointMap::KeypointMap(const std::vector<Keypoint>& keypoints, const Skeleton& skeleton,
                         const SkeletonRoles& roles)
    : keypoints_(keypoints), roles_(roles) {
  const RestBody rest(skeleton, roles, keypoints);
  for (std::size_t k = 0; k < keypoints.size(); ++k)
    if (keypoints[k].role) add_reading(rest, *keypoints[k].role, {static_cast<int>(k)});
  for (const auto& [role, left] : kBetween) {
    const int left_column = column_of(keypoints, left),
              right_column = column_of(keypoints, other_side(left));
    if (!shows(role) && left_column >= 0 && right_column >= 0)
      add_reading(rest, role, {left_column, right_column});
  }
  require_enough_joints();
  measure_trunk(rest);
}

bool KeypointMap::shows(JointRole role) const {
  return std::ranges::find(joints_, roles_.joint(role)) != joints_.end();
}

void KeypointMap::add_reading(const RestBody& rest, JointRole role, std::vector<int> columns) {
  if (!roles_.has(role)) return;
  Eigen::Vector3d place(0, 0, 0);
  for (const int column : columns)
    place +=
        rest.places.row(0).segment<3>(3 * column).transpose() / static_cast<double>(columns.size());
  if (!place.allFinite()) return;
  const int joint = roles_.joint(role);
  const auto known = std::ranges::find(joints_, joint);
  const auto index = static_cast<std::size_t>(known - joints_.begin());
  if (known == joints_.end()) {
    joints_.push_back(joint);
    names_.push_back(rest.skeleton.joints[static_cast<std::size_t>(joint)].name);
  }
  const Eigen::Vector3d offset = place - rest.pose.position[static_cast<std::size_t>(joint)];
  const auto& halfway = keypoints_[static_cast<std::size_t>(columns.front())].halfway;
  const bool is_marked_itself =
      columns.size() == 1 && !(halfway && column_of(keypoints_, halfway->first) >= 0 &&
                               column_of(keypoints_, halfway->second) >= 0);
  readings_.push_back(
      {index, std::move(columns), rest.trunk.transpose() * offset / rest.height, is_marked_itself});
}

void KeypointMap::require_enough_joints() const {
  if (joints_.size() >= kFewestJoints && shows(pelvis)) return;
  throw InputError(fmt::format(
      "the 2D track shows too little of the body: {} of the model's joints{}; at least {} are "
      "needed, the pelvis or both hips among them{}",
      joints_.size(),
      names_.empty() ? std::string() : fmt::format(" ({})", fmt::join(names_, ", ")), kFewestJoints,
      advice_on_names(keypoints_)));
}

void KeypointMap::measure_trunk(const RestBody& rest) {
  const auto position = [&](JointRole role) -> const Eigen::Vector3d& {
    return rest.pose.position[static_cast<std::size_t>(roles_.joint(role))];
  };
  const auto centre = [&](JointRole left) -> Eigen::Vector3d {
    return 0.5 * (position(left) + position(other_side(left)));
  };
  if (!roles_.has(left_hip) || !roles_.has(right_hip)) return;
  hip_width_ = (position(left_hip) - position(right_hip)).norm() / rest.height;
  if (roles_.has(left_shoulder) && roles_.has(right_shoulder))
    trunk_length_ = (centre(left_shoulder) - centre(left_hip)).norm() / rest.height;
}

KeypointMap::Displacements KeypointMap::seen_displacements(const Track2d& track) const {
  Displacements result{
      MatrixD::Zero(track.frames(), 2 * static_cast<Eigen::Index>(readings_.size())), {}};
  for (const Reading& reading : readings_) result.uncertain.push_back(std::abs(reading.offset.z()));
  const int left = column_of(keypoints_, left_hip), right = column_of(keypoints_, right_hip),
            left_top = column_of(keypoints_, left_shoulder),
            right_top = column_of(keypoints_, right_shoulder);
  for (Eigen::Index t = 0; t < track.frames(); ++t) {
    // Pixels of one body height to the left and up, as the body is seen.
    const Eigen::Vector2d hips = middle(track, t, left, right);
    const Eigen::Vector2d up = (middle(track, t, left_top, right_top) - hips) / trunk_length_;
    if (!up.allFinite() || !(hip_width_ > 0)) continue;
    const Eigen::Vector2d leftward =
        (pixel_at(track, t, left) - pixel_at(track, t, right)) / hip_width_;
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      const Eigen::Vector3d& offset = readings_[k].offset;
      result.px.row(t).segment<2>(2 * static_cast<Eigen::Index>(k)) =
          (leftward * offset.x() + up * offset.y()).transpose();
    }
  }
  return result;
}

Track2d KeypointMap::without(const Track2d& track, const Displacements& displacements) const {
  Track2d result = track;
  result.keypoints.clear();
  result.joint_names = names_;
  const auto count = static_cast<Eigen::Index>(names_.size());
  for (MatrixD* values : {&result.x_px, &result.y_px, &result.confidence})
    *values = MatrixD::Zero(track.frames(), count);
  MatrixD weights = MatrixD::Zero(track.frames(), count);
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    const Reading& reading = readings_[k];
    const auto joint = static_cast<Eigen::Index>(reading.joint);
    for (Eigen::Index t = 0; t < track.frames(); ++t) {
      const Eigen::Vector2d place =
          middle(track, t, reading.columns.front(), reading.columns.back());
      const Eigen::Vector2d shift =
          displacements.px.row(t).segment<2>(2 * static_cast<Eigen::Index>(k)).transpose();
      if (!place.allFinite() || !shift.allFinite()) continue;
      const double confidence = std::min(track.confidence(t, reading.columns.front()),
                                         track.confidence(t, reading.columns.back()));
      const double weight = confidence * weight_of_uncertainty(displacements.uncertain[k]);
      weights(t, joint) += weight;
      result.x_px(t, joint) += weight * (place - shift).x();
      result.y_px(t, joint) += weight * (place - shift).y();
      result.confidence(t, joint) += weight * confidence;
    }
  }
  const auto observed = weights.array() > 0;
  result.x_px = observed.select(result.x_px.array() / weights.array(), kNan);
  result.y_px = observed.select(result.y_px.array() / weights.array(), kNan);
  result.confidence = observed.select(result.confidence.array() / weights.array(), 0.0);
  return result;
}

Track2d KeypointMap::joints_of(const Track2d& track) const {
  return without(track, seen_displacements(track));
}

Track2d KeypointMap::joints_of(const Track2d& track, const Motion& answer,
                               const Camera& camera) const {
  if (answer.frames() != track.frames())
    throw ShapeError(fmt::format("KeypointMap::joints_of: an answer of {} frames to a track of {}",
                                 answer.frames(), track.frames()));
  const MatrixD places = project_points(camera, keypoint_places(answer, roles_, keypoints_));
  const MatrixD joints = project_points(camera, joint_positions(answer));
  Displacements displacements{
      MatrixD(track.frames(), 2 * static_cast<Eigen::Index>(readings_.size())), {}};
  for (std::size_t k = 0; k < readings_.size(); ++k) {
    const Reading& reading = readings_[k];
    const int one = reading.columns.front(), other = reading.columns.back();
    displacements.px.middleCols<2>(2 * static_cast<Eigen::Index>(k)) =
        0.5 * (places.middleCols<2>(2 * one) + places.middleCols<2>(2 * other)) -
        joints.middleCols<2>(2 * joints_[reading.joint]);
    displacements.uncertain.push_back(kTurn_rad * reading.offset.norm());
  }
  return without(track, displacements);
}

Track2d KeypointMap::evidence(Track2d joints) const {
  for (std::size_t joint = 0; joint < names_.size(); ++joint) {
    double trust = 0;
    for (const Reading& reading : readings_)
      if (reading.joint == joint && reading.is_marked_itself)
        trust = std::max(trust, weight_of_uncertainty(kTurn_rad * reading.offset.norm()));
    if (trust > 0)
      joints.confidence.col(static_cast<Eigen::Index>(joint)) *= trust;
    else
      hide_column(joints, static_cast<int>(joint));
  }
  return joints;
}

}  // namespace mcdbn
