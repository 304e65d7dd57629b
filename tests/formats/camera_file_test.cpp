#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/camera/camera.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>

#include "base/scratch_folder.hpp"
#include "camera/odd_camera.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using test::odd_camera;

namespace {

std::string camera_yaml(const std::string& from, const std::string& to) {
  std::string text =
      "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\n"
      "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
      "   data: [ 800., 0., 320., 0., 810., 240., 0., 0., 1. ]\n"
      "distortion_coefficients: [ 0.1, 0.2, 0.3, 0.4 ]\n"
      "rvec: [ 0., 0., 1.5707963267948966 ]\n"
      "tvec: [ 1., 2., 3. ]\n";
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("camera files: what is written is read, in every format of OpenCV") {
  const test::ScratchFolder folder;
  const Camera camera = odd_camera();
  for (const char* name : {"camera.yml", "camera.yaml", "camera.xml", "camera.json", "CAMERA.YML",
                           "CAMERA.Xml", "CAMERA.JSON"}) {
    CAPTURE(name);
    CHECK(has_camera_ending(name));
    write_camera(folder / name, camera);
    const Camera back = read_camera(folder / name);
    CHECK(back.camera_from_world == camera.camera_from_world);
    CHECK(back.translation == camera.translation);
    CHECK(back.fx_px == camera.fx_px);
    CHECK(back.fy_px == camera.fy_px);
    CHECK(back.cx_px == camera.cx_px);
    CHECK(back.cy_px == camera.cy_px);
    CHECK(back.distortion == camera.distortion);
    CHECK(back.width_px == 1280);
    CHECK(back.height_px == 720);
  }
  for (const char* name : {"camera.png", "camera"}) {
    CHECK_FALSE(has_camera_ending(name));
    CHECK_THROWS_AS(write_camera(folder / name, camera), InputError);
  }
}

TEST_CASE("camera files: a rotation vector and plain lists are read") {
  const test::ScratchFolder folder;
  const Camera camera = read_camera(folder.write("a.yml", camera_yaml("800.", "800.")));
  CHECK(camera.fx_px == 800);
  CHECK(camera.fy_px == 810);
  CHECK(camera.distortion == std::vector<double>{0.1, 0.2, 0.3, 0.4});
  CHECK((camera.camera_from_world * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm() <
        1e-12);
  CHECK(camera.translation == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("camera files: a rotation matrix that was rounded is the nearest rotation") {
  const test::ScratchFolder folder;
  // 30 degrees about z, to three decimals. A multiple of a rotation is nearest to that rotation.
  const Camera camera = read_camera(folder.write(
      "rounded.yml", camera_yaml("rvec: [ 0., 0., 1.5707963267948966 ]",
                                 "R: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                                 "   data: [ 0.866, -0.5, 0., 0.5, 0.866, 0., 0., 0., 1. ]")));
  const double length = std::hypot(0.866, 0.5);
  Eigen::Matrix3d expected;
  expected << 0.866 / length, -0.5 / length, 0, 0.5 / length, 0.866 / length, 0, 0, 0, 1;
  CHECK((camera.camera_from_world - expected).norm() < 1e-12);
}

TEST_CASE("camera files: what is wrong is named with its file and line") {
  const test::ScratchFolder folder;
  CHECK_THROWS_WITH_AS(read_camera(folder / "none.yml"), doctest::Contains("none.yml"), InputError);
  CHECK_THROWS_AS(read_camera(folder / ""), InputError);
  struct Case {
    const char *from, *to, *message;
  };
  for (const Case& c :
       {Case{"image_width", "width", "image_width is missing"},
        Case{"image_height: 480", "image_height: -3", ":4: image_height"},
        Case{"camera_matrix", "matrix", "camera_matrix is missing"},
        Case{"   rows: 3", "   rows: 9", "camera_matrix"},
        // A reader that allocated before it checked would fail with another message.
        Case{"   rows: 3", "   rows: 1000000000", "camera_matrix is not a matrix of numbers"},
        Case{"   dt: d", "   dt: \"2d\"", "camera_matrix cannot be read"},
        Case{"800.", "-1.", ":5: camera_matrix"},
        Case{", 0.4 ]", " ]", ":10: distortion_coefficients has 3"},
        Case{"rvec: [ 0., ", "rvec: [ ", ":11: rvec needs 3 numbers"},
        Case{"rvec", "vec", "neither rvec nor R"},
        Case{"rvec: [ 0., 0., 1.5707963267948966 ]", "R: [ 1., 2. ]", ":11: R"},
        Case{"2., 3. ]", "2. ]", ":12: tvec"}, Case{"2., 3. ]", ".nan, 3. ]", ":12: tvec"},
        Case{"tvec: [ 1., 2., 3. ]", "tvec: here", ":12: tvec"},
        Case{"%YAML:1.0", "hello", "OpenCV"}}) {
    CAPTURE(c.to);
    const auto path = folder.write("bad.yml", camera_yaml(c.from, c.to));
    CHECK_THROWS_WITH_AS(read_camera(path), doctest::Contains(c.message), InputError);
  }
  const auto path = folder.write(
      "mirror.yml", camera_yaml("rvec: [ 0., 0., 1.5707963267948966 ]",
                                "R: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n"
                                "   data: [ 1., 0., 0., 0., 1., 0., 0., 0., -1. ]"));
  CHECK_THROWS_WITH_AS(read_camera(path), doctest::Contains("R is not a rotation"), InputError);
}
