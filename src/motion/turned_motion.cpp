#include "motion/turned_motion.hpp"

#include <algorithm>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

Motion turned_motion(Motion motion, const Eigen::Matrix3d& turn) {
  const Joint& root = motion.skeleton.joints.at(0);
  if (std::ranges::count_if(root.channels, is_rotation) < 3)
    throw ShapeError("a motion whose first joint does not turn cannot be turned");
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    double* channels = motion.channels.row(t).data();
    const Eigen::Vector3d position = turn * local_position(root, channels);
    const Eigen::Matrix3d rotation = turn * local_rotation(root, channels);
    set_local_rotation(root, rotation, t > 0 ? motion.channels.row(t - 1).data() : nullptr,
                       channels);
    for (std::size_t k = 0; k < root.channels.size(); ++k)
      if (!is_rotation(root.channels[k])) channels[k] = position[axis_of(root.channels[k])];
  }
  return motion;
}

}  // namespace mcdbn
