#include "mcdbn/motion/skeleton_roles.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include <string>
#include <vector>

#include "mcdbn/base/errors.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Limbs {
  std::string leg[4];  ///< thigh, shank, foot, toes
  std::string arm[4];  ///< clavicle, upper arm, forearm, hand
};

/// A body whose joints are named as given; `%` is where the side goes. The right side comes first,
/// so that the order carries no information.
Skeleton body_named(const std::string& root, const std::vector<std::string>& trunk,
                    const Limbs& limbs, const std::string& left, const std::string& right) {
  Skeleton body;
  const auto add = [&](std::string name, int parent, Eigen::Vector3d offset) {
    body.joints.push_back(make_joint(std::move(name), parent, offset, {x_rotation}));
    return body.joint_count() - 1;
  };
  const auto sided = [](std::string name, const std::string& side) {
    if (const auto at = name.find('%'); at != std::string::npos) name.replace(at, 1, side);
    return name;
  };
  const int hips = add(root, -1, {0, 0, 0});
  std::vector<int> spine{hips};
  for (const std::string& name : trunk)
    spine.push_back(add(name, spine.back(), {0, 120.0 / static_cast<double>(trunk.size()), 0}));
  const int chest = spine[trunk.size() - 2];
  for (const auto& [side, x] : {std::pair{right, -1.0}, std::pair{left, 1.0}}) {
    int joint = hips;
    const Eigen::Vector3d leg[4]{{10 * x, -4, 0}, {0, -42, 0}, {0, -41, 0}, {0, -6, 14}};
    for (int k = 0; k < 4; ++k) joint = add(sided(limbs.leg[k], side), joint, leg[k]);
    joint = chest;
    const Eigen::Vector3d arm[4]{{3 * x, 8, 0}, {14 * x, 0, 0}, {30 * x, 0, 0}, {26 * x, 0, 0}};
    for (int k = 0; k < 4; ++k) joint = add(sided(limbs.arm[k], side), joint, arm[k]);
  }
  return body;
}

std::string joint_name(const Skeleton& skeleton, JointRole role) {
  const int joint = skeleton_roles(skeleton).joint(role);
  return joint < 0 ? "" : skeleton.joints[joint].name;
}

/// The leg and arm roles of both sides are where the body was built with them.
void check_limbs(const Skeleton& body) {
  const SkeletonRoles roles = skeleton_roles(body);
  using enum JointRole;
  const int first = body.find(body.joints[roles.joint(right_hip)].name);
  const std::vector<JointRole> right{right_hip,      right_knee,     right_ankle, right_toe,
                                     right_clavicle, right_shoulder, right_elbow, right_wrist};
  for (std::size_t k = 0; k < right.size(); ++k) {
    CAPTURE(std::string(name_of(right[k])));
    CHECK(roles.joint(right[k]) == first + static_cast<int>(k));
    CHECK(roles.joint(other_side(right[k])) == first + 8 + static_cast<int>(k));
  }
  CHECK(roles.joint(pelvis) == 0);
  CHECK(roles.has(neck));
  CHECK(roles.has(head));
  CHECK(body.joints[roles.joint(left_hip)].offset.x() > 0);
}

}  // namespace

