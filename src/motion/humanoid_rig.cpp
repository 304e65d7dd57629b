#include "mcdbn/motion/humanoid_rig.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <string_view>

#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"
#include "motion/nearest_rotation.hpp"
#include "motion/rest_pose.hpp"
#include "motion/rig_axes.hpp"

namespace mcdbn {
namespace {

using enum JointRole;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::string_view kNeckOrHead = "neck or head";

bool lacks_head(const SkeletonRoles& roles) {
  return !roles.has(neck) && !roles.has(head);
}

bool turns(const Joint& joint) {
  return std::ranges::any_of(joint.channels, is_rotation);
}

bool moves(const Joint& joint) {
  return std::ranges::any_of(joint.channels, [](Channel channel) { return !is_rotation(channel); });
}

/// The joints between two, from below `upper` on; empty if one does not stand above the other.
std::vector<int> joints_between(const Skeleton& skeleton, int lower, int upper) {
  std::vector<int> between;
  int joint = skeleton.joints[upper].parent;
  for (; joint > lower; joint = skeleton.joints[joint].parent) between.push_back(joint);
  if (joint != lower) return {};
  std::ranges::reverse(between);
  return between;
}

/// The spine bends first where a joint first turns, be it where the pelvis is (CMU's LowerBack).
SkeletonRoles with_lowest_spine(const Skeleton& skeleton, SkeletonRoles roles) {
  if (!roles.has(chest)) return roles;
  for (const int joint : joints_between(skeleton, roles.joint(pelvis), roles.joint(chest)))
    if (turns(skeleton.joints[joint])) {
      roles.set(spine, joint);
      break;
    }
  return roles;
}

/// Where each joint is on its parent, on average over a clip.
std::vector<Vector3d> mean_places(const Motion& motion) {
  std::vector<Vector3d> places;
  for (int j = 0; j < motion.skeleton.joint_count(); ++j) {
    const Joint& joint = motion.skeleton.joints[j];
    places.push_back(joint.offset);
    if (motion.frames() == 0) continue;
    const RowVectorD mean = motion.channels
                                .middleCols(motion.skeleton.first_channel(j),
                                            static_cast<Eigen::Index>(joint.channels.size()))
                                .colwise()
                                .mean();
    places.back() = local_position(joint, mean.data());
  }
  return places;
}

/// How each joint is turned on its parent, on average.
std::vector<Matrix3d> mean_turns(const Motion& motion, const std::vector<int>& frames) {
  std::vector<Matrix3d> turns(motion.skeleton.joints.size(), Matrix3d::Zero());
  for (const int t : frames)
    for (int j = 0; j < motion.skeleton.joint_count(); ++j)
      turns[j] += local_rotation(motion.skeleton.joints[j],
                                 motion.channels.row(t).data() + motion.skeleton.first_channel(j));
  for (Matrix3d& turn : turns)
    turn = turn.isZero() ? Matrix3d::Identity().eval() : nearest_rotation(turn);
  return turns;
}

void set_position(const Joint& joint, const Vector3d& local, double* channels) {
  for (std::size_t k = 0; k < joint.channels.size(); ++k)
    if (!is_rotation(joint.channels[k])) channels[k] = local[axis_of(joint.channels[k])];
}

/// Writes one frame after the other: world orientations, and where one joint is to be.
class PoseWriter {
 public:
  /// @param local where each joint is on its parent  @param placed the joint that has a place
  PoseWriter(const Skeleton& skeleton, std::vector<Vector3d> local, int placed, double frame_time_s,
             int frames)
      : local_(std::move(local)),
        result_{skeleton, frame_time_s, MatrixD::Zero(frames, skeleton.channel_count())},
        placed_(placed),
        carrier_(placed) {
    // Whatever stands above it moves with nothing; the first that can move carries it.
    while (!moves(skeleton.joints[carrier_]) && skeleton.joints[carrier_].parent >= 0)
      carrier_ = skeleton.joints[carrier_].parent;
  }

