// Figures drawn over the frames of a film.

#include <doctest/doctest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/drawing/render.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using test::ScratchFolder;

namespace {

constexpr int kWidth_px = 320, kHeight_px = 240;

/// Each frame of one grey, 12 brighter than the frame before.
std::filesystem::path write_film(const ScratchFolder& folder, int frames, double fps = 30) {
  const auto path = folder / "film.mp4";
  cv::VideoWriter writer(path.string(), cv::VideoWriter::fourcc('m', 'p', '4', 'v'), fps,
                         {kWidth_px, kHeight_px});
  for (int i = 0; i < frames; ++i)
    writer.write(cv::Mat(kHeight_px, kWidth_px, CV_8UC3, cv::Scalar::all(10 + 12 * i)));
  return path;
}

std::vector<cv::Mat> read_film(const std::filesystem::path& path) {
  cv::VideoCapture capture(path.string());
  std::vector<cv::Mat> images;
  for (cv::Mat image; capture.read(image);) images.push_back(image.clone());
  return images;
}

/// The frame whose corner is most like the image's.
int nearest_frame(const std::vector<cv::Mat>& film, const cv::Mat& image) {
  const auto corner = [](const cv::Mat& of) { return cv::mean(of(cv::Rect(0, 0, 16, 16)))[0]; };
  const auto off = [&](const cv::Mat& frame) { return std::abs(corner(frame) - corner(image)); };
  return static_cast<int>(std::ranges::min_element(film, {}, off) - film.begin());
}

/// Pixels of some colour: the film has none.
int coloured(const cv::Mat& image) {
  cv::Mat hsv, strong;
  cv::cvtColor(image, hsv, cv::COLOR_BGR2HSV);
  cv::inRange(hsv, cv::Scalar(0, 80, 80), cv::Scalar(180, 255, 255), strong);
  return cv::countNonZero(strong);
}

RenderOptions over(const std::filesystem::path& film, const Motion& motion, int from) {
  RenderOptions options;
  options.over = film;
  options.over_from = from;
  options.camera = place_camera(
      motion, {.distance = std::nullopt, .width_px = 2 * kWidth_px, .height_px = 2 * kHeight_px});
  return options;
}

}  // namespace

TEST_CASE("a film is drawn over from the frame where the clip begins, in its own size") {
  const ScratchFolder folder;
  const auto film = write_film(folder, 20);
  const Motion motion = test::swinging(test::small_body(), 8);
  render({{motion, "clip"}}, folder / "drawn.mp4", over(film, motion, 5));
  const std::vector<cv::Mat> filmed = read_film(film), images = read_film(folder / "drawn.mp4");
  REQUIRE(filmed.size() == 20);
  REQUIRE(images.size() == 8);
  for (int i = 0; i < 8; ++i) {
    const cv::Mat& image = images[static_cast<std::size_t>(i)];
    CHECK(image.cols == kWidth_px);
    // A corner shows the film, of whose frames that one is nearest; the middle the figure.
    CHECK(nearest_frame(filmed, image) == 5 + i);
    CHECK(coloured(image) > 200);
  }
  // The film ends before the clip does.
  render({{motion, "clip"}}, folder / "short.mp4", over(film, motion, 17));
  CHECK(read_film(folder / "short.mp4").size() == 3);
}

TEST_CASE("a film of another size than the camera's gives one notice, of its own size none") {
  const ScratchFolder folder;
  const auto film = write_film(folder, 6);
  const Motion motion = test::swinging(test::small_body(), 4);
  const auto notices = [&](const RenderOptions& options, const char* output) {
    std::vector<std::string> collected;
    render({{motion, "clip"}}, folder / output, options, &collected);
    return collected;
  };
  RenderOptions options = over(film, motion, 0);
  const std::vector<std::string> scaled{
      film.string() +
      ": its images are 320 x 240 px, those of the camera 640 x 480 px: the camera is scaled to "
      "them"};
  CHECK(notices(options, "drawn.mp4") == scaled);
  CHECK(notices(options, "drawn.png") == scaled);
  options.camera = mcdbn::scaled(*options.camera, kWidth_px, kHeight_px);
  CHECK(notices(options, "drawn.mp4").empty());
}

