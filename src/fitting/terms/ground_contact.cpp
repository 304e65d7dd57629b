#include "fitting/terms/ground_contact.hpp"

#include <utility>

#include "fitting/rotation.hpp"

namespace mcdbn {

GroundContact::GroundContact(JointPlace place, Eigen::Vector3d up, double deviation_m,
                             bool camera_unknown)
    : place_(std::move(place)),
      up_(std::move(up)),
      deviation_m_(deviation_m),
      camera_unknown_(camera_unknown) {
  set_num_residuals(1);
  std::vector<int32_t>& sizes = *mutable_parameter_block_sizes();
  sizes = place_.block_sizes();
  sizes.push_back(1);
  if (camera_unknown_) sizes.push_back(3);
}

bool GroundContact::Evaluate(double const* const* unknowns, double* residuals,
                             double** jacobians) const {
  const int height = place_.blocks(), leans = height + 1;
  Eigen::Vector3d lean(0, 0, 0);
  if (camera_unknown_) lean = Eigen::Map<const Eigen::Vector3d>(unknowns[leans]);
  const Eigen::Vector3d up = rotation_of(lean) * up_, x = place_.at(unknowns);
  residuals[0] = (up.dot(x) - unknowns[height][0]) / deviation_m_;
  if (!jacobians) return true;
  const Eigen::Matrix<double, 1, 3> of_place = up.transpose() / deviation_m_;
  place_.differentiate(of_place, unknowns, jacobians);
  if (jacobians[height]) jacobians[height][0] = -1 / deviation_m_;
  if (camera_unknown_ && jacobians[leans])
    Eigen::Map<Eigen::RowVector3d>{jacobians[leans]} =
        -x.transpose() * cross_matrix(up) * left_jacobian(lean) / deviation_m_;
  return true;
}

}  // namespace mcdbn
