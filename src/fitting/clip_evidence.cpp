#include "fitting/clip_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/numbers.hpp"
#include "base/upper_median.hpp"
#include "fitting/camera_angles.hpp"
#include "fitting/prior_deviations.hpp"
#include "fitting/robust_residuals.hpp"
#include "fitting/turned_bones.hpp"
#include "mcdbn/motion/humanoid_rig.hpp"
#include "mcdbn/motion/planted_foot.hpp"
#include "motion/body_size.hpp"
#include "motion/foot_joints.hpp"
#include "motion/mirror.hpp"
#include "motion/rotation_vector.hpp"

namespace mcdbn {
namespace {

/// By orientation, its length: left and right have the same.
std::vector<int> length_groups(const PoseFeatures& features, const std::vector<int>& parents) {
  const std::vector<int>& joints = features.joints();
  const std::vector<int> opposite = opposite_joints(features.skeleton());
  std::vector<int> groups;
  int count = 0;
  for (std::size_t turn = 0; turn < joints.size(); ++turn) {
    int group = -1;
    for (std::size_t other = 0; other < turn && !opposite.empty(); ++other) {
      if (opposite[static_cast<std::size_t>(joints[turn])] == joints[other] &&
          !is_same_or_below(parents, static_cast<int>(turn), static_cast<int>(other)))
        group = groups[other];
    }
    groups.push_back(group < 0 ? count++ : group);
  }
  return groups;
}

/// By length.
std::vector<BoneKind> kinds_of(const std::vector<int>& lengths, const PoseFeatures& features) {
  const SkeletonRoles roles = skeleton_roles(features.skeleton());
  std::vector<BoneKind> kinds;
  for (std::size_t turn = 0; turn < lengths.size(); ++turn) {
    const auto length = static_cast<std::size_t>(lengths[turn]);
    if (kinds.size() <= length) kinds.resize(length + 1, BoneKind::other);
    // What turns about a limb's first or second joint is a bone of it.
    for (std::size_t limb = 0; limb < kPersonsLimbs.size(); ++limb)
      for (const JointRole role : {kPersonsLimbs[limb][0], kPersonsLimbs[limb][1]})
        if (roles.joint(role) == features.joints()[turn])
          kinds[length] = limb == 0 ? BoneKind::leg : BoneKind::arm;
  }
  return kinds;
}

}  // namespace

Camera fitted_camera(const PosteriorPoint& point, Camera assumed) {
  assumed.camera_from_world = rotation_of(point.lean) * assumed.camera_from_world;
  assumed.fx_px *= std::exp(point.log_focal);
  assumed.fy_px *= std::exp(point.log_focal);
  return assumed;
}

ClipEvidence::ClipEvidence(const PoseFeatures& features, const Motion& answer,
                           const MatrixD& travelled, const TrackRays& track, const Camera& camera)
    : skeleton_(answer.skeleton), units_per_m_(file_units_per_metre(answer.skeleton)) {
  std::vector<int> joints;
  for (const std::string& name : track.joint_names) joints.push_back(skeleton_.find(name));
  const TurnedBones bones(features, skeleton_, joints);
  turn_above_ = bones.turn_above();
  clip.parents = bones.parents();
  clip.lengths = length_groups(features, clip.parents);
  clip.length_kinds = kinds_of(clip.lengths, features);
  clip.frame_time_s = 1 / track.fps;
  clip.root.resize(answer.frames(), 3);
  clip.travelled = travelled * camera.camera_from_world.transpose() / units_per_m_;
  clip.up = camera.camera_from_world.col(1);
  const std::vector<int> feet = foot_joints(skeleton_), opposite = opposite_joints(skeleton_);
  std::vector<int> grounds;  // by its first foot
  const auto ground_of = [&](int foot) {
    const int other = opposite.empty() ? foot : opposite[static_cast<std::size_t>(foot)];
    const auto known = std::ranges::find(grounds, std::min(foot, other));
    if (known == grounds.end()) grounds.push_back(std::min(foot, other));
    return static_cast<int>(std::ranges::find(grounds, std::min(foot, other)) - grounds.begin());
  };
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (std::ranges::find(feet, joints[k]) == feet.end()) continue;
    clip.feet.push_back(k);
    feet_.push_back(joints[k]);
    clip.grounds.push_back(ground_of(joints[k]));
  }
  for (int t = 0; t < answer.frames(); ++t) {
    const WorldPose pose = forward_kinematics(skeleton_, answer.channels.row(t));
    const Eigen::Vector3d root = pose.position[static_cast<std::size_t>(bones.root())];
    clip.root.row(t) =
        (camera.camera_from_world * root + camera.translation).transpose() / units_per_m_;
    std::vector<SeenJoint> seen;
    for (auto& levers : bones.levers(pose, camera.camera_from_world)) {
      const auto k = static_cast<Eigen::Index>(seen.size());
      for (Lever& lever : levers) lever.bone /= units_per_m_;
      seen.push_back({std::move(levers), track.rays.row(t).segment<2>(2 * k).transpose(),
                      track.confidence(t, k)});
    }
    clip.seen.push_back(std::move(seen));
  }
  clip.planted = MatrixD::Zero(answer.frames(), std::ssize(feet_));
}

