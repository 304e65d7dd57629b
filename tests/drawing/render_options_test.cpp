// Which frames stand in a picture or a video, and how fast it runs.

#include <doctest/doctest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/scratch_folder.hpp"
#include "mcdbn/drawing/render.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using test::ScratchFolder;

namespace {

/// Pixels with a strong colour: limbs have one, paper, grid and text do not.
cv::Mat limbs_of(const cv::Mat& image) {
  cv::Mat hsv, strong;
  cv::cvtColor(image, hsv, cv::COLOR_BGR2HSV);
  cv::inRange(hsv, cv::Scalar(0, 80, 80), cv::Scalar(180, 255, 255), strong);
  return strong;
}

/// Pixels that are a limb in one picture alone.
int differing(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat different;
  cv::bitwise_xor(limbs_of(a), limbs_of(b), different);
  return cv::countNonZero(different);
}

RenderOptions through_camera(const Motion& motion) {
  RenderOptions options;
  options.camera = place_camera(
      motion, {.azimuth_deg = 20, .distance = std::nullopt, .width_px = 160, .height_px = 200});
  options.placement.width_px = 160;
  options.placement.height_px = 200;
  return options;
}

Motion frames_of(const Motion& motion, int first, int count) {
  return {motion.skeleton, motion.frame_time_s, motion.channels.middleRows(first, count)};
}

cv::Mat read_sheet(const ScratchFolder& folder, const std::vector<RenderClip>& clips,
                   const RenderOptions& options) {
  render(clips, folder / "sheet.png", options);
  return cv::imread((folder / "sheet.png").string());
}

struct Video {
  double fps = 0;
  std::vector<cv::Mat> images;
};

Video read_video(const ScratchFolder& folder, const std::vector<RenderClip>& clips,
                 const RenderOptions& options) {
  render(clips, folder / "clip.mp4", options);
  cv::VideoCapture capture((folder / "clip.mp4").string());
  Video video;
  video.fps = capture.get(cv::CAP_PROP_FPS);
  for (cv::Mat image; capture.read(image);) video.images.push_back(image.clone());
  return video;
}

}  // namespace

TEST_CASE("a contact sheet shows frames at even times from the first to the last") {
  const ScratchFolder folder;
  const Motion motion = test::swinging(test::small_body(), 10);
  RenderOptions options = through_camera(motion);
  options.sheet_columns = 2;
  const cv::Mat sheet = read_sheet(folder, {{motion, "clip"}}, options);
  RenderOptions one = options;
  one.sheet_columns = 1;
  for (int cell = 0; cell < 4; ++cell) {
    CAPTURE(cell);
    const cv::Mat shown = sheet(cv::Rect(cell % 2 * 160, cell / 2 * 200, 160, 200));
    const auto single = [&](int frame) {
      return read_sheet(folder, {{frames_of(motion, frame, 1), "clip"}}, one).rowRange(0, 200);
    };
    CHECK(differing(shown, single(3 * cell)) == 0);
    CHECK(differing(shown, single(3 * cell == 9 ? 8 : 3 * cell + 1)) > 0);
  }
}

TEST_CASE("two clips have a row each, the first on top, and run by time") {
  const ScratchFolder folder;
  const Motion slow = test::swinging(test::small_body(), 10, 30);
  Motion fast = test::swinging(test::small_body(), 19, 60);
  RenderOptions options = through_camera(slow);
  options.sheet_columns = 4;
  const cv::Mat both = read_sheet(folder, {{slow, "a"}, {fast, "b"}}, options);
  REQUIRE(both.rows == 400);
  // The same movement at another rate, but for the root's own turn.
  fast.channels = MatrixD(19, slow.channels.cols());
  for (int t = 0; t < 19; ++t) fast.channels.row(t) = slow.channels.row(t / 2);
  const cv::Mat same = read_sheet(folder, {{slow, "a"}, {fast, "b"}}, options);
  CHECK(differing(same.rowRange(0, 200), same.rowRange(200, 400)) == 0);
  CHECK(differing(both.rowRange(0, 200), same.rowRange(0, 200)) == 0);
  CHECK(differing(both.rowRange(200, 400), same.rowRange(200, 400)) > 0);
}

