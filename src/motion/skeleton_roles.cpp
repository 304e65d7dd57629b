#include "mcdbn/motion/skeleton_roles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "mcdbn/base/errors.hpp"
#include "motion/joint_words.hpp"
#include "motion/limb_chains.hpp"

namespace mcdbn {
namespace {

using enum JointRole;

constexpr int kNone = -1;

/// The role on that side, given its left one.
JointRole on_side(JointRole left, Side side) {
  return side == Side::left ? left : other_side(left);
}

bool is_ancestor(const Skeleton& skeleton, int ancestor, int joint) {
  while (joint > ancestor) joint = skeleton.joints[joint].parent;
  return joint == ancestor && ancestor >= 0;
}

/// A skeleton's joints by the words and sides in their names.
class Names {
 public:
  explicit Names(const Skeleton& skeleton) : skeleton_(skeleton) {
    std::vector<std::string> names;
    for (const Joint& joint : skeleton.joints) names.push_back(joint.name);
    joints_ = named_joints(names);
  }

  /// The first joint of that word, or -1.
  int first(JointWord word, Side side) const {
    for (int j = 0; j < skeleton_.joint_count(); ++j)
      if (is(j, word, side)) return j;
    return kNone;
  }

  /// The first joint of that word away from `joint`, or -1.
  int first_away_from(int joint, JointWord word, Side side) const {
    for (int j = 0; j < skeleton_.joint_count(); ++j) {
      double distance = 0;
      for (int up = j; up > joint; up = skeleton_.joints[up].parent)
        distance += skeleton_.joints[up].offset.norm();
      if (is(j, word, side) && distance > 0 && is_ancestor(skeleton_, joint, j)) return j;
    }
    return kNone;
  }

 private:
  bool is(int joint, JointWord word, Side side) const {
    return joints_[joint] && joints_[joint]->word == word && joints_[joint]->side == side;
  }

