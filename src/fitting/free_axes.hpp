#pragma once

#include <ceres/manifold.h>

#include <Eigen/Core>

namespace mcdbn {

/// A vector of three numbers that moves along some directions only.
class FreeAxes : public ceres::Manifold {
 public:
  /// @param axes [3 x 1 or 2] orthonormal columns
  explicit FreeAxes(Eigen::Matrix3Xd axes) : axes_(std::move(axes)) {}

  int AmbientSize() const override { return 3; }
  int TangentSize() const override { return static_cast<int>(axes_.cols()); }

  bool Plus(const double* x, const double* along, double* moved) const override {
    Eigen::Map<Eigen::Vector3d>{moved} =
        Eigen::Map<const Eigen::Vector3d>(x) +
        axes_ * Eigen::Map<const Eigen::VectorXd>(along, axes_.cols());
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<RowMajor>(jacobian, 3, axes_.cols()) = axes_;
    return true;
  }
  bool Minus(const double* y, const double* x, double* along) const override {
    Eigen::Map<Eigen::VectorXd>(along, axes_.cols()) =
        axes_.transpose() *
        (Eigen::Map<const Eigen::Vector3d>(y) - Eigen::Map<const Eigen::Vector3d>(x));
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<RowMajor>(jacobian, axes_.cols(), 3) = axes_.transpose();
    return true;
  }

 private:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::Matrix3Xd axes_;
};

}  // namespace mcdbn
