#include "mcdbn/features/pose_features.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "motion/body_size.hpp"
#include "motion/joint_matching.hpp"

namespace mcdbn {

namespace {

/// What rounding in a file's text may do to a joint that does not turn, in radians.
constexpr double kSmallestTurn = 1e-6;

/// Whether the joint's rotation in any frame of the clip is away from `reference`.
bool turns(const Motion& clip, int joint, const Eigen::Matrix3d& reference) {
  const Joint& definition = clip.skeleton.joints[joint];
  const int first = clip.skeleton.first_channel(joint);
  for (int frame = 0; frame < clip.frames(); ++frame) {
    const Eigen::Matrix3d rotation =
        local_rotation(definition, clip.channels.row(frame).data() + first);
    // |R - R0| is sqrt(2) times a small angle between them.
    if ((rotation - reference).norm() > std::sqrt(2.0) * kSmallestTurn) return true;
  }
  return false;
}

/// How far the position channel is from the joint's OFFSET, averaged over all frames.
/// @param joint by clip, the index of the joint
double mean_displacement(const std::vector<const Motion*>& clips, const std::vector<int>& joint,
                         Channel channel) {
  double sum = 0;
  int frames = 0;
  for (std::size_t c = 0; c < clips.size(); ++c) {
    const Joint& definition = clips[c]->skeleton.joints[joint[c]];
    const int position = find_channel(definition, channel);
    if (position < 0) continue;
    const int column = clips[c]->skeleton.first_channel(joint[c]) + position;
    sum += (clips[c]->channels.col(column).array() - definition.offset[axis_of(channel)]).sum();
    frames += clips[c]->frames();
  }
  return frames > 0 ? sum / frames : 0;
}

}  // namespace

PoseFeatures PoseFeatures::fit(const std::vector<const Motion*>& clips) {
  if (clips.empty() || clips.front()->frames() == 0) {
    throw InputError("no motion to learn from; give at least one clip with frames");
  }
  PoseFeatures result;
  result.skeleton_ = clips.front()->skeleton;
  result.root_ = moving_root(clips);
  const Skeleton& skeleton = result.skeleton_;
  result.constant_channels_ = clips.front()->channels.row(0);
  std::vector<std::vector<int>> matches;
  for (std::size_t c = 0; c < clips.size(); ++c) {
    matches.push_back(
        match_joints(skeleton, clips[c]->skeleton, fmt::format("training clip {}", c + 1)));
  }
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    std::vector<int> joint(clips.size());
    for (std::size_t c = 0; c < clips.size(); ++c) joint[c] = matches[c][j];
    const Joint& definition = skeleton.joints[j];
    double* constants = result.constant_channels_.data() + skeleton.first_channel(j);
    const Eigen::Matrix3d reference = local_rotation(definition, constants);
    bool moves = j == result.root_;
    for (std::size_t c = 0; c < clips.size() && !moves; ++c) {
      moves = turns(*clips[c], joint[c], reference);
    }
    if (moves) result.joints_.push_back(j);
    for (std::size_t k = 0; k < definition.channels.size(); ++k) {
      const Channel channel = definition.channels[k];
      if (is_rotation(channel)) continue;
      constants[k] = definition.offset[axis_of(channel)] + mean_displacement(clips, joint, channel);
    }
  }
  return restored(std::move(result.skeleton_), result.root_, std::move(result.joints_),
                  result.constant_channels_);
}

int PoseFeatures::dimension() const {
  return kBlock * static_cast<int>(joints_.size()) + kRootFeatures;
}

std::vector<std::string> PoseFeatures::feature_names() const {
  std::vector<std::string> names;
  for (const int joint : joints_) {
    for (const char* axis :
         {"x_axis_x", "x_axis_y", "x_axis_z", "y_axis_x", "y_axis_y", "y_axis_z"}) {
      names.push_back(fmt::format("{}_{}", skeleton_.joints[joint].name, axis));
    }
  }
  for (const char* name :
       {"root_height_m", "root_velocity_x_m_s", "root_velocity_y_m_s", "root_velocity_z_m_s"}) {
    names.emplace_back(name);
  }
  return names;
}