TEST_CASE("skeleton roles: limbs by the names of many programs") {
  const std::vector<std::string> trunk{"Spine", "Spine1", "Neck", "Head"};
  struct Family {
    const char* about;
    std::string root;
    std::vector<std::string> trunk;
    Limbs limbs;
    std::string left, right;
  };
  const std::vector<Family> families{
      {"LAFAN",
       "Hips",
       trunk,
       {{"%UpLeg", "%Leg", "%Foot", "%Toe"}, {"%Shoulder", "%Arm", "%ForeArm", "%Hand"}},
       "Left",
       "Right"},
      {"Mixamo",
       "mixamorig:Hips",
       {"mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Neck", "mixamorig:Head"},
       {{"mixamorig:%UpLeg", "mixamorig:%Leg", "mixamorig:%Foot", "mixamorig:%ToeBase"},
        {"mixamorig:%Shoulder", "mixamorig:%Arm", "mixamorig:%ForeArm", "mixamorig:%Hand"}},
       "Left",
       "Right"},
      {"Xsens",
       "Pelvis",
       {"L5", "L3", "T12", "T8", "Neck", "Head"},
       {{"%UpperLeg", "%LowerLeg", "%Foot", "%Toe"},
        {"%Shoulder", "%UpperArm", "%ForeArm", "%Hand"}},
       "Left",
       "Right"},
      {"ASF",
       "root",
       {"lowerback", "upperback", "thorax", "lowerneck", "upperneck", "head"},
       {{"%femur", "%tibia", "%foot", "%toes"}, {"%clavicle", "%humerus", "%radius", "%wrist"}},
       "l",
       "r"},
      {"Bandai",
       "Hips",
       {"Spine", "Chest", "Neck", "Head"},
       {{"UpperLeg_%", "LowerLeg_%", "Foot_%", "Toes_%"},
        {"Shoulder_%", "UpperArm_%", "LowerArm_%", "Hand_%"}},
       "L",
       "R"},
      {"collars",
       "Hips",
       {"Chest", "Chest2", "Neck", "Head"},
       {{"%Hip", "%Knee", "%Ankle", "%Toe"}, {"%Collar", "%Shoulder", "%Elbow", "%Wrist"}},
       "Left",
       "Right"},
      {"SMPL",
       "Pelvis",
       {"Spine1", "Spine2", "Spine3", "Neck", "Head"},
       {{"%_Hip", "%_Knee", "%_Ankle", "%_Foot"}, {"%_Collar", "%_Shoulder", "%_Elbow", "%_Wrist"}},
       "L",
       "R"},
      {"Biped",
       "Bip01",
       {"Bip01 Spine", "Bip01 Spine1", "Bip01 Neck", "Bip01 Head"},
       {{"Bip01 % Thigh", "Bip01 % Calf", "Bip01 % Foot", "Bip01 % Toe0"},
        {"Bip01 % Clavicle", "Bip01 % UpperArm", "Bip01 % Forearm", "Bip01 % Hand"}},
       "L",
       "R"},
      {"Unreal",
       "pelvis",
       {"spine_01", "spine_02", "neck_01", "head"},
       {{"thigh_%", "calf_%", "foot_%", "ball_%"},
        {"clavicle_%", "upperarm_%", "lowerarm_%", "hand_%"}},
       "l",
       "r"},
      {"Blender",
       "hips",
       {"spine", "chest", "neck", "head"},
       {{"thigh.%", "shin.%", "foot.%", "toe.%"},
        {"shoulder.%", "upper_arm.%", "forearm.%", "hand.%"}},
       "L",
       "R"},
      {"Kinect",
       "SpineBase",
       {"SpineMid", "SpineShoulder", "Neck", "Head"},
       {{"Hip%", "Knee%", "Ankle%", "Foot%"}, {"Clavicle%", "Shoulder%", "Elbow%", "Wrist%"}},
       "Left",
       "Right"},
      {"VRM",
       "J_Bip_C_Hips",
       {"J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_UpperChest", "J_Bip_C_Neck", "J_Bip_C_Head"},
       {{"J_Bip_%_UpperLeg", "J_Bip_%_LowerLeg", "J_Bip_%_Foot", "J_Bip_%_ToeBase"},
        {"J_Bip_%_Shoulder", "J_Bip_%_UpperArm", "J_Bip_%_LowerArm", "J_Bip_%_Hand"}},
       "L",
       "R"},
      {"Maya",
       "Root_M",
       {"Spine1_M", "Chest_M", "Neck_M", "Head_M"},
       {{"Hip_%", "Knee_%", "Ankle_%", "Toes_%"},
        {"Scapula_%", "Shoulder_%", "Elbow_%", "Wrist_%"}},
       "L",
       "R"},
      {"Auto-Rig Pro",
       "root.x",
       {"spine_01.x", "spine_02.x", "neck.x", "head.x"},
       {{"thigh_stretch.%", "leg_stretch.%", "foot.%", "toes_01.%"},
        {"shoulder.%", "arm_stretch.%", "forearm_stretch.%", "hand.%"}},
       "l",
       "r"},
      {"Rigify",
       "DEF-spine",
       {"DEF-spine.001", "DEF-spine.002", "DEF-spine.003", "DEF-spine.004", "DEF-spine.005"},
       {{"DEF-thigh.%", "DEF-shin.%", "DEF-foot.%", "DEF-toe.%"},
        {"DEF-shoulder.%", "DEF-upper_arm.%", "DEF-forearm.%", "DEF-hand.%"}},
       "L",
       "R"},
      {"Motive",
       "Hip",
       {"Ab", "Chest", "Neck", "Head"},
       {{"%Thigh", "%Shin", "%Foot", "%Toe"}, {"%Shoulder", "%UArm", "%FArm", "%Hand"}},
       "L",
       "R"},
      {"shouted",
       "ROOT",
       {"SPINE", "CHEST", "NECK", "HEAD"},
       {{"%THIGH", "%SHIN", "%FOOT", "%TOE"}, {"%CLAVICLE", "%UPPERARM", "%FOREARM", "%HAND"}},
       "L",
       "R"},
  };
  for (const Family& family : families) {
    CAPTURE(family.about);
    check_limbs(body_named(family.root, family.trunk, family.limbs, family.left, family.right));
  }
}

