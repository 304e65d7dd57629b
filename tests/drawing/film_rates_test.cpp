// Rates that a film cannot have exactly.

#include <doctest/doctest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "base/scratch_folder.hpp"
#include "drawing/film_file.hpp"
#include "mcdbn/drawing/render.hpp"
#include "motion/synthetic_motion.hpp"

namespace film_rates_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Film {
  double fps = 0;
  int frames = 0;
};

Film read(const std::filesystem::path& path) {
  cv::VideoCapture capture(path.string());
  Film film{capture.get(cv::CAP_PROP_FPS), 0};
  for (cv::Mat image; capture.read(image);) ++film.frames;
  return film;
}

}  // namespace

TEST_CASE("a film has the rate asked for where it can, else one that differs by next to nothing") {
  for (const double fps : {5.0, 24.0, 30.0, 59.94, 60.0, 65.535, 119.88, 120.0, 240.0, 1000.0})
    CHECK(rendering::rate_of_film_hz(fps) == doctest::Approx(fps).epsilon(1e-12));
  for (const double fps : {6.0001, 23.97602, 29.97003, 65.5354, 65.5356, 66.66667, 83.33333,
                           119.93121, 239.7606, 655.354, 655.356, 3333.333, 9999.87}) {
    CAPTURE(fps);
    CHECK(std::abs(rendering::rate_of_film_hz(fps) - fps) <= 1e-4 * fps);
  }
}

TEST_CASE("a film can be written at any rate") {
  const ScratchFolder folder;
  const cv::Mat image(48, 64, CV_8UC3, cv::Scalar::all(90));
  for (const double fps : {23.97602, 59.94, 66.6667, 83.3333, 119.8801, 119.9312, 240.0, 700.123}) {
    CAPTURE(fps);
    rendering::FilmWriter writer(folder / "film.mp4", fps);
    CHECK(writer.fps() == rendering::rate_of_film_hz(fps));
    for (int i = 0; i < 6; ++i) writer.write(image);
    writer.finish();
    const Film film = read(folder / "film.mp4");
    CHECK(film.frames == 6);
    CHECK(std::abs(film.fps - fps) <= 2e-4 * fps);
  }
}

TEST_CASE("a video of a clip's own odd rate has as many frames") {
  const ScratchFolder folder;
  const double fps = 1 / 0.015;  // 66.67
  RenderOptions options;
  options.fps = fps;
  options.placement.width_px = options.placement.height_px = 64;
  render({{swinging(small_body(), 31, fps), ""}}, folder / "clip.mp4", options);
  const Film film = read(folder / "clip.mp4");
  CHECK(film.frames == 31);
  CHECK(std::abs(film.fps - fps) <= 2e-4 * fps);
}

}  // namespace film_rates_test
