// How sure a motion is, as a table.

#include "mcdbn/formats/uncertainty_csv.hpp"

#include <doctest/doctest.h>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace {

Motion two_frames(const std::string& name) {
  Motion motion;
  motion.skeleton.joints = {{name, -1, {0, 0, 0}, {Channel::z_rotation}, {}}};
  motion.frame_time_s = 0.04;
  motion.channels = MatrixD::Zero(2, 1);
  return motion;
}

}  // namespace

TEST_CASE("uncertainty csv: a header, then a line a frame with its time") {
  const test::ScratchFolder folder;
  MatrixD deviations(2, 3);
  deviations << 1, 2.5, 0, 0.123456, 4, 1e-6;
  write_uncertainty_csv(folder / "sure.csv", two_frames("Hips"), deviations);
  CHECK(read_text_file(folder / "sure.csv") ==
        "time_s,Hips_x_deviation,Hips_y_deviation,Hips_z_deviation\n"
        "0,1,2.5,0\n"
        "0.04,0.1235,4,1e-06\n");
}

TEST_CASE("uncertainty csv: every frame has a time of its own, hours after the first, too") {
  const test::ScratchFolder folder;
  Motion motion = two_frames("Hips");
  motion.frame_time_s = 1.0 / 30;
  motion.channels = MatrixD::Zero(300'002, 1);
  write_uncertainty_csv(folder / "long.csv", motion, MatrixD::Zero(300'002, 3));
  const std::string text = read_text_file(folder / "long.csv");
  CHECK(text.find("\n0.0333333,0,0,0\n") != std::string::npos);
  CHECK(text.ends_with("\n10000,0,0,0\n10000.0333333,0,0,0\n"));
}

TEST_CASE("uncertainty csv: names that a header cannot hold, and other shapes, are refused") {
  const test::ScratchFolder folder;
  CHECK_THROWS_AS(write_uncertainty_csv(folder / "a.csv", two_frames("a,b"), MatrixD::Zero(2, 3)),
                  InputError);
  CHECK_THROWS_AS(write_uncertainty_csv(folder / "a.csv", two_frames("a"), MatrixD::Zero(3, 3)),
                  ShapeError);
  CHECK(!std::filesystem::exists(folder / "a.csv"));
}
