#include <doctest/doctest.h>

#include "mcdbn/evaluation/joint_error.hpp"

namespace mcdbn {
namespace {

/// Hips with one leg along −y; `unit` file units are a centimetre.
Motion leg(double unit) {
  const auto joint = [unit](const char* name, int parent, double y_cm) {
    Joint result;
    result.name = name;
    result.parent = parent;
    result.offset = Eigen::Vector3d(0, y_cm * unit, 0);
    result.channels = {Channel::z_rotation, Channel::x_rotation, Channel::y_rotation};
    return result;
  };
  Motion motion;
  motion.skeleton.joints = {joint("Hips", -1, 0), joint("Knee", 0, -42), joint("Ankle", 1, -41)};
  auto& root_channels = motion.skeleton.joints[0].channels;
  root_channels.insert(root_channels.begin(),
                       {Channel::x_position, Channel::y_position, Channel::z_position});
  motion.channels = MatrixD::Zero(2, 12);
  motion.channels.row(1).head<3>() << 100 * unit, 90 * unit, -50 * unit;
  motion.channels(1, 6) = 90;  // the knee turns about z: the shank points along +x
  return motion;
}

}  // namespace

TEST_CASE("positions in millimetres do not depend on the file's unit") {
  const MatrixD world = world_positions_mm(leg(1));
  CHECK((world_positions_mm(leg(1 / 5.64)) - world).cwiseAbs().maxCoeff() < 1e-9);
  const MatrixD relative = root_relative_positions_mm(leg(1));
  CHECK((root_relative_positions_mm(leg(40)) - relative).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("root_relative_positions_mm: shape of the body, none of its travel") {
  const MatrixD relative = root_relative_positions_mm(leg(1));
  CHECK(relative.leftCols(3).isZero());
  // The scale is set by 1.7 m of body; the proportions are the skeleton's.
  const double mm_per_cm = -relative(0, 4) / 42;
  CHECK(mm_per_cm > 8);
  CHECK(mm_per_cm < 12);
  CHECK(relative(0, 7) == doctest::Approx(-83 * mm_per_cm));
  CHECK(relative(1, 4) == doctest::Approx(-42 * mm_per_cm));
  CHECK(relative(1, 6) == doctest::Approx(41 * mm_per_cm));
  CHECK(relative(1, 7) == doctest::Approx(-42 * mm_per_cm));

  const MatrixD world = world_positions_mm(leg(1));
  CHECK(world(1, 0) == doctest::Approx(100 * mm_per_cm));
  CHECK(world(1, 8) == doctest::Approx(-50 * mm_per_cm));
  CHECK(root_relative_positions_mm(leg(1), 1).middleCols(3, 3).isZero());
}

}  // namespace mcdbn
