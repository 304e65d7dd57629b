#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/camera/keypoint.hpp"

namespace mcdbn {

/// The joints of a detector in the order of its files.
struct JointSet {
  std::string name;  ///< "BODY_25"
  std::vector<Keypoint> keypoints;
};

/// All that are known: BODY_25, BODY_25B, COCO_18, COCO_17, COCO_23 (the body of COCO-WholeBody),
/// HALPE_26, MEDIAPIPE_33, H36M_17.
/// The orders are those of OpenPose's poseParameters.cpp, of MMPose's dataset descriptions and of
/// MediaPipe's pose landmarks.
std::span<const JointSet> joint_sets();

/// @throws InputError, listing the names, if none is called so
const JointSet& joint_set(std::string_view name);

/// The set with these names in this order, or none.
const JointSet* joint_set_of(std::span<const std::string> names);

/// The keypoint of a column, from its name in a file in any of the usual spellings: "LShoulder",
/// "left_shoulder", "shoulder-left", "Left Shoulder". Without a role where the name is unknown, and
/// of the `spine` that Human3.6M has, halfway between hips and shoulders. A foot is the toes.
Keypoint keypoint_of(const std::string& name);

/// keypoint_of of every name, if they are a human's: both sides of two kinds of limb joints at
/// least; else the names alone, without roles, for the left ear of a mouse is no left ear. A foot
/// is the ankle where no other name of its side is at the ankle, as in Human3.6M's joints.
std::vector<Keypoint> keypoints_of(std::span<const std::string> names);

}  // namespace mcdbn
