#include "evaluation/foot_slide.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr double kPlantedWithin_mm = 40.0;
constexpr double kPlantedBelow_mm_s = 400.0;

void check(const MatrixD& truth, const MatrixD& regenerated, const std::vector<int>& feet) {
  if (truth.rows() != regenerated.rows() || truth.cols() != regenerated.cols())
    throw ShapeError(fmt::format("cannot compare feet of {}x{} and {}x{}", truth.rows(),
                                 truth.cols(), regenerated.rows(), regenerated.cols()));
  for (const int foot : feet)
    if (foot < 0 || 3 * foot + 2 >= truth.cols())
      throw ShapeError(fmt::format("there is no foot joint {} in {} columns", foot, truth.cols()));
}

}  // namespace

FootSlide foot_slide(const MatrixD& truth, const MatrixD& regenerated, const std::vector<int>& feet,
                     double fps) {
  check(truth, regenerated, feet);
  FootSlide slide;
  for (const int foot : feet) {
    const auto true_path = truth.middleCols<3>(3 * foot);
    const auto path = regenerated.middleCols<3>(3 * foot);
    const double ground_mm = true_path.rows() ? true_path.col(1).minCoeff() : 0;
    for (Eigen::Index frame = 0; frame + 1 < truth.rows(); ++frame) {
      const Eigen::RowVector3d true_step = true_path.row(frame + 1) - true_path.row(frame);
      const double height_mm = true_path.col(1).segment<2>(frame).maxCoeff() - ground_mm;
      if (height_mm > kPlantedWithin_mm || true_step.norm() * fps > kPlantedBelow_mm_s) continue;
      const Eigen::RowVector3d step = path.row(frame + 1) - path.row(frame);
      slide.truth_mm_s += std::hypot(true_step(0), true_step(2)) * fps;
      slide.regenerated_mm_s += std::hypot(step(0), step(2)) * fps;
      ++slide.planted;
    }
  }
  const double count = slide.planted ? slide.planted : std::numeric_limits<double>::quiet_NaN();
  slide.truth_mm_s /= count;
  slide.regenerated_mm_s /= count;
  return slide;
}

}  // namespace mcdbn
