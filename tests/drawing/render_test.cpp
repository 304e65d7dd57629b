#include "mcdbn/drawing/render.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

using namespace mcdbn;
using test::ScratchFolder;

namespace {

Motion short_clip(SynthesisAction action, double seconds = 0.5) {
  SynthesisOptions options;
  options.action = action;
  options.seconds = seconds;
  return synthesize(options);
}

/// How many pixels have a strong colour: limbs have one, paper, grid and text do not.
int coloured_pixels(const cv::Mat& image) {
  cv::Mat hsv, strong;
  cv::cvtColor(image, hsv, cv::COLOR_BGR2HSV);
  cv::inRange(hsv, cv::Scalar(0, 80, 80), cv::Scalar(180, 255, 255), strong);
  return cv::countNonZero(strong);
}

int files_in(const std::filesystem::path& folder) {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  return count;
}

}  // namespace

TEST_CASE("a contact sheet has its rows and columns, with a figure in each") {
  const ScratchFolder folder;
  const RenderClip walk{short_clip(SynthesisAction::walk), "walk"};
  const RenderClip clap{short_clip(SynthesisAction::clap), "clap"};
  RenderOptions options;
  options.sheet_columns = 3;
  options.placement.width_px = 160;
  options.placement.height_px = 200;
  SUBCASE("two rows of one clip") {
    render({walk}, folder / "sheet.png", options);
  }
  SUBCASE("a row for each of two clips") {
    render({walk, clap}, folder / "sheet.png", options);
  }
  SUBCASE("two rows of an overlay") {
    options.overlay = true;
    render({walk, clap}, folder / "sheet.png", options);
  }
  SUBCASE("with a still camera") {
    options.follow_root = false;
    render({walk}, folder / "sheet.png", options);
  }
  const cv::Mat sheet = cv::imread((folder / "sheet.png").string());
  REQUIRE(sheet.cols == 3 * 160);
  REQUIRE(sheet.rows == 2 * 200);
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 3; ++column) {
      CHECK(coloured_pixels(sheet(cv::Rect(column * 160, row * 200, 160, 200))) > 300);
    }
  }
}

TEST_CASE("the figure is drawn where the camera sees it, left and right in their colours") {
  const ScratchFolder folder;
  // Seen from the front, the figure's left limbs are on the right side of the picture.
  Motion motion = short_clip(SynthesisAction::clap);
  motion.channels = motion.channels.topRows(1).eval();
  motion.channels.row(0).tail(motion.channels.cols() - 3).setZero();  // T-pose
  RenderOptions options;
  options.sheet_columns = 1;
  options.placement.azimuth_deg = 0;
  options.placement.width_px = 300;
  options.placement.height_px = 300;
  render({{motion, ""}}, folder / "pose.png", options);
  const cv::Mat image = cv::imread((folder / "pose.png").string())(cv::Rect(0, 0, 300, 300));
  cv::Mat blue, red;
  cv::inRange(image, cv::Scalar(130, 60, 0), cv::Scalar(255, 190, 120), blue);
  cv::inRange(image, cv::Scalar(40, 30, 150), cv::Scalar(150, 140, 255), red);
  REQUIRE(cv::countNonZero(blue) > 200);
  REQUIRE(cv::countNonZero(red) > 200);
  const cv::Moments on_left = cv::moments(blue, true), on_right = cv::moments(red, true);
  CHECK(on_left.m10 / on_left.m00 > 170);
  CHECK(on_right.m10 / on_right.m00 < 130);
}

TEST_CASE("through a camera, joints are where it projects them") {
  const ScratchFolder folder;
  const Motion motion = short_clip(SynthesisAction::walk);
  CameraPlacement placement;
  placement.azimuth_deg = 60;
  const Camera camera = place_camera(motion, placement);
  const Track2d track = project_motion(motion, camera);
  RenderOptions options;
  options.camera = camera;
  options.sheet_columns = 1;
  render({{motion, ""}}, folder / "camera.png", options);
  const cv::Mat sheet = cv::imread((folder / "camera.png").string());
  const cv::Mat image = sheet.rowRange(0, sheet.rows / 2);
  REQUIRE(std::abs(image.cols - image.rows * 1920.0 / 1080.0) < 2);
  const double scale = image.rows / 1080.0;
  int limbs = 0;
  for (int joint = 0; joint < track.joint_count(); ++joint) {
    const std::string& name = track.joint_names[static_cast<std::size_t>(joint)];
    if (!name.starts_with("Left") && !name.starts_with("Right")) continue;
    CAPTURE(name);
    ++limbs;
    const int x = cvRound(scale * track.x_px(0, joint)), y = cvRound(scale * track.y_px(0, joint));
    const cv::Rect around = cv::Rect(x - 3, y - 3, 7, 7) & cv::Rect({0, 0}, image.size());
    CHECK(coloured_pixels(image(around)) > 5);
  }
  CHECK(limbs >= 12);
}

TEST_CASE("a video has a frame for every frame of the longest clip") {
  const ScratchFolder folder;
  const RenderClip walk{short_clip(SynthesisAction::walk, 0.5), "walk"};
  const RenderClip longer{short_clip(SynthesisAction::walk, 0.8), "longer"};
  RenderOptions options;
  options.placement.width_px = 160;
  options.placement.height_px = 200;
  options.orbit = true;
  render({walk, longer}, folder / "walk.mp4", options);
  CHECK(files_in(folder / "") == 1);
  cv::VideoCapture video((folder / "walk.mp4").string());
  REQUIRE(video.isOpened());
  CHECK(video.get(cv::CAP_PROP_FPS) == doctest::Approx(30));
  int frames = 0;
  for (cv::Mat image; video.read(image); ++frames) {
    REQUIRE(image.cols == 320);
    REQUIRE(image.rows == 200);
    CHECK(coloured_pixels(image) > 300);
  }
  CHECK(frames == 24);
}

TEST_CASE("rendering reports what is wrong and leaves no file behind") {
  const ScratchFolder folder;
  const RenderClip clip{short_clip(SynthesisAction::walk), "walk"};
  CHECK_THROWS_AS(render({}, folder / "a.png"), InputError);
  CHECK_THROWS_AS(render({clip}, folder / "a.gif"), ConfigError);
  CHECK_THROWS_AS(render({clip}, folder / "missing/a.mp4"), InputError);
  CHECK_THROWS_AS(render({clip}, folder / "missing/a.png"), InputError);
  RenderOptions options;
  options.sheet_columns = 0;
  CHECK_THROWS_AS(render({clip}, folder / "a.png", options), ConfigError);
  options = {};
  options.placement.width_px = options.placement.height_px = 100'000;
  CHECK_THROWS_AS(render({clip}, folder / "a.png", options), ConfigError);
  RenderClip endless = clip;  // of a month, at 240 frames a second
  endless.motion.frame_time_s = 10;
  endless.motion.channels = clip.motion.channels.row(0).replicate(5000, 1);
  options = {};
  options.fps = 240;
  CHECK_THROWS_AS(render({endless}, folder / "a.mp4", options), InputError);
  RenderClip empty = clip;
  empty.motion.channels.resize(0, empty.motion.channels.cols());
  CHECK_THROWS_AS(render({empty}, folder / "a.png"), InputError);
  CHECK(files_in(folder / "") == 0);
}
