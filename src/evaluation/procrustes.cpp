#include "evaluation/procrustes.hpp"

#include <Eigen/Geometry>

#include "motion/nearest_rotation.hpp"

namespace mcdbn {

RowVectorD procrustes_residual(const Eigen::Ref<const RowVectorD>& truth,
                               const Eigen::Ref<const RowVectorD>& regenerated) {
  using Points = Eigen::Map<const Eigen::Matrix3Xd>;
  const Points target(truth.data(), 3, truth.size() / 3);
  const Points source(regenerated.data(), 3, regenerated.size() / 3);
  const Eigen::Vector3d centre = source.rowwise().mean();
  const bool one_point = (source.colwise() - centre).squaredNorm() == 0;
  // A body that is a single point has no orientation and no size: only its position can be fitted.
  const Eigen::Matrix4d fit =
      one_point ? Eigen::Affine3d(Eigen::Translation3d(target.rowwise().mean() - centre)).matrix()
                : Eigen::Matrix4d(Eigen::umeyama(source, target, true));
  const Eigen::Matrix3Xd aligned =
      (fit.topLeftCorner<3, 3>() * source).colwise() + fit.topRightCorner<3, 1>();
  const Eigen::Matrix3Xd residual = aligned - target;
  return Eigen::Map<const RowVectorD>(residual.data(), residual.size());
}

Eigen::Matrix3d nearest_rotation(const MatrixD& target, const MatrixD& source) {
  using Points = Eigen::Map<const Eigen::Matrix3Xd>;
  const Points to(target.data(), 3, target.size() / 3), from(source.data(), 3, source.size() / 3);
  return nearest_rotation(to * from.transpose());
}

}  // namespace mcdbn