MatrixD PoseFeatures::encode(const Motion& clip, const Eigen::Matrix3d& camera_from_world) const {
  const std::vector<int> match = match_joints(skeleton_, clip.skeleton, "the clip");
  const double metres = 1.0 / file_units_per_metre(clip.skeleton);
  MatrixD features(clip.frames(), dimension());
  const int height = dimension() - kRootFeatures;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int frame = 0; frame < clip.frames(); ++frame) {
    const WorldPose pose = forward_kinematics(clip.skeleton, clip.channels.row(frame));
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const Eigen::Matrix3d camera_from_joint =
          camera_from_world * pose.world_from_joint[match[joints_[k]]];
      features.row(frame).segment<kBlock>(kBlock * static_cast<int>(k)) =
          Eigen::Map<const Eigen::Matrix<double, 1, kBlock>>(camera_from_joint.data());
    }
    const Eigen::Vector3d root = pose.position[match[root_]] * metres;
    features(frame, height) = root.y();
    if (frame > 0) {
      features.row(frame).tail<3>() =
          (camera_from_world * (root - before) * clip.fps()).transpose();
    }
    before = root;
  }
  if (clip.frames() == 1) features.row(0).tail<3>().setZero();
  if (clip.frames() > 1) features.row(0).tail<3>() = features.row(1).tail<3>();
  return features;
}

MatrixD PoseFeatures::root_features(const MatrixD& features) const {
  if (features.cols() != dimension()) {
    throw ShapeError(fmt::format("PoseFeatures::root_features: {} columns, expected {}",
                                 features.cols(), dimension()));
  }
  return features.rightCols(kRootFeatures);
}

MatrixD PoseFeatures::turned(const MatrixD& features,
                             const Eigen::Matrix3d& other_from_camera) const {
  MatrixD result = features;
  result.rightCols(kRootFeatures) = root_features(features);
  const auto turn = [&](int first) {
    result.middleCols<3>(first) = features.middleCols<3>(first) * other_from_camera.transpose();
  };
  for (int first = 0; first < dimension() - kRootFeatures; first += 3) turn(first);
  turn(velocity_feature());
  return result;
}

PoseFeatures PoseFeatures::restored(Skeleton skeleton, int root, std::vector<int> joints,
                                    const RowVectorD& fixed_channels) {
  const auto exists = [&](int joint) { return joint >= 0 && joint < skeleton.joint_count(); };
  if (!exists(root) || !std::all_of(joints.begin(), joints.end(), exists) ||
      fixed_channels.size() != skeleton.channel_count())
    throw InputError("pose features: sizes that do not fit together; the model file is damaged");
  Motion fixed = with_humanoid_orders({std::move(skeleton), 1.0, fixed_channels});
  PoseFeatures result;
  result.skeleton_ = std::move(fixed.skeleton);
  result.root_ = root;
  result.joints_ = std::move(joints);
  result.constant_channels_ = fixed.channels.row(0);
  result.find_leading_axes();
  return result;
}

void PoseFeatures::find_leading_axes() {
  for (const int joint : joints_) {
    Eigen::Vector3d longest(0, 0, 0);
    const auto consider = [&](const Eigen::Vector3d& bone) {
      if (bone.norm() > longest.norm()) longest = bone;
    };
    for (const Eigen::Vector3d& end : skeleton_.joints[joint].end_sites) consider(end);
    for (int child = 0; child < skeleton_.joint_count(); ++child)
      if (skeleton_.joints[child].parent == joint)
        consider(local_position(skeleton_.joints[child],
                                constant_channels_.data() + skeleton_.first_channel(child)));
    leading_axes_.push_back(std::abs(longest.y()) > std::abs(longest.x()) ? 1 : 0);
  }
}

}  // namespace mcdbn