  void write(int t, const std::vector<Matrix3d>& world_from_joint, const Vector3d& place) {
    const Skeleton& skeleton = result_.skeleton;
    double* row = result_.channels.row(t).data();
    const double* before = t > 0 ? result_.channels.row(t - 1).data() : nullptr;
    std::vector<Matrix3d> reached;
    int first = 0;
    for (int j = 0; j < skeleton.joint_count(); ++j) {
      const Joint& joint = skeleton.joints[j];
      const Matrix3d parent =
          joint.parent < 0 ? Matrix3d::Identity().eval() : reached[joint.parent];
      set_position(joint, local_[j], row + first);
      set_local_rotation(joint, parent.transpose() * world_from_joint[j],
                         before == nullptr ? nullptr : before + first, row + first);
      reached.emplace_back(parent * local_rotation(joint, row + first));
      first += static_cast<int>(joint.channels.size());
    }
    carry(t, place);
  }

  Motion take() { return std::move(result_); }

 private:
  void carry(int t, const Vector3d& place) {
    const Joint& joint = result_.skeleton.joints[carrier_];
    if (!moves(joint)) return;
    double* channels = result_.channels.row(t).data() + result_.skeleton.first_channel(carrier_);
    const WorldPose pose = forward_kinematics(result_.skeleton, result_.channels.row(t));
    const Matrix3d world_from_parent =
        joint.parent < 0 ? Matrix3d::Identity().eval() : pose.world_from_joint[joint.parent];
    const Vector3d shift = world_from_parent.transpose() * (place - pose.position[placed_]);
    set_position(joint, local_position(joint, channels) + shift, channels);
  }

