#include "mcdbn/camera/seen_frame.hpp"

#include <limits>

namespace mcdbn {

SeenFrame SeenFrame::unseen(Eigen::Index joints) {
  const RowVectorD nowhere = RowVectorD::Constant(joints, std::numeric_limits<double>::quiet_NaN());
  return {nowhere, nowhere, RowVectorD::Zero(joints)};
}

}  // namespace mcdbn
