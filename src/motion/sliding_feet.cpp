#include "motion/sliding_feet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/planted_foot.hpp"
#include "motion/body_root.hpp"
#include "motion/body_size.hpp"
#include "motion/foot_joints.hpp"

namespace mcdbn {
namespace {

/// Times the root's speed: legs that hang still are as fast as the body.
constexpr double kFasterThanRoot = 1.25;

}  // namespace

double share_of_sliding(const Motion& motion, const std::vector<bool>& frames) {
  if (std::ssize(frames) != motion.frames())
    throw ShapeError(fmt::format("{} frames to look at, of {}", frames.size(), motion.frames()));
  const std::vector<int> feet = foot_joints(motion.skeleton);
  if (feet.empty()) return 0;
  const MatrixD positions = joint_positions(motion);
  const int root = body_root(motion.skeleton);
  const double m_s_per_step = motion.fps() / file_units_per_metre(motion.skeleton);
  int steps = 0, sliding = 0;
  for (Eigen::Index frame = 1; frame < motion.frames(); ++frame) {
    if (!frames[static_cast<std::size_t>(frame)]) continue;
    const auto along_ground_m_s = [&](int joint) {
      const Eigen::RowVector3d moved = step_to(positions, joint, frame).moved;
      return std::hypot(moved.x(), moved.z()) * m_s_per_step;
    };
    const double slow_m_s =
        std::max(kPlantedInAnswer.below_m_s, kFasterThanRoot * along_ground_m_s(root));
    ++steps;
    sliding +=
        std::ranges::all_of(feet, [&](int foot) { return along_ground_m_s(foot) > slow_m_s; }) ? 1
                                                                                               : 0;
  }
  return steps == 0 ? 0 : static_cast<double>(sliding) / steps;
}

}  // namespace mcdbn