  const Skeleton& skeleton_;
  std::vector<std::optional<NamedJoint>> joints_;
};

int first_of(std::initializer_list<int> joints) {
  for (const int joint : joints)
    if (joint != kNone) return joint;
  return kNone;
}

LimbChain named_leg(const Names& names, Side side) {
  const auto joint = [&](JointWord word) { return names.first(word, side); };
  const int leg = joint(JointWord::leg), shin = joint(JointWord::shin),
            thigh = joint(JointWord::thigh), hip = joint(JointWord::hip);
  LimbChain limb;
  limb.first = first_of({thigh, shin != kNone ? leg : kNone, hip, leg});
  limb.middle = first_of({shin, limb.first != leg ? leg : kNone});
  limb.end = first_of({joint(JointWord::ankle), joint(JointWord::foot)});
  limb.tip = first_of(
      {joint(JointWord::toe), joint(JointWord::ankle) != kNone ? joint(JointWord::foot) : kNone});
  return limb;
}

LimbChain named_arm(const Names& names, Side side) {
  const auto joint = [&](JointWord word) { return names.first(word, side); };
  const int upper = joint(JointWord::upper_arm), arm = joint(JointWord::arm),
            shoulder = joint(JointWord::shoulder);
  LimbChain limb;
  limb.first = first_of({upper, arm, shoulder});
  limb.girdle = first_of({joint(JointWord::clavicle), limb.first != shoulder ? shoulder : kNone});
  limb.middle = first_of({joint(JointWord::forearm), upper != kNone ? arm : kNone});
  const int wrist = joint(JointWord::wrist), hand = joint(JointWord::hand);
  limb.end = first_of({wrist, hand});
  if (limb.end != kNone)
    limb.tip = first_of(
        {wrist != kNone ? hand : kNone, names.first_away_from(limb.end, JointWord::fingers, side)});
  return limb;
}

void set_leg(SkeletonRoles& roles, const LimbChain& limb, Side side) {
  roles.set(on_side(left_hip, side), limb.first);
  roles.set(on_side(left_knee, side), limb.middle);
  roles.set(on_side(left_ankle, side), limb.end);
  roles.set(on_side(left_toe, side), limb.tip);
}

void set_arm(SkeletonRoles& roles, const LimbChain& limb, Side side) {
  roles.set(on_side(left_clavicle, side), limb.girdle);
  roles.set(on_side(left_shoulder, side), limb.first);
  roles.set(on_side(left_elbow, side), limb.middle);
  roles.set(on_side(left_wrist, side), limb.end);
  roles.set(on_side(left_hand, side), limb.tip);
}

SkeletonRoles roles_by_name(const Skeleton& skeleton) {
  const Names names(skeleton);
  SkeletonRoles roles;
  for (const Side side : {Side::left, Side::right}) {
    set_leg(roles, named_leg(names, side), side);
    set_arm(roles, named_arm(names, side), side);
  }
  roles.set(pelvis, names.first(JointWord::hips, Side::middle));
  roles.set(neck, names.first(JointWord::neck, Side::middle));
  roles.set(head, names.first(JointWord::head, Side::middle));
  return roles;
}

bool any(const SkeletonRoles& roles, std::initializer_list<JointRole> asked) {
  return std::ranges::any_of(
      asked, [&](JointRole role) { return roles.has(role) || roles.has(other_side(role)); });
}

/// Limbs that no name identifies, by the tree.
void add_chains(const Skeleton& skeleton, SkeletonRoles& roles) {
  const bool legs = any(roles, {left_hip, left_knee, left_ankle, left_toe});
  const bool arms = any(roles, {left_clavicle, left_shoulder, left_elbow, left_wrist, left_hand});
  if (legs && arms) return;
  const BodyChains body = body_chains(skeleton);
  if (!legs && body.legs)
    for (const Side side : {Side::left, Side::right})
      set_leg(roles, (*body.legs)[side == Side::right], side);
  if (!arms && body.arms)
    for (const Side side : {Side::left, Side::right})
      set_arm(roles, (*body.arms)[side == Side::right], side);
  for (const auto& [role, joint] :
       {std::pair{pelvis, body.pelvis}, std::pair{neck, body.neck}, std::pair{head, body.head}})
    if (!roles.has(role)) roles.set(role, joint);
}

/// The joint where both legs meet is the pelvis, unless another is called so.
void add_pelvis(const Skeleton& skeleton, SkeletonRoles& roles) {
  const int left = roles.joint(left_hip), right = roles.joint(right_hip);
  if (roles.has(pelvis) || left == kNone || right == kNone) return;
  int joint = skeleton.joints[left].parent;
  while (joint != kNone && !is_ancestor(skeleton, joint, right))
    joint = skeleton.joints[joint].parent;
  roles.set(pelvis, joint);
}

/// The name without the number at its end: `spine` of `spine.004`.
std::string_view without_number(std::string_view name) {
  while (!name.empty() && std::isalpha(static_cast<unsigned char>(name.back())) == 0)
    name.remove_suffix(1);
  return name;
}

/// The child called as the joint itself, but for the number, or -1.
int next_of_name(const Skeleton& skeleton, int joint) {
  for (int j = joint + 1; j < skeleton.joint_count(); ++j)
    if (skeleton.joints[j].parent == joint &&
        without_number(skeleton.joints[j].name) == without_number(skeleton.joints[joint].name))
      return j;
  return kNone;
}

/// Blender's Rigify counts neck and head on with the spine: they are what goes on by its name above
/// the joint where both arms meet.
void add_numbered_head(const Skeleton& skeleton, SkeletonRoles& roles) {
  const int left = roles.joint(left_shoulder), right = roles.joint(right_shoulder);
  if (roles.has(neck) || roles.has(head) || left == kNone || right == kNone) return;
  int joint = skeleton.joints[left].parent;
  while (joint != kNone && !is_ancestor(skeleton, joint, right))
    joint = skeleton.joints[joint].parent;
  const bool is_trunk = joint != kNone && joint > roles.joint(pelvis);
  if (!is_trunk) return;
  std::vector<int> above;
  while ((joint = next_of_name(skeleton, joint)) != kNone) above.push_back(joint);
  if (above.empty()) return;
  roles.set(head, above.back());
  if (above.size() > 1) roles.set(neck, above.front());
}

/// Between pelvis and neck: the chest is the last joint, the spine the first that is not where the
/// pelvis is.
void add_trunk(const Skeleton& skeleton, SkeletonRoles& roles) {
  const int top = first_of({roles.joint(neck), roles.joint(head)});
  if (top == kNone || !is_ancestor(skeleton, roles.joint(pelvis), top)) return;
  std::vector<int> trunk;
  for (int j = skeleton.joints[top].parent; j > roles.joint(pelvis); j = skeleton.joints[j].parent)
    trunk.push_back(j);
  std::ranges::reverse(trunk);
  if (trunk.empty()) return;
  if (!roles.has(chest)) roles.set(chest, trunk.back());
  const auto first = std::ranges::find_if(
      trunk, [&](int joint) { return skeleton.joints[joint].offset.norm() > 1e-9; });
  if (first != trunk.end() && *first != roles.joint(chest) && !roles.has(spine))
    roles.set(spine, *first);
}

/// Roles given by hand take precedence; a joint that is given one loses the role it had.
void set_given(const Skeleton& skeleton, const JointMap& given, SkeletonRoles& roles) {
  std::map<int, JointRole> taken;
  for (const auto& [role, name] : given) {
    const auto count = std::ranges::count(skeleton.joints, name, &Joint::name);
    if (count != 1)
      throw InputError(fmt::format("{} is to be the joint {}, and the skeleton has {}",
                                   name_of(role), name,
                                   count == 0 ? "no joint of that name" : "several of that name"));
    const int joint = skeleton.find(name);
    if (const auto [at, first] = taken.emplace(joint, role); !first)
      throw InputError(fmt::format("the joint {} is to be {} and {}; give it one role", name,
                                   name_of(at->second), name_of(role)));
    if (const auto other = roles.role_of(joint)) roles.set(*other, kNone);
    roles.set(role, joint);
  }
}

}  // namespace

SkeletonRoles::SkeletonRoles() {
  joints_.fill(kNone);
}

std::optional<JointRole> SkeletonRoles::role_of(int joint) const {
  for (const JointRole role : joint_roles())
    if (joint >= 0 && this->joint(role) == joint) return role;
  return {};
}

std::vector<JointRole> SkeletonRoles::missing() const {
  std::vector<JointRole> roles;
  std::ranges::copy_if(joint_roles(), std::back_inserter(roles),
                       [&](JointRole role) { return !has(role); });
  return roles;
}

SkeletonRoles roles_by_name(const std::vector<std::string>& names) {
  Skeleton skeleton;
  for (const std::string& name : names) {
    skeleton.joints.emplace_back();
    skeleton.joints.back().name = name;
    skeleton.joints.back().parent = skeleton.joint_count() > 1 ? 0 : -1;
  }
  return roles_by_name(skeleton);
}

SkeletonRoles skeleton_roles(const Skeleton& skeleton, const JointMap& given) {
  SkeletonRoles roles = roles_by_name(skeleton);
  add_chains(skeleton, roles);
  set_given(skeleton, given, roles);
  add_pelvis(skeleton, roles);
  add_numbered_head(skeleton, roles);
  add_trunk(skeleton, roles);
  return roles;
}

}  // namespace mcdbn