void ClipEvidence::set_unknowns(const PosePrior& prior, const Modalities& modalities,
                                bool body_unknown, const std::optional<UnknownCamera>& camera,
                                const TrackFitSettings& settings) {
  clip.turn_deviation_rad = fitted_turn_deviations_rad(prior, modalities, settings);
  clip.root_m_s2 = fitted_root_acceleration_deviation_m_s2(prior, modalities, settings);
  clip.body_unknown = body_unknown;
  clip.camera = camera;
}

void ClipEvidence::find_planted(const Motion& motion) {
  const MatrixD positions = joint_positions(motion);
  for (Eigen::Index t = 1; t < clip.planted.rows(); ++t) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const int foot : feet_) lowest = std::min(lowest, step_to(positions, foot, t).height);
    for (std::size_t f = 0; f < feet_.size(); ++f) {
      const JointStep step = step_to(positions, feet_[f], t);
      clip.planted(t, static_cast<Eigen::Index>(f)) = kPlantedInAnswer.confidence(
          (step.height - lowest) / units_per_m_, step.moved.norm() / units_per_m_ * motion.fps());
    }
  }
}

std::optional<double> ClipEvidence::standing_height(const PosteriorPoint& point,
                                                    const std::vector<std::size_t>& feet) const {
  constexpr double kStands = 0.5;
  const Eigen::Vector3d up = rotation_of(point.lean) * clip.up;
  std::vector<double> heights;
  for (const std::size_t f : feet)
    for (Eigen::Index t = 0; t < clip.frames(); ++t)
      if (clip.planted(t, static_cast<Eigen::Index>(f)) > kStands)
        heights.push_back(up.dot(place_of(clip, point, t, clip.feet[f])));
  if (heights.empty()) return std::nullopt;
  return upper_median(std::move(heights));
}

Eigen::VectorXd ClipEvidence::ground(const PosteriorPoint& point) const {
  std::vector<std::vector<std::size_t>> feet(static_cast<std::size_t>(point.ground_m.size()));
  for (std::size_t f = 0; f < clip.feet.size(); ++f)
    feet[static_cast<std::size_t>(clip.grounds[f])].push_back(f);
  Eigen::VectorXd ground = point.ground_m;
  for (std::size_t kind = 0; kind < feet.size(); ++kind)
    if (const auto height = standing_height(point, feet[kind]))
      ground[static_cast<Eigen::Index>(kind)] = *height;
  return ground;
}

bool ClipEvidence::is_ankle(std::size_t foot) const {
  const int above = skeleton_.joints[static_cast<std::size_t>(feet_[foot])].parent;
  return std::ranges::find(feet_, above) == feet_.end();
}