TEST_CASE("a video runs at the rate asked for, else at the first clip's, at most 60") {
  const ScratchFolder folder;
  const Motion motion = test::swinging(test::small_body(), 24, 120);
  RenderOptions options = through_camera(motion);
  Video video = read_video(folder, {{motion, ""}}, options);
  CHECK(video.fps == doctest::Approx(60));
  CHECK(video.images.size() == 12);
  options.fps = 20;
  video = read_video(folder, {{motion, ""}}, options);
  CHECK(video.fps == doctest::Approx(20));
  CHECK(video.images.size() == 4);
}

TEST_CASE("a video's shorter clip holds its last frame") {
  const ScratchFolder folder;
  const Motion longer = test::swinging(test::small_body(), 16), shorter = frames_of(longer, 0, 5);
  const RenderOptions options = through_camera(longer);
  const Video held = read_video(folder, {{shorter, ""}, {longer, ""}}, options);
  REQUIRE(held.images.size() == 16);
  const auto left = [&](std::size_t i) { return held.images[i].colRange(0, 160); };
  const auto right = [&](std::size_t i) { return held.images[i].colRange(160, 320); };
  // Compression moves edges a little.
  const int between = differing(left(0), left(4));
  CHECK(between > 200);
  CHECK(differing(left(15), left(5)) < between / 4);
  CHECK(differing(left(4), right(4)) < between / 4);
  CHECK(differing(left(15), right(15)) > between / 2);
}

TEST_CASE("the camera follows the root only if asked to, and goes round only if asked to") {
  const ScratchFolder folder;
  Motion motion = test::swinging(test::small_body(), 10);
  for (int t = 1; t < 10; ++t) motion.channels.row(t) = motion.channels.row(0);
  motion.channels.col(0) = Eigen::VectorXd::LinSpaced(10, 0, 300);
  RenderOptions options;
  options.sheet_columns = 2;
  options.placement.width_px = 160;
  options.placement.height_px = 200;
  options.placement.azimuth_deg = 0;
  const auto first_and_last = [&] {
    const cv::Mat sheet = read_sheet(folder, {{motion, ""}}, options);
    return differing(sheet(cv::Rect(0, 0, 160, 200)), sheet(cv::Rect(160, 200, 160, 200)));
  };
  CHECK(first_and_last() < 20);  // it stands still in a picture that goes with it
  options.orbit = true;
  options.orbit_deg_per_s = 200;
  CHECK(first_and_last() > 100);
  options.orbit = false;
  options.follow_root = false;
  CHECK(first_and_last() > 100);
}

TEST_CASE("an overlay draws its second clip in other colours") {
  const ScratchFolder folder;
  const Motion motion = test::swinging(test::small_body(), 2);
  RenderOptions options = through_camera(motion);
  options.overlay = true;
  options.sheet_columns = 1;
  const cv::Mat one = read_sheet(folder, {{motion, ""}}, options),
                two = read_sheet(folder, {{motion, ""}, {motion, ""}}, options);
  cv::Mat difference;
  cv::absdiff(one.rowRange(0, 150), two.rowRange(0, 150), difference);
  // Drawn twice in the same colours the edges alone would be a little stronger.
  CHECK(cv::sum(difference).ddot({1, 1, 1, 0}) > 20000);
}

TEST_CASE("figures side by side are drawn to one scale") {
  const ScratchFolder folder;
  Motion still = test::swinging(test::small_body(), 6);
  for (int t = 1; t < 6; ++t) still.channels.row(t) = still.channels.row(0);
  Motion spread = still;  // its hips rise far above where they were
  spread.channels(3, 1) += 250;
  RenderOptions options;
  options.sheet_columns = 1;
  options.placement.width_px = 160;
  options.placement.height_px = 200;
  const auto height_px = [&](const std::vector<RenderClip>& clips) {
    const cv::Mat sheet = read_sheet(folder, clips, options);
    return cv::boundingRect(limbs_of(sheet.rowRange(0, 200))).height;
  };
  const int alone = height_px({{still, ""}}), beside = height_px({{still, ""}, {spread, ""}});
  CHECK(alone > 100);
  CHECK(beside < 0.7 * alone);
  CHECK(beside > 20);
}
