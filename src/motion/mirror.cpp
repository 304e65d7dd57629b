#include "motion/mirror.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "motion/body_root.hpp"
#include "motion/joint_sides.hpp"

namespace mcdbn {
namespace {

/// Bones of both sides may differ by this share of their length, as measured bodies do.
constexpr double kMostOfBone = 0.25;
/// A joint takes its parent's reflection unless another one is more alike by this much
/// (mirror_likeness, of at most 4). In Bandai's clips a spine that its parent's turns half round
/// gains more than 3.3 by another one, the arms of a person who waves with one hand less than 2.
constexpr double kClearlyMoreAlike = 2.5;

using Axes = Eigen::Vector3d;  ///< the diagonal of a reflection of a joint's own axes
const Axes kWorldMirror(-1, 1, 1);
/// Along one axis, or along all where the frames of one side point the other way (Bandai's limbs).
const std::array<Axes, 4> kReflections{kWorldMirror, Axes(1, -1, 1), Axes(1, 1, -1),
                                       Axes(-1, -1, -1)};

/// How far each of kReflections leaves a joint's bones from those of the other side.
struct BoneFit {
  std::array<double, kReflections.size()> distance{};
  double length = 0;  ///< of the bones together

  /// Whether no other reflection is clearly nearer: a neck that leans slightly must not end up
  /// turned half round its length. Bones along one axis allow two of them, no bone allows all.
  bool allows(std::size_t reflection) const {
    return distance[reflection] <= *std::ranges::min_element(distance) + kMostOfBone * length;
  }
};

/// @param root where the body begins: what ends there or above is no bone
BoneFit bone_fit(const Skeleton& skeleton, const std::vector<int>& opposite, int root, int joint) {
  BoneFit fit;
  for (int child = root + 1; child < skeleton.joint_count(); ++child) {
    if (skeleton.joints[child].parent != joint) continue;
    const Eigen::Vector3d& bone = skeleton.joints[child].offset;
    const Eigen::Vector3d& there = skeleton.joints[opposite[child]].offset;
    for (std::size_t r = 0; r < kReflections.size(); ++r)
      fit.distance[r] += (kReflections[r].cwiseProduct(bone) - there).norm();
    fit.length += bone.norm();
  }
  return fit;
}

/// The reflection that fits all bones: the rest pose is its own mirror image.
std::optional<std::size_t> reflection_of_all(const std::vector<BoneFit>& fits) {
  for (std::size_t r = 0; r < kReflections.size(); ++r)
    if (std::ranges::all_of(fits, [&](const BoneFit& fit) { return fit.allows(r); })) return r;
  return std::nullopt;
}

/// How alike a joint's rotations and their mirror images are: for any reflection its product with
/// the result is the mean trace of the rotation between the two, 3 if they are the same, -1 if they
/// are half a turn apart.
/// @param there the joint on the other side  @param outer the reflection of the parent's axes
Eigen::Vector3d mirror_likeness(const Motion& motion, int joint, int there, const Axes& outer) {
  const Skeleton& skeleton = motion.skeleton;
  const int first = skeleton.first_channel(joint), first_there = skeleton.first_channel(there);
  Eigen::Vector3d sum(0, 0, 0);
  for (int t = 0; t < motion.frames(); ++t) {
    const double* channels = motion.channels.row(t).data();
    const Eigen::Matrix3d own = local_rotation(skeleton.joints[joint], channels + first);
    const Eigen::Matrix3d other = local_rotation(skeleton.joints[there], channels + first_there);
    sum += other.cwiseProduct(outer.asDiagonal() * own).colwise().sum().transpose();
  }
  return sum / std::max(1, motion.frames());
}

/// The reflection that fits the bones and makes the mirror image most like the motion itself: the
/// parent's, unless another one is clearly better.
std::size_t joint_reflection(const BoneFit& fit, const Eigen::Vector3d& likeness,
                             std::size_t of_parent) {
  const auto alike = [&](std::size_t r) { return kReflections[r].dot(likeness); };
  std::size_t best = of_parent;
  for (std::size_t r = 0; r < kReflections.size(); ++r)
    if (fit.allows(r) && (!fit.allows(best) || alike(r) > alike(best))) best = r;
  const bool keeps = fit.allows(of_parent) && alike(best) - alike(of_parent) < kClearlyMoreAlike;
  return keeps ? of_parent : best;
}

/// Reflection of each joint. Where one fits all bones it is that one, whatever the motion. Empty if
/// the sides are built too differently.
std::vector<Axes> reflections(const Motion& motion, const std::vector<int>& opposite) {
  const Skeleton& skeleton = motion.skeleton;
  const int root = body_root(skeleton);
  std::vector<BoneFit> fits;
  fits.reserve(skeleton.joints.size());
  for (int j = 0; j < skeleton.joint_count(); ++j)
    fits.push_back(bone_fit(skeleton, opposite, root, j));
  const std::optional<std::size_t> of_all = reflection_of_all(fits);
  std::vector<std::size_t> chosen(fits.size(), 0);  // above the body as the world
  double distance = 0, length = 0;
  for (int j = root; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.joints[j].parent;
    const std::size_t outer = parent < 0 ? 0 : chosen[parent];
    if (of_all) {
      chosen[j] = *of_all;
    } else if (opposite[j] < j) {
      chosen[j] = chosen[opposite[j]];  // mirrored twice, a motion is as it was
    } else {
      // Which way the body faces shows nothing of the root's axes.
      Eigen::Vector3d likeness(0, 0, 0);
      if (j > root) likeness = mirror_likeness(motion, j, opposite[j], kReflections[outer]);
      chosen[j] = joint_reflection(fits[j], likeness, outer);
    }
    distance += fits[j].distance[chosen[j]];
    if (j > root) length += skeleton.joints[j].offset.norm();
  }
  if (distance > kMostOfBone * length) return {};
  std::vector<Axes> axes;
  axes.reserve(chosen.size());
  for (const std::size_t reflection : chosen) axes.push_back(kReflections[reflection]);
  return axes;
}

/// By the marks that other_side knows. Empty if there are none, or parents of a pair are none.
std::vector<int> opposite_by_marks(const Skeleton& skeleton) {
  std::vector<int> opposite;
  bool has_sides = false;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int found = skeleton.find(other_side(skeleton.joints[j].name));
    has_sides |= found >= 0;
    opposite.push_back(found >= 0 ? found : j);
  }
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.joints[j].parent;
    const int parent_there = skeleton.joints[opposite[j]].parent;
    if (opposite[opposite[j]] != j || (parent < 0) != (parent_there < 0) ||
        (parent >= 0 && opposite[parent] != parent_there))
      return {};
  }
  return has_sides ? opposite : std::vector<int>{};
}