std::optional<double> ClipEvidence::first_height(const PosteriorPoint& point) const {
  constexpr double kAnkle_m = 0.039 * 1.7;
  std::vector<std::size_t> ankles;
  for (std::size_t f = 0; f < clip.feet.size(); ++f)
    if (is_ankle(f)) ankles.push_back(f);
  const std::optional<double> ankle_m = standing_height(point, ankles);
  if (!ankle_m) return std::nullopt;
  const Eigen::Vector3d up = rotation_of(point.lean) * clip.up;
  const double root_m = up.dot((clip.root.row(0) + point.shift.row(0)).transpose());
  return units_per_m_ * (body(point).scale * (root_m - *ankle_m) + kAnkle_m);
}

ExpectedLean ClipEvidence::balanced(const Stance& stance, const TrackFitSettings& settings) const {
  const Eigen::Vector3d up = stance.upright.normalized();
  const double speed = usual_speed_m_s() / settings.balance_speed_m_s,
               bent = stance.bent_legs / settings.balance_bent_legs;
  const double deviation_rad =
      settings.balance_deviation_deg * kRadiansPerDegree * (1 + speed * speed) * (1 + bent * bent);
  return {pitch_rad(up) - pitch_rad(clip.up), roll_from_to_rad(clip.up, up), deviation_rad,
          deviation_rad};
}

MatrixD ClipEvidence::turned(MatrixD features, const PosteriorPoint& point) const {
  for (Eigen::Index t = 0; t < features.rows(); ++t) {
    for (Eigen::Index k = 0; k < point.turns.cols() / 3; ++k) {
      const Eigen::Matrix3d rotation =
          rotation_of(point.turns.row(t).segment<3>(3 * k).transpose());
      auto block = features.row(t).segment<PoseFeatures::kBlock>(PoseFeatures::kBlock * k);
      block.head<3>() *= rotation.transpose();
      block.tail<3>() *= rotation.transpose();
    }
  }
  return features;
}

MatrixD ClipEvidence::root(const PosteriorPoint& point, double scale, const Camera& camera) const {
  // x_camera = R·x_world + t, row by row.
  return (((clip.root + point.shift) * (scale * units_per_m_)).rowwise() -
          camera.translation.transpose()) *
         camera.camera_from_world;
}

FittedBody ClipEvidence::body(const PosteriorPoint& point) const {
  Skeleton body = skeleton_;
  for (std::size_t joint = 0; joint < body.joints.size(); ++joint) {
    const int turn = turn_above_[joint];
    if (turn >= 0)
      body.joints[joint].offset *=
          std::exp(point.log_lengths[clip.lengths[static_cast<std::size_t>(turn)]]);
  }
  const double scale = units_per_m_ / file_units_per_metre(body);
  for (Joint& joint : body.joints) joint.offset *= scale;
  return {std::move(body), scale};
}

double ClipEvidence::usual_residual(const PosteriorPoint& point, Eigen::Index frames) const {
  std::vector<double> residuals;
  const double magnified = std::exp(point.log_focal);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const auto& seen = clip.seen[static_cast<std::size_t>(t)];
    for (std::size_t joint = 0; joint < seen.size(); ++joint) {
      if (!(seen[joint].confidence > 0)) continue;
      const Eigen::Vector3d x = place_of(clip, point, t, joint);
      if (!(x.z() > 0)) continue;
      const Eigen::Vector2d residual =
          std::sqrt(seen[joint].confidence) * (magnified * x.head<2>() / x.z() - seen[joint].ray);
      residuals.push_back(residual.x());
      residuals.push_back(residual.y());
    }
  }
  return robust_deviation(std::move(residuals));
}

double ClipEvidence::usual_speed_m_s() const {
  if (clip.frames() < 2) return 0;
  const auto a_second =
      std::clamp<Eigen::Index>(std::lround(1 / clip.frame_time_s), 1, clip.frames() - 1);
  const Eigen::Index begins = clip.frames() - a_second;
  return (clip.root.bottomRows(begins) - clip.root.topRows(begins)).rowwise().norm().mean() /
         (static_cast<double>(a_second) * clip.frame_time_s);
}

double ClipEvidence::usual_depth_m() const {
  const Eigen::VectorXd depths = clip.root.col(2);
  return depths.size() == 0 ? 0 : upper_median({depths.begin(), depths.end()});
}

}  // namespace mcdbn
