#include "fitting/terms/joint_place.hpp"

#include <cmath>
#include <utility>

#include "fitting/rotation.hpp"

namespace mcdbn {
namespace {

Eigen::Map<const Eigen::Vector3d> vector_at(const double* block) {
  return Eigen::Map<const Eigen::Vector3d>(block);
}

/// Ceres keeps Jacobians row by row; Eigen calls one of a single row so only as a row vector.
template <int kRows>
using BlockJacobian = Eigen::Map<Eigen::Matrix<double, kRows, 3, Eigen::RowMajor>>;

}  // namespace

JointPlace::JointPlace(std::vector<Lever> levers, Eigen::Vector3d root, bool body_unknown)
    : levers_(std::move(levers)), root_(std::move(root)), body_unknown_(body_unknown) {}

std::vector<int> JointPlace::block_sizes() const {
  std::vector<int> sizes(levers_.size() + 1, 3);
  if (body_unknown_) sizes.insert(sizes.end(), levers_.size(), 1);
  return sizes;
}

int JointPlace::blocks() const {
  return static_cast<int>(levers_.size() * (body_unknown_ ? 2 : 1) + 1);
}

Eigen::Vector3d JointPlace::bone(double const* const* unknowns, std::size_t lever) const {
  const double length = body_unknown_ ? std::exp(unknowns[levers_.size() + 1 + lever][0]) : 1;
  return length * (rotation_of(vector_at(unknowns[lever])) * levers_[lever].bone);
}

Eigen::Vector3d JointPlace::at(double const* const* unknowns) const {
  Eigen::Vector3d place = root_ + vector_at(unknowns[levers_.size()]);
  for (std::size_t lever = 0; lever < levers_.size(); ++lever) place += bone(unknowns, lever);
  return place;
}

template <int kRows>
void JointPlace::differentiate(const Eigen::Matrix<double, kRows, 3>& of_place,
                               double const* const* unknowns, double** jacobians) const {
  const std::size_t count = levers_.size();
  if (jacobians[count]) BlockJacobian<kRows>{jacobians[count]} = of_place;
  for (std::size_t lever = 0; lever < count; ++lever) {
    double* const of_turn = jacobians[lever];
    double* const of_length = body_unknown_ ? jacobians[count + 1 + lever] : nullptr;
    if (!of_turn && !of_length) continue;
    const Eigen::Vector3d vector = bone(unknowns, lever);
    if (of_turn)
      BlockJacobian<kRows>{of_turn} =
          -of_place * cross_matrix(vector) * left_jacobian(vector_at(unknowns[lever]));
    if (of_length) Eigen::Map<Eigen::Matrix<double, kRows, 1>>{of_length} = of_place * vector;
  }
}

template void JointPlace::differentiate<1>(const Eigen::Matrix<double, 1, 3>&, double const* const*,
                                           double**) const;
template void JointPlace::differentiate<2>(const Eigen::Matrix<double, 2, 3>&, double const* const*,
                                           double**) const;
template void JointPlace::differentiate<3>(const Eigen::Matrix<double, 3, 3>&, double const* const*,
                                           double**) const;

}  // namespace mcdbn
