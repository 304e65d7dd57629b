// Whether the camera that goes round sees the figure, and stands where it was put.

#include <doctest/doctest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/scratch_folder.hpp"
#include "mcdbn/drawing/render.hpp"
#include "motion/synthetic_motion.hpp"

namespace render_camera_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr int kWidth_px = 100, kHeight_px = 200;

/// Pixels with a strong colour: limbs have one, paper, grid and text do not.
cv::Mat limbs_of(const cv::Mat& image) {
  cv::Mat hsv, strong;
  cv::cvtColor(image, hsv, cv::COLOR_BGR2HSV);
  cv::inRange(hsv, cv::Scalar(0, 80, 80), cv::Scalar(180, 255, 255), strong);
  return strong;
}

/// Arms stretched out to both sides: wide from the front, narrow from the side.
Motion arms_out(int frames) {
  Motion motion{small_body(), 1.0 / 30, {}};
  motion.channels = MatrixD::Zero(frames, motion.skeleton.channel_count());
  motion.channels.col(1).setConstant(90);
  return motion;
}

RenderOptions small_pictures() {
  RenderOptions options;
  options.placement.width_px = kWidth_px;
  options.placement.height_px = kHeight_px;
  return options;
}

cv::Mat sheet_of(const std::vector<RenderClip>& clips, const RenderOptions& options) {
  const ScratchFolder folder;
  render(clips, folder / "sheet.png", options);
  return cv::imread((folder / "sheet.png").string());
}

bool touches_border(const cv::Mat& limbs) {
  return cv::countNonZero(limbs.col(0)) + cv::countNonZero(limbs.col(limbs.cols - 1)) +
             cv::countNonZero(limbs.row(0)) + cv::countNonZero(limbs.row(limbs.rows - 1)) >
         0;
}

}  // namespace

TEST_CASE("a camera that goes round sees the whole figure from everywhere, however fast") {
  RenderOptions options = small_pictures();
  options.placement.azimuth_deg = 90;  // from the side first
  options.orbit = true;
  options.sheet_columns = 4;
  for (const double speed : {-3600.0, -360.0, 7.0, 360.0, 720.0}) {
    CAPTURE(speed);
    options.orbit_deg_per_s = speed;
    // Eight times in a turn, whatever it takes.
    Motion motion = arms_out(9);
    motion.frame_time_s = 360 / std::abs(speed) / 8;
    const cv::Mat sheet = sheet_of({{motion, ""}}, options);
    REQUIRE(sheet.cols == 4 * kWidth_px);
    REQUIRE(sheet.rows == 2 * kHeight_px);
    int widest = 0, narrowest = kWidth_px;
    for (int cell = 0; cell < 8; ++cell) {
      CAPTURE(cell);
      const cv::Mat limbs = limbs_of(
          sheet(cv::Rect(cell % 4 * kWidth_px, cell / 4 * kHeight_px, kWidth_px, kHeight_px)));
      CHECK(cv::countNonZero(limbs) > 50);
      CHECK_FALSE(touches_border(limbs));
      widest = std::max(widest, cv::boundingRect(limbs).width);
      narrowest = std::min(narrowest, cv::boundingRect(limbs).width);
    }
    CHECK(widest > 2 * narrowest);
  }
}

TEST_CASE("a camera's distance that was given holds for a clip, whatever stands beside it") {
  const Motion large = arms_out(2);
  Motion small = large;
  for (Joint& joint : small.skeleton.joints) joint.offset /= 2;
  small.channels.leftCols(3) /= 2;
  RenderOptions options = small_pictures();
  options.sheet_columns = 1;
  options.placement.distance = 500;
  const auto height_px = [&](const cv::Mat& sheet, int row) {
    return cv::boundingRect(limbs_of(sheet.rowRange(row * kHeight_px, (row + 1) * kHeight_px)))
        .height;
  };
  const int alone = height_px(sheet_of({{large, ""}}, options), 0);
  CHECK(alone > 40);
  const cv::Mat both = sheet_of({{large, ""}, {small, ""}}, options);
  CHECK(height_px(both, 0) == alone);
  // As far away, half as large.
  CHECK(height_px(both, 1) == doctest::Approx(alone / 2.0).epsilon(0.15));
  // Without a distance both are drawn as high.
  options.placement.distance.reset();
  const cv::Mat fitted = sheet_of({{large, ""}, {small, ""}}, options);
  CHECK(height_px(fitted, 0) == doctest::Approx(height_px(fitted, 1)).epsilon(0.05));
}

}  // namespace render_camera_test
