// The roles of the skeletons in recorded files.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <map>
#include <string>

#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"
#include "motion/cmu_names.hpp"
#include "shared_data.hpp"

using namespace mcdbn;

namespace {

using enum JointRole;
using Names = std::map<JointRole, std::string>;

/// The joints of every role; the left side's names stand for the right one's, too.
void check_roles(const std::string& relative, const Names& names, const std::string& left,
                 const std::string& right) {
  if (!test::have_shared_data(relative, "roles of a recorded skeleton")) return;
  CAPTURE(relative);
  const Skeleton skeleton = read_bvh(test::shared_data() / relative).skeleton;
  const SkeletonRoles roles = skeleton_roles(skeleton);
  const auto name = [&](JointRole role) {
    return roles.has(role) ? skeleton.joints[roles.joint(role)].name : std::string();
  };
  for (const JointRole role : joint_roles()) {
    CAPTURE(std::string(name_of(role)));
    const bool is_right = name_of(role).starts_with("right_");
    const auto found = names.find(is_right ? other_side(role) : role);
    std::string wanted = found == names.end() ? "" : found->second;
    if (const auto at = wanted.find(left); is_right && at != std::string::npos)
      wanted.replace(at, left.size(), right);
    CHECK(name(role) == wanted);
  }
}

const Names kBandai{{pelvis, "Hips"},
                    {spine, "Spine"},
                    {chest, "Chest"},
                    {neck, "Neck"},
                    {head, "Head"},
                    {left_clavicle, "Shoulder_L"},
                    {left_shoulder, "UpperArm_L"},
                    {left_elbow, "LowerArm_L"},
                    {left_wrist, "Hand_L"},
                    {left_hip, "UpperLeg_L"},
                    {left_knee, "LowerLeg_L"},
                    {left_ankle, "Foot_L"},
                    {left_toe, "Toes_L"}};

Names changed(Names names, const Names& others) {
  for (const auto& [role, name] : others) {
    if (name.empty())
      names.erase(role);
    else
      names[role] = name;
  }
  return names;
}

}  // namespace

TEST_CASE("roles of recorded skeletons: CMU in its spellings") {
  for (const char* file : {"cmu/walk/02_01.bvh", "cmu/jump/13_39.bvh", "cmu/forward_jump/13_11.bvh",
                           "cmu/other/02_01.bvh", "bvh_zoo/example.bvh"})
    check_roles(file, test::kCmuNames, "Left", "Right");
  check_roles("formats/cmu_asf_amc/16_15.bvh",
              {{pelvis, "root"},
               {spine, "upperback"},
               {chest, "thorax"},
               {neck, "lowerneck"},
               {head, "head"},
               {left_clavicle, "lclavicle"},
               {left_shoulder, "lhumerus"},
               {left_elbow, "lradius"},
               {left_wrist, "lwrist"},
               {left_hand, "lhand"},
               {left_hip, "lfemur"},
               {left_knee, "ltibia"},
               {left_ankle, "lfoot"},
               {left_toe, "ltoes"}},
              "l", "r");
}

TEST_CASE("roles of recorded skeletons: Bandai") {
  check_roles("bandai/set1/dataset-1_bow_active_001.bvh", kBandai, "_L", "_R");
}

TEST_CASE("roles of recorded skeletons: those of other programs") {
  check_roles("bvh_zoo/bvh_test1.bvh",
              changed(test::kCmuNames, {{chest, "Spine3"}, {left_hand, ""}}), "Left", "Right");
  check_roles("bvh_zoo/bvh_test2.bvh",
              {{pelvis, "Hips"},
               {spine, "Chest"},
               {chest, "Chest4"},
               {neck, "Neck"},
               {head, "Head"},
               {left_clavicle, "LeftCollar"},
               {left_shoulder, "LeftShoulder"},
               {left_elbow, "LeftElbow"},
               {left_wrist, "LeftWrist"},
               {left_hip, "LeftHip"},
               {left_knee, "LeftKnee"},
               {left_ankle, "LeftAnkle"},
               {left_toe, "LeftToe"}},
              "Left", "Right");
  check_roles("bvh_zoo/dab.bvh",
              changed(test::kCmuNames, {{chest, "Spine3"}, {left_hand, "LeftHandEnd"}}), "Left",
              "Right");
  check_roles("bvh_zoo/walk01.bvh", changed(test::kCmuNames, {{left_hand, ""}, {left_toe, ""}}),
              "Left", "Right");
  Names mixamo = changed(test::kCmuNames, {{chest, "Spine2"}, {left_hand, "LeftHandMiddle1"}});
  for (auto& [role, name] : mixamo) name = "mixamorig:" + name;
  check_roles("bvh_zoo/test_freebvh.bvh", mixamo, "Left", "Right");
}

TEST_CASE("roles of recorded skeletons: the tree gives the roles that names give") {
  for (const char* file : {"cmu/walk/02_01.bvh", "bvh_zoo/bvh_test1.bvh", "bvh_zoo/bvh_test2.bvh",
                           "bvh_zoo/walk01.bvh", "bvh_zoo/dab.bvh"}) {
    if (!test::have_shared_data(file, "roles by the tree")) continue;
    CAPTURE(std::string(file));
    Skeleton skeleton = read_bvh(test::shared_data() / file).skeleton;
    const SkeletonRoles by_name = skeleton_roles(skeleton);
    for (int j = 0; j < skeleton.joint_count(); ++j)
      skeleton.joints[j].name = fmt::format("j{}", j);
    const SkeletonRoles by_tree = skeleton_roles(skeleton);
    for (const JointRole role : {left_shoulder, left_elbow, left_wrist, left_hip, left_knee,
                                 left_ankle, left_toe, left_clavicle}) {
      CAPTURE(std::string(name_of(role)));
      CHECK(by_tree.joint(role) == by_name.joint(role));
      CHECK(by_tree.joint(other_side(role)) == by_name.joint(other_side(role)));
    }
    CHECK(by_tree.joint(pelvis) == by_name.joint(pelvis));
    CHECK(by_tree.joint(neck) == by_name.joint(neck));
  }
}