/// By single letters too (possible_other_sides): joints are a pair if their parents are the same or
/// a pair. Empty likewise.
std::vector<int> opposite_by_letters(const Skeleton& skeleton) {
  std::vector<int> opposite(skeleton.joints.size(), -1);
  bool has_sides = false;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const Joint& joint = skeleton.joints[j];
    if (opposite[j] >= 0) continue;
    opposite[j] = j;
    if (joint.parent < 0) continue;
    std::vector<std::string> names{other_side(joint.name)};
    for (std::string& name : possible_other_sides(joint.name)) names.push_back(std::move(name));
    for (const std::string& name : names) {
      const int there = skeleton.find(name);
      if (there <= j || opposite[there] >= 0) continue;
      if (skeleton.joints[there].parent != opposite[joint.parent]) continue;
      opposite[j] = there;
      opposite[there] = j;
      has_sides = true;
      break;
    }
    if (opposite[j] == j && opposite[joint.parent] != joint.parent) return {};
  }
  return has_sides ? opposite : std::vector<int>{};
}

}  // namespace

std::vector<int> opposite_joints(const Skeleton& skeleton) {
  std::vector<int> opposite = opposite_by_marks(skeleton);
  return opposite.empty() ? opposite_by_letters(skeleton) : opposite;
}

std::optional<Motion> mirrored(const Motion& motion) {
  const Skeleton& skeleton = motion.skeleton;
  const std::vector<int> opposite = opposite_joints(skeleton);
  if (opposite.empty()) return std::nullopt;
  const std::vector<Axes> axes = reflections(motion, opposite);
  if (axes.empty()) return std::nullopt;
  Motion result = motion;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const Joint &joint = skeleton.joints[j], &there = skeleton.joints[opposite[j]];
    const Axes& outer = joint.parent < 0 ? kWorldMirror : axes[joint.parent];
    const int own = skeleton.first_channel(j), other = skeleton.first_channel(opposite[j]);
    for (int t = 0; t < motion.frames(); ++t) {
      const double* from = motion.channels.row(t).data() + other;
      double* to = result.channels.row(t).data() + own;
      const Eigen::Matrix3d rotation =
          outer.asDiagonal() * local_rotation(there, from) * axes[j].asDiagonal();
      set_local_rotation(joint, rotation, t > 0 ? result.channels.row(t - 1).data() + own : nullptr,
                         to);
      for (std::size_t k = 0; k < joint.channels.size(); ++k) {
        if (is_rotation(joint.channels[k])) continue;
        const auto same =
            std::find(there.channels.begin(), there.channels.end(), joint.channels[k]);
        if (same == there.channels.end()) continue;
        to[k] = outer[axis_of(joint.channels[k])] * from[same - there.channels.begin()];
      }
    }
  }
  return result;
}

}  // namespace mcdbn
