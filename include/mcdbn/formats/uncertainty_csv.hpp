#pragma once

#include <filesystem>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// How sure every joint of a motion is, as CSV: a header `time_s`, and for each joint its standard
/// deviations `joint_x_deviation`, `joint_y_deviation`, `joint_z_deviation` along the world's axes,
/// in the units of the motion's file; a line a frame. Written atomically.
/// @param deviations [frames x 3·joints], of joint_uncertainty
/// @throws ShapeError; InputError if a joint's name cannot stand in a header
void write_uncertainty_csv(const std::filesystem::path& path, const Motion& motion,
                           const MatrixD& deviations);

}  // namespace mcdbn
