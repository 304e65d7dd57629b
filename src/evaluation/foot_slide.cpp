#include "evaluation/foot_slide.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/planted_foot.hpp"

namespace mcdbn {
namespace {

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
    const double ground_mm = truth.rows() ? truth.col(3 * foot + 1).minCoeff() : 0;
    for (Eigen::Index frame = 1; frame < truth.rows(); ++frame) {
      const JointStep true_step = step_to(truth, foot, frame);
      if (!kPlantedInCapture.holds((true_step.height - ground_mm) / 1000,
                                   true_step.moved.norm() * fps / 1000))
        continue;
      const Eigen::RowVector3d step = step_to(regenerated, foot, frame).moved;
      slide.truth_mm_s += std::hypot(true_step.moved(0), true_step.moved(2)) * fps;
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
