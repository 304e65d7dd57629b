#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// Where a detector's keypoints put the joints of a skeleton. A keypoint is a place on the body,
/// not the joint itself: the offset between them is taken off, first as far as the track alone
/// gives it, then as a 3D answer to the track has it. A joint of several keypoints lies at their
/// weighted mean; pelvis and neck follow from both hips and both shoulders where no keypoint is
/// theirs.
class KeypointMap {
 public:
  /// @throws InputError, naming what is missing, if the keypoints show less than three of the
  ///         skeleton's joints, or neither its pelvis nor both hips
  KeypointMap(const std::vector<Keypoint>& keypoints, const Skeleton& skeleton,
              const SkeletonRoles& roles);

  /// The joints from the track alone. Left and up are taken from hips and shoulders on the image;
  /// how far before its joint a place lies is unknown yet, which lowers its weight.
  /// @param track with the keypoints of the map
  /// @return the joints that are shown, by name, without keypoints; confidence is the mean over a
  ///         joint's readings
  Track2d joints_of(const Track2d& track) const;
  /// The joints given an answer: the projected offset of place from joint is taken off.
  /// @param answer of the skeleton, as many frames as the track  @param camera that sees it as the
  /// track shows it  @throws ShapeError
  Track2d joints_of(const Track2d& track, const Motion& answer, const Camera& camera) const;
  /// The evidence in such joints: those that follow only from other joints that are observed
  /// themselves, as the pelvis from both hips, become unseen, and those observed by places away
  /// from them count less. In a fit they would support the answer that put them there.
  Track2d evidence(Track2d joints) const;

 private:
  struct RestBody;
  /// An observation of a joint: the mean of some columns.
  struct Reading {
    std::size_t joint = 0;         ///< index into joints_
    std::vector<int> columns;      ///< one, or those of both sides
    Eigen::Vector3d offset;        ///< of the place from the joint: left, up, forward; body heights
    bool is_marked_itself = true;  ///< not by other joints that are observed
  };
  /// Pixels from joint to place for each reading in turn, and how far off that may be, in body
  /// heights. [frames x 2·readings]
  struct Displacements {
    MatrixD px;
    std::vector<double> uncertain;
  };

  bool shows(JointRole role) const;
  /// Adds an observation of the role's joint, if the skeleton has it and all the keypoints' places.
  void add_reading(const RestBody& rest, JointRole role, std::vector<int> columns);
  /// @throws InputError
  void require_enough_joints() const;
  /// Sets hip_width_ and trunk_length_; 0 where the skeleton lacks hips or shoulders.
  void measure_trunk(const RestBody& rest);

  Displacements seen_displacements(const Track2d& track) const;
  Track2d without(const Track2d& track, const Displacements& displacements) const;

  std::vector<Keypoint> keypoints_;
  SkeletonRoles roles_;
  std::vector<std::string> names_;
  std::vector<int> joints_;  ///< that are shown, in the skeleton
  std::vector<Reading> readings_;
  double hip_width_ = 0, trunk_length_ = 0;  ///< body heights
};

}  // namespace mcdbn
