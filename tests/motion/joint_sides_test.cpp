#include "motion/joint_sides.hpp"

#include <doctest/doctest.h>

#include "base/capture_bound.hpp"

using namespace mcdbn;

TEST_CASE("joint sides: by a word or a letter of the name") {
  for (const char* name :
       {"LeftArm", "leftArm", "UPPER_LEFT_LEG", "arm.left", "LHipJoint", "l_arm", "L.arm", "L-arm",
        "l arm", "lArm", "Arm_L", "arm.l", "arm-L", "arm L", "L_Finger_1"}) {
    CAPTURE(name);
    CHECK(side_of(name) == Side::left);
  }
  for (const char* name : {"RightArm", "forearm_right", "RHipJoint", "r_arm", "Hand_R", "rArm"}) {
    CAPTURE(name);
    CHECK(side_of(name) == Side::right);
  }
  for (const char* name :
       {"", "L", "Hips", "ROOT", "Root", "LHIP", "Lower", "lumbar", "Spine_1", "Collar", "R2"}) {
    CAPTURE(name);
    CHECK(side_of(name) == Side::middle);
  }
}

TEST_CASE("joint sides: letters that may mark a side begin or end a word") {
  using Names = std::vector<std::string>;
  const std::pair<const char*, Names> cases[] = {{"lfemur", {"rfemur", "lfemul"}},
                                                 {"armL", {"armR"}},
                                                 {"Bip01 L Thigh", {"Bip01 R Thigh"}},
                                                 {"J_Bip_R_Hand", {"J_Bip_L_Hand"}},
                                                 {"thigh.L.001", {"thigh.R.001"}},
                                                 {"R", {"L"}},
                                                 {"spine", {}},
                                                 {"", {}},
                                                 {"balk", {}}};
  for (const auto& [name, others] : cases) {
    CAPTURE_BOUND(name);
    CHECK(possible_other_sides(name) == others);
  }
}

TEST_CASE("joint sides: the other side's name, in the same case") {
  const std::pair<const char*, const char*> pairs[] = {
      {"LeftArm", "RightArm"},    {"upleft", "upright"}, {"UPPER_LEFT_LEG", "UPPER_RIGHT_LEG"},
      {"LHipJoint", "RHipJoint"}, {"LHIP", "RHIP"},      {"l_arm", "r_arm"},
      {"arm.L", "arm.R"},         {"arm-l", "arm-r"},    {"L_Finger_1", "R_Finger_1"},
      {"LFoot_end", "RFoot_end"}};
  for (const auto& [left, right] : pairs) {
    CAPTURE_BOUND(left);
    CHECK(other_side(left) == right);
    CHECK(other_side(right) == left);
  }
  for (const char* name : {"", "L", "Hips", "Spine_1", "Lower"}) {
    CAPTURE(name);
    CHECK(other_side(name).empty());
  }
}
