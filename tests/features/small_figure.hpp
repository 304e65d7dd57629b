#pragma once

#include <algorithm>
#include <cmath>

#include "mcdbn/features/modalities.hpp"
#include "motion/body_size.hpp"

namespace mcdbn::test {

/// A figure of a few joints with all that forward kinematics has to get right: a joint that does
/// not turn by itself, one that stands where its parent stands, branches.
class SmallFigure {
 public:
  SmallFigure() : modalities_(make()) {}

  const Modalities& modalities() const { return modalities_; }
  std::size_t dimension() const {
    return static_cast<std::size_t>(modalities_.pose_scale.output_dimension());
  }

  /// Joint positions by the motion layer's own decoding, relative to the root, in the camera's
  /// axes.
  /// @param pose standardized [frames x dimension]  @return [frames x 3·joints that stand apart]
  MatrixD positions_m(const MatrixD& pose) const {
    const MatrixD raw = raw_features(pose);
    const PoseFeatures& features = modalities_.pose_features;
    const Skeleton& skeleton = features.skeleton();
    const Motion motion = features.decode(raw, Eigen::Matrix3d::Identity(), skeleton, 30.0,
                                          MatrixD::Zero(pose.rows(), 3));
    const MatrixD all = joint_positions(motion);
    const MatrixD root = all.middleCols(3 * features.root(), 3);
    const auto names = modalities_.track_features.joint_names();
    MatrixD positions(pose.rows(), 3 * static_cast<Eigen::Index>(names.size()));
    for (std::size_t i = 0; i < names.size(); ++i)
      positions.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
          (all.middleCols(3 * skeleton.find(names[i]), 3) - root) / file_units_per_metre(skeleton);
    return positions;
  }

  /// Of these, the foot's. @return [frames x 3]
  MatrixD foot_m(const MatrixD& pose) const {
    const auto names = modalities_.track_features.joint_names();
    const auto foot = std::find(names.begin(), names.end(), "Foot") - names.begin();
    return positions_m(pose).middleCols(3 * foot, 3);
  }

  /// In the camera's axes. @return [frames x 3]
  MatrixD root_velocity_m_s(const MatrixD& pose) const {
    return modalities_.pose_features.root_features(raw_features(pose)).rightCols(3);
  }

 private:
  MatrixD raw_features(const MatrixD& pose) const {
    const Standardizer& scale = modalities_.pose_scale;
    MatrixD raw = scale.mean().replicate(pose.rows(), 1);
    for (int k = 0; k < scale.output_dimension(); ++k)
      raw.col(scale.kept_columns()[k]) += pose.col(k) * scale.deviation()[scale.kept_columns()[k]];
    return raw;
  }

  static Joint joint(const std::string& name, int parent, Eigen::Vector3d offset, bool turns) {
    Joint result;
    result.name = name;
    result.parent = parent;
    result.offset = offset;
    if (parent < 0)
      result.channels = {Channel::x_position, Channel::y_position, Channel::z_position};
    if (turns)
      for (const Channel channel : {Channel::z_rotation, Channel::x_rotation, Channel::y_rotation})
        result.channels.push_back(channel);
    return result;
  }

  static Modalities make() {
    Motion motion;
    motion.frame_time_s = 1.0 / 30.0;
    motion.skeleton.joints = {
        joint("Hips", -1, {0, 0, 0}, true),   joint("Waist", 0, {0, 0, 0}, true),
        joint("Chest", 1, {0, 30, 2}, false), joint("Arm", 2, {20, 5, 0}, true),
        joint("Hand", 3, {25, -3, 4}, true),  joint("Knee", 0, {4, -40, 1}, true),
        joint("Foot", 5, {0, -42, 3}, true)};
    const int channels = motion.skeleton.channel_count();
    motion.channels = MatrixD::Zero(50, channels);
    for (int t = 0; t < 50; ++t)
      for (int c = 0; c < channels; ++c)
        motion.channels(t, c) = 25.0 * std::sin(0.21 * t + 1.3 * c) + (c % 5) - 2.0;
    // The hand does not turn by itself but stands askew.
    motion.channels.middleCols(motion.skeleton.first_channel(4), 3).rowwise() =
        RowVectorD(Eigen::RowVector3d(20, -10, 5));
    PoseFeatures features = PoseFeatures::fit({&motion});
    TrackFeatures track = TrackFeatures::for_skeleton(features.skeleton(), features.root());
    const MatrixD pose = features.encode(motion, Eigen::Matrix3d::Identity());
    const MatrixD any = MatrixD::Random(10, track.dimension());
    Standardizer pose_scale = Standardizer::fit({&pose}), track_scale = Standardizer::fit({&any});
    return {std::move(features),
            std::move(track),
            std::move(pose_scale),
            std::move(track_scale),
            30.0,
            {}};
  }

  Modalities modalities_;
};

}  // namespace mcdbn::test
