// OpenCV's camera files whose matrices are lists, as programs in Python write them.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/formats/camera_file.hpp"

using namespace mcdbn;

namespace camera_lists_test {

namespace {

const std::string kRows = "[[0, -1, 0], [1, 0, 0], [0, 0, 1]]";  // a quarter turn about z

std::string json_of(const std::string& matrix, const std::string& distortion,
                    const std::string& rotation, const std::string& translation) {
  return fmt::format(
      R"({{"image_width": 640, "image_height": 480, "camera_matrix": {},
          "distortion_coefficients": {}, {}, "tvec": {}}})",
      matrix, distortion, rotation, translation);
}

}  // namespace

TEST_CASE("camera lists: nine numbers are 3x3, row by row, and lists in lists are rows") {
  const test::ScratchFolder folder;
  const std::string flat = "[800, 0, 320, 0, 810, 240, 0, 0, 1]",
                    nested = "[[800.0, 0.0, 320.0], [0.0, 810.0, 240.0], [0.0, 0.0, 1.0]]",
                    rvec = R"("rvec": [[0], [0], [1.5707963267948966]])";
  for (const std::string& text : {
           json_of(flat, "[0.1, 0.2, 0.3, 0.4]", R"("R": [0, -1, 0, 1, 0, 0, 0, 0, 1])",
                   "[1, 2, 3]"),
           json_of(nested, "[[0.1, 0.2, 0.3, 0.4]]", R"("R": )" + kRows, "[[1], [2], [3]]"),
           json_of(nested, "[[0.1], [0.2], [0.3], [0.4]]", rvec, "[[1, 2, 3]]"),
       }) {
    CAPTURE(text);
    const Camera camera = read_camera(folder.write("camera.json", text));
    CHECK(camera.fx_px == 800);
    CHECK(camera.cx_px == 320);
    CHECK(camera.fy_px == 810);
    CHECK(camera.cy_px == 240);
    CHECK(camera.distortion == std::vector<double>{0.1, 0.2, 0.3, 0.4});
    Eigen::Matrix3d turn;
    turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    CHECK((camera.camera_from_world - turn).norm() < 1e-12);
    CHECK(camera.translation == Eigen::Vector3d(1, 2, 3));
  }
}

TEST_CASE("camera lists: other counts, and words among the numbers, are refused") {
  const test::ScratchFolder folder;
  const auto check_refused = [&](const std::string& matrix, const std::string& message) {
    CAPTURE(matrix);
    CHECK_THROWS_WITH_AS(
        read_camera(folder.write("camera.json",
                                 json_of(matrix, "[0, 0, 0, 0]", R"("R": )" + kRows, "[1, 2, 3]"))),
        doctest::Contains(message.c_str()), InputError);
  };
  check_refused("[800, 0, 320, 0, 810, 240]", "camera_matrix is not 3x3");
  check_refused("[[800, 0, 320], [0, 810, 240], [0, 0, 1], [0, 0, 0]]", "camera_matrix is not 3x3");
  check_refused(R"([[800, 0, 320], [0, "x", 240], [0, 0, 1]])",
                "camera_matrix is not a matrix of numbers");
  check_refused("[]", "camera_matrix");
}

}  // namespace camera_lists_test