TEST_CASE("a film of another rate than the motion's gives a notice, and so does one that ends") {
  using Notices = std::vector<std::string>;
  const ScratchFolder folder;
  const auto notices = [&](double film_fps, double motion_fps, int film_frames) {
    const auto film = write_film(folder, film_frames, film_fps);
    const Motion motion = test::swinging(test::small_body(), 6, motion_fps);
    RenderOptions options = over(film, motion, 0);
    options.camera = mcdbn::scaled(*options.camera, kWidth_px, kHeight_px);
    Notices of_film, of_sheet;
    render({{motion, "clip"}}, folder / "drawn.mp4", options, &of_film);
    render({{motion, "clip"}}, folder / "drawn.png", options, &of_sheet);
    CHECK(of_film == of_sheet);
    for (std::string& notice : of_film) {
      REQUIRE(notice.starts_with(film.string() + ": it "));
      notice.erase(0, film.string().size() + 5);
    }
    return of_film;
  };
  CHECK(notices(30, 30, 6).empty());
  CHECK(notices(30, 29.9997, 6).empty());
  CHECK(
      notices(25, 30, 6) ==
      Notices{"has 25 frames a second, the motion 30, and they are drawn by time; if the motion's "
              "frames are the film's, regenerate it with `fps` 25"});
  CHECK(notices(30, 29.97, 6).size() == 1);
  CHECK(notices(30, 30, 3) ==
        Notices{"ends 0.10 s before the motion does, the rest of which is not drawn"});
  CHECK(notices(60, 30, 6).size() == 2);  // half of the motion is drawn
}

TEST_CASE("a sheet over a film shows frames at even times") {
  const ScratchFolder folder;
  const Motion motion = test::swinging(test::small_body(), 10);
  RenderOptions options = over(write_film(folder, 12), motion, 0);
  options.sheet_columns = 2;
  render({{motion, "clip"}}, folder / "sheet.png", options);
  const cv::Mat sheet = cv::imread((folder / "sheet.png").string());
  REQUIRE(sheet.cols == 2 * 640);
  REQUIRE(sheet.rows == 2 * 480);
  const auto grey = [&](int row, int column) { return sheet.at<cv::Vec3b>(row, column)[0]; };
  CHECK(std::abs(grey(5, 5) - 10) < 8);
  CHECK(std::abs(grey(485, 645) - 118) < 8);  // the clip's last frame
}

TEST_CASE("what cannot be drawn over is reported") {
  const ScratchFolder folder;
  const Motion motion = test::swinging(test::small_body(), 4);
  const auto film = write_film(folder, 6);
  const auto draw = [&](const RenderOptions& options) {
    render({{motion, "clip"}}, folder / "drawn.mp4", options);
  };
  RenderOptions options = over(film, motion, 0);
  options.camera.reset();
  CHECK_THROWS_WITH_AS(draw(options),
                       doctest::Contains("give `camera`; where there is no calibration, "
                                         "regenerate's `write-camera`"),
                       ConfigError);
  CHECK_THROWS_AS(draw(over(folder / "absent.mp4", motion, 0)), InputError);
  CHECK_THROWS_AS(draw(over(folder.write("text.mp4", "no film"), motion, 0)), InputError);
  // OpenCV would open the files, and the addresses, that these name.
  for (const char* list : {"ffconcat version 1.0\nfile film.mp4\n",
                           "#EXTM3U\n#EXT-X-TARGETDURATION:9\n#EXTINF:9,\nfilm.mp4\n"}) {
    CAPTURE(list);
    CHECK_THROWS_AS(draw(over(folder.write("list.mp4", list), motion, 0)), InputError);
  }
  CHECK_THROWS_AS(draw(over(film, motion, 6)), InputError);
  CHECK_THROWS_AS(draw(over(film, motion, 60)), InputError);
  RenderOptions other_shape = over(film, motion, 0);
  other_shape.camera->width_px += 16;
  CHECK_THROWS_AS(draw(other_shape), InputError);
  CHECK(!std::filesystem::exists(folder / "drawn.mp4"));
}
