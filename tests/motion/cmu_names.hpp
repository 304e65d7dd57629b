#pragma once

#include <map>
#include <string>

#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn::test {

/// What the CMU files call the joints of the middle and of the left side.
inline const std::map<JointRole, std::string> kCmuNames{{JointRole::pelvis, "Hips"},
                                                        {JointRole::spine, "Spine"},
                                                        {JointRole::chest, "Spine1"},
                                                        {JointRole::neck, "Neck"},
                                                        {JointRole::head, "Head"},
                                                        {JointRole::left_clavicle, "LeftShoulder"},
                                                        {JointRole::left_shoulder, "LeftArm"},
                                                        {JointRole::left_elbow, "LeftForeArm"},
                                                        {JointRole::left_wrist, "LeftHand"},
                                                        {JointRole::left_hand, "LeftHandIndex1"},
                                                        {JointRole::left_hip, "LeftUpLeg"},
                                                        {JointRole::left_knee, "LeftLeg"},
                                                        {JointRole::left_ankle, "LeftFoot"},
                                                        {JointRole::left_toe, "LeftToeBase"}};

}  // namespace mcdbn::test
