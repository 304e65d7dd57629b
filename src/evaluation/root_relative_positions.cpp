#include "mcdbn/evaluation/joint_error.hpp"
#include "mcdbn/motion/features.hpp"
#include "relative_to_root.hpp"

namespace mcdbn {

MatrixD root_relative_positions_mm(const Motion& motion, int root_joint) {
  const double mm_per_file_unit = 1000.0 / file_units_per_metre(motion.skeleton);
  return relative_to_root(joint_positions(motion), root_joint) * mm_per_file_unit;
}

}  // namespace mcdbn