  std::vector<Vector3d> local_;
  Motion result_;
  int placed_, carrier_;
};

}  // namespace

HumanoidRig::HumanoidRig(const Motion& motion)
    : HumanoidRig(motion, skeleton_roles(motion.skeleton)) {}

HumanoidRig::HumanoidRig(const Motion& motion, const SkeletonRoles& roles)
    : skeleton_(motion.skeleton), body_(canonical_humanoid()) {
  if (!roles.has(pelvis))
    throw InputError(
        "a skeleton without a known pelvis cannot take another one's motion; name its joints "
        "in a joint map");
  roles_ = with_lowest_spine(skeleton_, roles);
  const RigAxes axes = rig_axes(motion, roles_);
  axes_ = axes.by_role;
  add_chain(spine, chest, true);
  add_chain(neck, head, true);
  add_chain(left_wrist, left_hand, false);
  add_chain(right_wrist, right_hand, false);
  for (Chain& chain : chains_)
    if (axes.from_rest) chain.upper_from_lower.setIdentity();
  constexpr int kMostFrames = 40;
  local_ = mean_places(motion);
  const std::vector<int> frames = spread_frames(motion, axes.from_rest ? 0 : kMostFrames);
  parent_from_joint_ = mean_turns(motion, frames);
  std::vector<WorldPose> poses;
  poses.reserve(std::max<std::size_t>(1, frames.size()));
  for (const int t : frames) poses.push_back(forward_kinematics(skeleton_, motion.channels.row(t)));
  if (poses.empty()) poses.push_back(rest_pose(skeleton_, local_));
  measure(poses);
}

void HumanoidRig::add_chain(JointRole from, JointRole to, bool bends) {
  if (!roles_.has(from) || !roles_.has(to)) return;
  Chain chain{roles_.joint(from), roles_.joint(to), bends, {}, {}};
  chain.between = joints_between(skeleton_, chain.lower, chain.upper);
  chain.upper_from_lower =
      axes_[static_cast<std::size_t>(to)] * axes_[static_cast<std::size_t>(from)].transpose();
  if (!chain.between.empty()) chains_.push_back(std::move(chain));
}

const HumanoidRig::Chain* HumanoidRig::chain_above(int lower) const {
  const auto found = std::ranges::find(chains_, lower, &Chain::lower);
  return found == chains_.end() ? nullptr : &*found;
}

std::vector<Matrix3d> HumanoidRig::humanoid_turns(const WorldPose& pose) const {
  std::vector<Matrix3d> turns;
  for (int j = 0; j < body_.joint_count(); ++j) {
    const JointRole role = *humanoid_roles().role_of(j);
    const int joint = roles_.joint(role);
    if (joint < 0) {
      turns.push_back(turns[body_.joints[j].parent]);
      continue;
    }
    turns.emplace_back(pose.world_from_joint[joint] * axes_[static_cast<std::size_t>(role)]);
    const Chain* chain = chain_above(joint);
    if (chain == nullptr || !chain->bends) continue;
    const Vector3d chord = pose.position[chain->upper] - pose.position[chain->lower];
    const Vector3d bone = turns.back() * Vector3d::UnitY();  // of the trunk at rest
    if (chord.norm() > 1e-9)
      turns.back() = Eigen::Quaterniond::FromTwoVectors(bone, chord) * turns.back();
  }
  return turns;
}

void HumanoidRig::measure(const std::vector<WorldPose>& poses) {
  const double scale = body_height(skeleton_) / body_height(body_);
  for (Joint& joint : body_.joints) {
    joint.offset *= scale;
    for (Vector3d& site : joint.end_sites) site *= scale;
  }
  std::vector<Vector3d> sums(body_.joints.size(), Vector3d::Zero());
  for (const WorldPose& pose : poses) {
    const std::vector<Matrix3d> turns = humanoid_turns(pose);
    std::vector<Vector3d> places;
    for (int j = 0; j < body_.joint_count(); ++j) {
      const Joint& bone = body_.joints[j];
      const int joint = roles_.joint(*humanoid_roles().role_of(j));
      const Vector3d from = j == 0 ? Vector3d::Zero().eval() : places[bone.parent];
      const Matrix3d turn = j == 0 ? Matrix3d::Identity().eval() : turns[bone.parent];
      places.emplace_back(joint < 0 ? Vector3d(from + turn * bone.offset) : pose.position[joint]);
      sums[j] += turn.transpose() * (places.back() - from);
    }
  }
  for (int j = 1; j < body_.joint_count(); ++j)
    body_.joints[j].offset = sums[j] / static_cast<double>(poses.size());
  for (const Chain& chain : chains_) {
    if (!chain.bends) continue;
    double length = local_[chain.upper].norm();
    for (const int joint : chain.between) length += local_[joint].norm();
    const int upper = humanoid_roles().joint(*roles_.role_of(chain.upper));
    body_.joints[upper].offset = length * Vector3d::UnitY();
  }
}

Motion HumanoidRig::to_humanoid(const Motion& motion) const {
  std::vector<Vector3d> offsets;
  for (const Joint& joint : body_.joints) offsets.push_back(joint.offset);
  PoseWriter writer(body_, std::move(offsets), humanoid_roles().joint(pelvis), motion.frame_time_s,
                    motion.frames());
  for (int t = 0; t < motion.frames(); ++t) {
    const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(t));
    writer.write(t, humanoid_turns(pose), pose.position[roles_.joint(pelvis)]);
  }
  return writer.take();
}

void HumanoidRig::turn_chain(const Chain& chain, const Vector3d& chord,
                             std::vector<Matrix3d>& wanted) const {
  constexpr int kRounds = 5;  // each leaves about a tenth of the angle
  if (!chain.bends) {
    for (const int joint : chain.between)
      wanted[joint] = wanted[chain.upper] * chain.upper_from_lower;
    return;
  }
  const Eigen::Quaterniond upper((wanted[chain.upper] * chain.upper_from_lower).eval());
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::Quaterniond lower(wanted[chain.lower]);
    Vector3d reached = Vector3d::Zero();
    int at = chain.lower;
    for (std::size_t k = 0; k < chain.between.size(); ++k) {
      const int joint = chain.between[k];
      reached += wanted[at] * local_[joint];
      const double share =
          static_cast<double>(k + 1) / static_cast<double>(chain.between.size() + 1);
      wanted[joint] = lower.slerp(share, upper).toRotationMatrix();
      at = joint;
    }
    reached += wanted[at] * local_[chain.upper];
    if (!(reached.norm() > 1e-9 && chord.norm() > 1e-9)) return;
    wanted[chain.lower] = Eigen::Quaterniond::FromTwoVectors(reached, chord) * wanted[chain.lower];
  }
}

