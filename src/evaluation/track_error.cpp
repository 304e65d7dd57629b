#include "evaluation/track_error.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

Eigen::Index column_of(const Track2d& track, const std::string& name) {
  const int column = track.find(name);
  if (column < 0) throw InputError(fmt::format("the 2D track has no column for joint {}", name));
  return column;
}

}  // namespace

double track_error_px(const Track2d& truth, const Track2d& regenerated,
                      const std::string& root_name) {
  if (truth.frames() != regenerated.frames())
    throw ShapeError(fmt::format("cannot compare tracks of {} and {} frames", truth.frames(),
                                 regenerated.frames()));
  const Eigen::Index true_root = column_of(truth, root_name),
                     root = column_of(regenerated, root_name);
  double sum = 0;
  Eigen::Index count = 0;
  for (Eigen::Index joint = 0; joint < regenerated.joint_count(); ++joint) {
    if (joint == root) continue;
    const Eigen::Index same =
        column_of(truth, regenerated.joint_names[static_cast<std::size_t>(joint)]);
    const auto off = [&](const MatrixD& real, const MatrixD& other) -> Eigen::ArrayXd {
      return (other.col(joint) - other.col(root)) - (real.col(same) - real.col(true_root));
    };
    const Eigen::ArrayXd x = off(truth.x_px, regenerated.x_px),
                         y = off(truth.y_px, regenerated.y_px);
    for (Eigen::Index frame = 0; frame < x.size(); ++frame) {
      const double distance = std::hypot(x[frame], y[frame]);
      if (std::isnan(distance)) continue;
      sum += distance;
      ++count;
    }
  }
  return count ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace mcdbn