TEST_CASE("skeleton roles: names of programs beside bones of hair, and twisting ones between") {
  struct Bone {
    std::string name, parent;
  };
  using enum JointRole;
  const auto check = [](const std::vector<Bone>& bones,
                        const std::vector<std::pair<JointRole, std::string>>& wanted) {
    Skeleton body;
    for (const Bone& bone : bones)
      body.joints.push_back(make_joint(bone.name, body.find(bone.parent), {1, 10, 0}, {}));
    for (const auto& [role, name] : wanted) {
      const std::string role_name(name_of(role));
      CAPTURE(role_name);
      CHECK(joint_name(body, role) == name);
    }
  };
  // VRM: what all names begin with is less than what a body's begin with.
  check({{"Root", ""},
         {"J_Bip_C_Hips", "Root"},
         {"J_Bip_C_Spine", "J_Bip_C_Hips"},
         {"J_Bip_C_Chest", "J_Bip_C_Spine"},
         {"J_Bip_C_UpperChest", "J_Bip_C_Chest"},
         {"J_Bip_C_Neck", "J_Bip_C_UpperChest"},
         {"J_Bip_C_Head", "J_Bip_C_Neck"},
         {"J_Sec_Hair1_01", "J_Bip_C_Head"},
         {"J_Bip_L_Shoulder", "J_Bip_C_UpperChest"},
         {"J_Bip_L_UpperArm", "J_Bip_L_Shoulder"},
         {"J_Bip_R_UpperLeg", "J_Bip_C_Hips"},
         {"J_Bip_R_LowerLeg", "J_Bip_R_UpperLeg"}},
        {{pelvis, "J_Bip_C_Hips"},
         {spine, "J_Bip_C_Spine"},
         {chest, "J_Bip_C_UpperChest"},
         {neck, "J_Bip_C_Neck"},
         {head, "J_Bip_C_Head"},
         {left_clavicle, "J_Bip_L_Shoulder"},
         {left_shoulder, "J_Bip_L_UpperArm"},
         {right_hip, "J_Bip_R_UpperLeg"},
         {right_knee, "J_Bip_R_LowerLeg"}});
  // DAZ, Genesis 8.
  check({{"hip", ""},
         {"pelvis", "hip"},
         {"lThighBend", "pelvis"},
         {"lThighTwist", "lThighBend"},
         {"lShin", "lThighTwist"},
         {"lFoot", "lShin"},
         {"lToe", "lFoot"},
         {"abdomenLower", "hip"},
         {"abdomenUpper", "abdomenLower"},
         {"chestLower", "abdomenUpper"},
         {"lCollar", "chestLower"},
         {"lShldrBend", "lCollar"},
         {"lShldrTwist", "lShldrBend"},
         {"lForearmBend", "lShldrTwist"},
         {"lForearmTwist", "lForearmBend"},
         {"lHand", "lForearmTwist"},
         {"chestUpper", "chestLower"},
         {"neckLower", "chestUpper"},
         {"neckUpper", "neckLower"},
         {"head", "neckUpper"}},
        {{pelvis, "hip"},
         {spine, "abdomenLower"},
         {chest, "chestUpper"},
         {neck, "neckLower"},
         {head, "head"},
         {left_clavicle, "lCollar"},
         {left_shoulder, "lShldrBend"},
         {left_elbow, "lForearmBend"},
         {left_wrist, "lHand"},
         {left_hip, "lThighBend"},
         {left_knee, "lShin"},
         {left_ankle, "lFoot"},
         {left_toe, "lToe"}});
  // Character Creator: the neck is a bone that twists.
  check({{"CC_Base_Hip", ""},
         {"CC_Base_L_Thigh", "CC_Base_Hip"},
         {"CC_Base_R_Thigh", "CC_Base_Hip"},
         {"CC_Base_Waist", "CC_Base_Hip"},
         {"CC_Base_Spine01", "CC_Base_Waist"},
         {"CC_Base_Spine02", "CC_Base_Spine01"},
         {"CC_Base_NeckTwist01", "CC_Base_Spine02"},
         {"CC_Base_NeckTwist02", "CC_Base_NeckTwist01"},
         {"CC_Base_Head", "CC_Base_NeckTwist02"},
         {"CC_Base_L_Clavicle", "CC_Base_Spine02"},
         {"CC_Base_L_Upperarm", "CC_Base_L_Clavicle"}},
        {{pelvis, "CC_Base_Hip"},
         {chest, "CC_Base_Spine02"},
         {neck, "CC_Base_NeckTwist01"},
         {head, "CC_Base_Head"},
         {left_shoulder, "CC_Base_L_Upperarm"}});
  // Rigify: neck and head go on with the spine's numbers.
  check({{"DEF-spine", ""},
         {"DEF-pelvis.L", "DEF-spine"},
         {"DEF-thigh.L", "DEF-pelvis.L"},
         {"DEF-thigh.L.001", "DEF-thigh.L"},
         {"DEF-shin.L", "DEF-thigh.L.001"},
         {"DEF-pelvis.R", "DEF-spine"},
         {"DEF-thigh.R", "DEF-pelvis.R"},
         {"DEF-spine.001", "DEF-spine"},
         {"DEF-spine.002", "DEF-spine.001"},
         {"DEF-spine.003", "DEF-spine.002"},
         {"DEF-spine.004", "DEF-spine.003"},
         {"DEF-spine.005", "DEF-spine.004"},
         {"DEF-spine.006", "DEF-spine.005"},
         {"DEF-forehead.L", "DEF-spine.006"},
         {"DEF-shoulder.L", "DEF-spine.003"},
         {"DEF-upper_arm.L", "DEF-shoulder.L"},
         {"DEF-shoulder.R", "DEF-spine.003"},
         {"DEF-upper_arm.R", "DEF-shoulder.R"}},
        {{pelvis, "DEF-spine"},
         {spine, "DEF-spine.001"},
         {chest, "DEF-spine.003"},
         {neck, "DEF-spine.004"},
         {head, "DEF-spine.006"},
         {left_hip, "DEF-thigh.L"},
         {left_knee, "DEF-shin.L"},
         {left_shoulder, "DEF-upper_arm.L"}});
}