std::vector<Matrix3d> HumanoidRig::wanted_turns(const WorldPose& humanoid) const {
  std::vector<Matrix3d> wanted(skeleton_.joints.size(), Matrix3d::Zero());
  for (int j = 0; j < skeleton_.joint_count(); ++j)
    if (const auto role = roles_.role_of(j))
      wanted[j] = humanoid.world_from_joint[humanoid_roles().joint(*role)] *
                  axes_[static_cast<std::size_t>(*role)].transpose();
  for (const Chain& chain : chains_) {
    const auto place = [&](int joint) {
      return humanoid.position[humanoid_roles().joint(*roles_.role_of(joint))];
    };
    turn_chain(chain, place(chain.upper) - place(chain.lower), wanted);
  }
  const int root = roles_.joint(pelvis);
  for (int j = 0; j < skeleton_.joint_count(); ++j) {
    const int parent = skeleton_.joints[j].parent;
    if (!wanted[j].isZero()) continue;
    const Matrix3d above = parent < 0 ? Matrix3d::Identity().eval() : wanted[parent];
    wanted[j] = j < root ? above : (above * parent_from_joint_[j]).eval();
  }
  return wanted;
}

Motion HumanoidRig::from_humanoid(const Motion& humanoid) const {
  const int placed = roles_.joint(pelvis), there = humanoid_roles().joint(pelvis);
  PoseWriter writer(skeleton_, local_, placed, humanoid.frame_time_s, humanoid.frames());
  for (int t = 0; t < humanoid.frames(); ++t) {
    const WorldPose pose = forward_kinematics(humanoid.skeleton, humanoid.channels.row(t));
    writer.write(t, wanted_turns(pose), pose.position[there]);
  }
  return writer.take();
}

std::vector<int> HumanoidRig::kept_joints() const {
  std::vector<int> joints;
  for (int j = 0; j < skeleton_.joint_count(); ++j)
    if (roles_.role_of(j) || std::ranges::any_of(chains_, [&](const Chain& chain) {
          return std::ranges::count(chain.between, j) > 0;
        }))
      joints.push_back(j);
  return joints;
}

HumanoidRig rig_of_person(const Motion& motion, const JointMap& joint_map) {
  JointMap own = joint_map;
  std::erase_if(own, [&](const auto& given) { return motion.skeleton.find(given.second) < 0; });
  HumanoidRig rig(motion, skeleton_roles(motion.skeleton, own));
  std::vector<std::string_view> lacking;
  for (const auto& limb : kPersonsLimbs)
    for (const JointRole left : limb)
      for (const JointRole role : {left, other_side(left)})
        if (!rig.roles().has(role)) lacking.push_back(name_of(role));
  if (lacks_head(rig.roles())) lacking.push_back(kNeckOrHead);
  if (!lacking.empty())
    throw InputError(fmt::format(
        "no joint is known to be {}: this cannot be brought onto the humanoid; name its joints in "
        "a joint map, or leave the file out",
        fmt::join(lacking, ", ")));
  return rig;
}

std::vector<JointRole> lost_roles(const SkeletonRoles& roles) {
  std::vector<JointRole> lost;
  std::vector<std::string_view> whole;
  for (const auto& limb : kPersonsLimbs)
    for (const bool right : {false, true}) {
      std::vector<JointRole> unknown;
      for (const JointRole left : limb)
        if (const JointRole role = right ? other_side(left) : left; !roles.has(role))
          unknown.push_back(role);
      if (unknown.size() == limb.size())
        for (const JointRole role : unknown) whole.push_back(name_of(role));
      lost.insert(lost.end(), unknown.begin(), unknown.end());
    }
  if (lacks_head(roles)) whole.push_back(kNeckOrHead);
  if (!whole.empty())
    throw InputError(fmt::format(
        "no joint is known to be {}: a person's motion cannot be put on this skeleton; name its "
        "joints in a joint map",
        fmt::join(whole, ", ")));
  if (!roles.has(spine) && !roles.has(chest)) lost.push_back(spine);
  return lost;
}

}  // namespace mcdbn
