#include "fitting/tracked_joints.hpp"

namespace mcdbn {

std::vector<std::string> tracked_joints(const TrackFeatures& features) {
  std::vector<std::string> names = features.joint_names();
  names.push_back(features.root_name());
  return names;
}

MatrixD positions_about(const std::string& root, const std::vector<std::string>& names,
                        const Motion& motion) {
  const MatrixD all = joint_positions(motion);
  const MatrixD zero = all.middleCols(3 * motion.skeleton.find(root), 3);
  MatrixD positions(all.rows(), 3 * std::ssize(names));
  for (std::size_t i = 0; i < names.size(); ++i)
    positions.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
        all.middleCols(3 * motion.skeleton.find(names[i]), 3) - zero;
  return positions;
}

}  // namespace mcdbn
