#include "evaluation/bone_length.hpp"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

double bone_length_spread_mm(const MatrixD& positions, const Skeleton& skeleton, int root) {
  if (positions.cols() != 3 * skeleton.joint_count() || positions.rows() == 0)
    throw ShapeError(fmt::format("positions of {}x{} are none of {} joints", positions.rows(),
                                 positions.cols(), skeleton.joint_count()));
  std::vector<bool> is_bone(skeleton.joints.size(), true);  // what ends at the joint
  for (int joint = root; joint >= 0;
       joint = skeleton.joints[static_cast<std::size_t>(joint)].parent)
    is_bone[static_cast<std::size_t>(joint)] = false;
  double sum = 0;
  int bones = 0;
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    const int parent = skeleton.joints[static_cast<std::size_t>(joint)].parent;
    if (parent < 0 || !is_bone[static_cast<std::size_t>(joint)]) continue;
    const Eigen::ArrayXd length =
        (positions.middleCols<3>(3 * joint) - positions.middleCols<3>(3 * parent)).rowwise().norm();
    sum += std::sqrt((length - length.mean()).square().mean());
    ++bones;
  }
  return bones ? sum / bones : 0;
}

}  // namespace mcdbn
