// The loss on poses where the network is in doubt about an axis, and answers a short one.

#include <doctest/doctest.h>

#include <algorithm>

#include "base/capture_bound.hpp"
#include "device/every_device.hpp"
#include "features/pose_bones.hpp"
#include "features/small_figure.hpp"
#include "motion_model/pose_loss.hpp"
#include "reference/error_bounds.hpp"
#include "reference/finite_difference.hpp"

namespace short_axes_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr SequenceWindows kWindows{1, 2, 0, 0};
constexpr double kShort = 0.5;
const PoseLossWeights kPositions{0.0, 1.0, 0.0, 0.0};

/// Lengthened to one, unless it is short.
Eigen::Vector3d axis_of(const Eigen::Vector3d& vector) {
  return vector / std::max(vector.norm(), kShort);
}

/// Of the bones' ends, by Gram-Schmidt with such axes. @param raw features, [1 x dimension]
Eigen::VectorXd places(const SmallFigure& figure, const RowVectorD& raw) {
  const auto bones = pose_bones(figure.modalities().pose_features);
  Eigen::VectorXd ends(3 * std::ssize(bones));
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const int first = figure.modalities().pose_features.leading_axis(bones[i].block);
    const Eigen::Vector3d a = raw.segment<3>(6 * bones[i].block + 3 * first),
                          b = raw.segment<3>(6 * bones[i].block + 3 * (1 - first));
    Eigen::Matrix3d axes;
    axes.col(first) = axis_of(a);
    axes.col(1 - first) = axis_of(b - axes.col(first).dot(b) * axes.col(first));
    axes.col(2) = axes.col(0).cross(axes.col(1));
    Eigen::Vector3d end = axes * bones[i].lever_m;
    if (bones[i].parent >= 0) end += ends.segment<3>(3 * bones[i].parent);
    ends.segment<3>(3 * static_cast<Eigen::Index>(i)) = end;
  }
  return ends;
}

/// Every feature is learnt, so scaling is one to one.
RowVectorD raw_of(const SmallFigure& figure, const RowVectorD& standardized) {
  const Standardizer& scale = figure.modalities().pose_scale;
  return scale.mean() + standardized.cwiseProduct(scale.deviation());
}

/// Features of two frames; blocks' axes are `x_length` and `y_length` times what they would be.
MatrixF features(const SmallFigure& figure, double x_length, double y_length) {
  const Standardizer& scale = figure.modalities().pose_scale;
  MatrixF standardized = random_matrix(kWindows.rows(), figure.dimension(), 71, 0.8F);
  for (Eigen::Index t = 0; t < standardized.rows(); ++t) {
    RowVectorD raw = raw_of(figure, standardized.row(t).cast<double>());
    for (Eigen::Index axis = 0; axis + 3 <= raw.size() - 4; axis += 3)
      raw.segment<3>(axis) *= axis % 6 == 0 ? x_length : y_length;
    standardized.row(t) = (raw - scale.mean()).cwiseQuotient(scale.deviation()).cast<float>();
  }
  return standardized;
}

}  // namespace

TEST_CASE(
    "pose loss: an axis that is short is not lengthened to one; the derivative is that of it") {
  const SmallFigure figure;
  REQUIRE(figure.modalities().pose_scale.kept_columns().size() == figure.dimension());
  const MatrixF target = random_matrix(kWindows.rows(), figure.dimension(), 72, 0.8F);
  const auto bones = std::ssize(pose_bones(figure.modalities().pose_features));
  for (const auto& [x, y] : {std::pair{1.0, 1.0}, {0.3, 1.0}, {1.0, 0.3}, {0.3, 0.3}}) {
    CAPTURE_BOUND(x);
    CAPTURE_BOUND(y);
    const MatrixF predicted = features(figure, x, y);
    const auto loss = [&](const Eigen::VectorXd& flat) {
      const Eigen::Map<const MatrixD> all(flat.data(), predicted.rows(), predicted.cols());
      double sum = 0;
      for (Eigen::Index t = 0; t < all.rows(); ++t)
        sum += (places(figure, raw_of(figure, all.row(t))) -
                places(figure, raw_of(figure, target.row(t).cast<double>())))
                   .squaredNorm();
      return sum / static_cast<double>(3 * bones * all.rows()) /
             (PoseLoss::kPosition_m * PoseLoss::kPosition_m);
    };
    const MatrixD here = predicted.cast<double>();
    const Eigen::VectorXd flat = Eigen::Map<const Eigen::VectorXd>(here.data(), here.size()),
                          slope = reference::finite_difference(loss, flat);
    on_every_device([&](Device& device) {
      PoseLoss judge(device, figure.modalities(), kWindows, kPositions);
      Matrix error(device, predicted.rows(), predicted.cols());
      judge.differentiate(Matrix::from_host(device, predicted), Matrix::from_host(device, target),
                          error);
      CHECK(judge.read_and_reset() == doctest::Approx(loss(flat)).epsilon(1e-5));
      const MatrixD found = error.to_host().cast<double>();
      const Eigen::Map<const MatrixD> want(slope.data(), here.rows(), here.cols());
      // A few hundred sums and products of floats for each number, none much larger than the last.
      CHECK((found - want).cwiseAbs().maxCoeff() <= 1000 * 0x1p-24 * want.cwiseAbs().maxCoeff());
    });
  }
}

TEST_CASE("pose loss: an axis of no length at all has a derivative, and one that leads on") {
  const SmallFigure figure;
  const MatrixF predicted = features(figure, 0, 0),
                target = random_matrix(kWindows.rows(), figure.dimension(), 72, 0.8F);
  on_every_device([&](Device& device) {
    PoseLoss judge(device, figure.modalities(), kWindows, kPositions);
    Matrix error = Matrix::from_host(device, predicted);
    judge.differentiate(Matrix::from_host(device, predicted), Matrix::from_host(device, target),
                        error);
    const double at_first = judge.read_and_reset();
    const MatrixF slope = error.to_host();
    CHECK(slope.allFinite());
    const MatrixF further = predicted - 0.01F / slope.cwiseAbs().maxCoeff() * slope;
    judge.differentiate(Matrix::from_host(device, further), Matrix::from_host(device, target),
                        error);
    CHECK(judge.read_and_reset() < at_first);
  });
}

}  // namespace short_axes_test
