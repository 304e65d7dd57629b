#pragma once

#include <Eigen/Core>
#include <vector>

#include "fitting/lever.hpp"

namespace mcdbn {

/// Where a joint is in one frame, as a function of the unknowns that move it:
///   x = root + shift + Σ exp(length_i) · R(turn_i) · bone_i     metres of a 1.7 m body, camera
///   axes
/// Its parameter blocks, in this order: by lever the turn (3, radians); the root's shift (3, m);
/// and, if the body is unknown, by lever the logarithm of its length over the skeleton's (1).
class JointPlace {
 public:
  JointPlace(std::vector<Lever> levers, Eigen::Vector3d root, bool body_unknown);

  std::vector<int> block_sizes() const;
  int blocks() const;
  int levers() const { return static_cast<int>(levers_.size()); }

  /// @param unknowns by block
  Eigen::Vector3d at(double const* const* unknowns) const;

  /// Writes of_place · d place / d block for every block whose pointer in `jacobians` is not null.
  /// @param of_place [rows x 3]
  template <int kRows>
  void differentiate(const Eigen::Matrix<double, kRows, 3>& of_place, double const* const* unknowns,
                     double** jacobians) const;

 private:
  Eigen::Vector3d bone(double const* const* unknowns, std::size_t lever) const;

  std::vector<Lever> levers_;
  Eigen::Vector3d root_;
  bool body_unknown_;
};

extern template void JointPlace::differentiate<1>(const Eigen::Matrix<double, 1, 3>&,
                                                  double const* const*, double**) const;
extern template void JointPlace::differentiate<2>(const Eigen::Matrix<double, 2, 3>&,
                                                  double const* const*, double**) const;
extern template void JointPlace::differentiate<3>(const Eigen::Matrix<double, 3, 3>&,
                                                  double const* const*, double**) const;

}  // namespace mcdbn
