#include "motion/mirror.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "motion/joint_sides.hpp"

namespace mcdbn {
namespace {

/// Bones of both sides may differ by this share of their length, as measured bodies do.
constexpr double kMostOfBone = 0.25;

using Axes = Eigen::Vector3d;  ///< the diagonal of a reflection along one axis
const Axes kWorldMirror(-1, 1, 1);

struct Reflection {
  Axes axes = kWorldMirror;
  double distance = 0;  ///< how far the reflected bones end from those of the other side
};

/// The reflection of a joint's own axes that brings its bones onto the other side's; `otherwise`
/// unless another one is clearly nearer: a neck that leans slightly must not end up turned half
/// round its length.
Reflection joint_reflection(const Skeleton& skeleton, const std::vector<int>& opposite, int joint,
                            const Axes& otherwise) {
  Reflection best{otherwise, std::numeric_limits<double>::infinity()};
  for (const Axes& axes : {otherwise, Axes(-1, 1, 1), Axes(1, -1, 1), Axes(1, 1, -1)}) {
    double distance = 0, length = 0;
    for (int child = 0; child < skeleton.joint_count(); ++child) {
      const Eigen::Vector3d& bone = skeleton.joints[child].offset;
      if (skeleton.joints[child].parent != joint) continue;
      distance += (axes.cwiseProduct(bone) - skeleton.joints[opposite[child]].offset).norm();
      length += bone.norm();
    }
    if (distance <= best.distance - kMostOfBone * length && distance < best.distance)
      best = {axes, distance};
  }
  return best;
}

/// Empty if the sides are built too differently.
std::vector<Axes> reflections(const Skeleton& skeleton, const std::vector<int>& opposite) {
  std::vector<Axes> axes;
  double distance = 0, length = 0;
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const int parent = skeleton.joints[j].parent;
    const Reflection own =
        joint_reflection(skeleton, opposite, j, parent < 0 ? kWorldMirror : axes[parent]);
    axes.push_back(own.axes);
    distance += own.distance;
    if (parent >= 0) length += skeleton.joints[j].offset.norm();
  }
  if (distance > kMostOfBone * length) return {};
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
  const std::vector<Axes> axes = reflections(skeleton, opposite);
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
