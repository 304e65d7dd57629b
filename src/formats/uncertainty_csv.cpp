#include "mcdbn/formats/uncertainty_csv.hpp"

#include <fmt/format.h>

#include <iterator>

#include "base/text_file.hpp"
#include "formats/csv_text.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

void write_uncertainty_csv(const std::filesystem::path& path, const Motion& motion,
                           const MatrixD& deviations) {
  const Skeleton& skeleton = motion.skeleton;
  if (deviations.rows() != motion.frames() || deviations.cols() != 3 * skeleton.joint_count())
    throw ShapeError(fmt::format("write_uncertainty_csv: {}x{} deviations, expected {}x{}",
                                 deviations.rows(), deviations.cols(), motion.frames(),
                                 3 * skeleton.joint_count()));
  std::string text = "time_s";
  const auto out = std::back_inserter(text);
  for (const Joint& joint : skeleton.joints) {
    require_csv_name(joint.name);
    for (const char axis : {'x', 'y', 'z'})
      fmt::format_to(out, ",{}_{}_deviation", joint.name, axis);
  }
  for (Eigen::Index t = 0; t < deviations.rows(); ++t) {
    fmt::format_to(out, "\n{}", time_cell(static_cast<double>(t) * motion.frame_time_s));
    for (const double deviation : deviations.row(t)) fmt::format_to(out, ",{:.4g}", deviation);
  }
  write_text_file(path, text + '\n');
}

}  // namespace mcdbn
