#include "mcdbn/camera/track_frame.hpp"

#include <limits>

namespace mcdbn {

TrackFrame TrackFrame::unseen(Eigen::Index joints) {
  const RowVectorD nowhere = RowVectorD::Constant(joints, std::numeric_limits<double>::quiet_NaN());
  return {nowhere, nowhere, RowVectorD::Zero(joints)};
}

}  // namespace mcdbn