TEST_CASE("skeleton roles: by the tree where names carry no information") {
  const std::vector<std::string> trunk{"j1", "j2", "j3", "j4"};
  const auto numbered = [&](const std::string& left, const std::string& right) {
    return body_named("base", trunk, {{"a%", "b%", "c%", "d%"}, {"e%", "f%", "g%", "h%"}}, left,
                      right);
  };
  check_limbs(numbered("1", "2"));
  // Turned half round and laid on its side: feet and head show which side is left.
  Skeleton turned = numbered("1", "2");
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  for (Joint& joint : turned.joints) joint.offset = turn * joint.offset;
  const SkeletonRoles roles = skeleton_roles(turned);
  CHECK(turned.joints[roles.joint(JointRole::left_hip)].name == "a1");
  CHECK(turned.joints[roles.joint(JointRole::right_wrist)].name == "h2");
  // Marks in the names come before the rest pose.
  const Skeleton marked = numbered("_R", "_L");
  CHECK(joint_name(marked, JointRole::left_knee) == "b_L");
  CHECK(joint_name(marked, JointRole::left_elbow) == "g_L");
}

TEST_CASE("skeleton roles: given by hand") {
  const Skeleton body = small_body();
  CHECK(joint_name(body, JointRole::left_hip) == "LLeg");
  CHECK(joint_name(body, JointRole::left_shoulder) == "LArm");
  CHECK(joint_name(body, JointRole::left_wrist) == "LHand");
  CHECK(joint_name(body, JointRole::chest) == "Chest");
  const SkeletonRoles roles =
      skeleton_roles(body, {{JointRole::left_elbow, "LHand"}, {JointRole::head, "Neck"}});
  CHECK(body.joints[roles.joint(JointRole::left_elbow)].name == "LHand");
  CHECK_FALSE(roles.has(JointRole::left_wrist));  // one joint, one role
  CHECK(body.joints[roles.joint(JointRole::head)].name == "Neck");
  CHECK(roles.role_of(body.find("LHand")) == JointRole::left_elbow);
  CHECK_FALSE(roles.role_of(body.find("LHip")).has_value());
  CHECK_FALSE(roles.role_of(-1).has_value());
  const auto missing = roles.missing();
  CHECK(std::ranges::count(missing, JointRole::left_wrist) == 1);
  CHECK(std::ranges::count(missing, JointRole::left_elbow) == 0);
  CHECK_THROWS_WITH_AS(skeleton_roles(body, {{JointRole::head, "Tail"}}),
                       "head is to be the joint Tail, and the skeleton has no joint of that name",
                       InputError);
  CHECK_THROWS_WITH_AS(skeleton_roles(body, {{JointRole::head, "Neck"}, {JointRole::neck, "Neck"}}),
                       doctest::Contains("give it one role"), InputError);
}

TEST_CASE("skeleton roles: a body of one joint, or none that is a body, has none") {
  Skeleton stick;
  stick.joints = {make_joint("Base", -1, {0, 0, 0}, {}), make_joint("End", 0, {0, 10, 0}, {})};
  CHECK(skeleton_roles(stick).missing().size() == joint_roles().size());
  CHECK(skeleton_roles(Skeleton{}).missing().size() == joint_roles().size());
}
