#include "evaluation/relative_to_root.hpp"
#include "mcdbn/evaluation/joint_error.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {

MatrixD world_positions_mm(const Motion& motion) {
  return joint_positions(motion) * (1000.0 / file_units_per_metre(motion.skeleton));
}

MatrixD root_relative_positions_mm(const Motion& motion, int root_joint) {
  return relative_to_root(world_positions_mm(motion), root_joint);
}

}  // namespace mcdbn
