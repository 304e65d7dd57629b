#include "drawing/render_over.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/interruption.hpp"
#include "base/text_file.hpp"
#include "drawing/film_file.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn::rendering {
namespace {

/// So many frames of the film show some figure.
int frames_shown(const std::vector<Figure>& figures, double fps) {
  double longest_s = 0;
  for (const Figure& figure : figures)
    longest_s = std::max(longest_s, static_cast<double>(figure.points.rows()) / figure.fps);
  constexpr double kMost = 1e9;  // the film ends before
  return std::max(1, static_cast<int>(std::min(kMost, std::round(longest_s * fps))));
}

/// The camera as it filmed pictures of that size.
/// @throws InputError where they have another shape: figures would not lie where they were seen
Camera of_film(const Camera& camera, const FilmReader& film, const cv::Size& picture) {
  constexpr double kRounded = 0.01;  // of a side that was scaled to whole pixels
  const double wider = static_cast<double>(picture.width) / camera.width_px /
                       (static_cast<double>(picture.height) / camera.height_px);
  if (std::abs(wider - 1) > kRounded)
    throw InputError(fmt::format(
        "{}: its pictures are {} x {} pixels, those of the camera {} x {}, "
        "which is another shape",
        film.path().string(), picture.width, picture.height, camera.width_px, camera.height_px));
  return scaled(camera, picture.width, picture.height);
}

void draw_figures(cv::Mat& image, const std::vector<Figure>& figures, const FilmReader& film,
                  const Camera& camera, double t_s) {
  const Camera own = of_film(camera, film, image.size());
  for (const Figure& figure : figures)
    draw_figure(image, own, figure, figure.frame_at(t_s), Palette::second);
}

void write_film(FilmReader& film, int frames, const std::vector<Figure>& figures,
                const Camera& camera, const std::filesystem::path& path) {
  FilmWriter writer(path, film.fps());
  for (int i = 0; i < frames; ++i) {
    check_interruption();
    cv::Mat image = film.next();
    if (image.empty()) break;
    draw_figures(image, figures, film, camera, i / film.fps());
    writer.write(image);
  }
  if (writer.frames() == 0)
    throw InputError(fmt::format("{}: has no frame to draw over", film.path().string()));
  writer.finish();
}

/// Two rows of frames at even times.
void write_sheet(FilmReader& film, int frames, const std::vector<Figure>& figures,
                 const Camera& camera, const std::filesystem::path& path, int columns) {
  constexpr int kWidth_px = 640;
  std::vector<cv::Mat> strips(2);
  const int times = 2 * columns;
  int shown = 0;
  for (int i = 0; i < frames && shown < times; ++i) {
    check_interruption();
    cv::Mat image = film.next();
    if (image.empty()) break;
    if (i < shown * (frames - 1) / std::max(1, times - 1)) continue;
    draw_figures(image, figures, film, camera, i / film.fps());
    cv::Mat cell;
    cv::resize(image, cell, {kWidth_px, kWidth_px * image.rows / image.cols}, 0, 0, cv::INTER_AREA);
    draw_text(cell, fmt::format("{:.2f} s", i / film.fps()), 8, cell.rows - 20, 0.6);
    cv::Mat& strip = strips[static_cast<std::size_t>(shown++ / columns)];
    if (strip.empty())
      strip = cell;
    else
      cv::hconcat(strip, cell, strip);
  }
  if (shown == 0)
    throw InputError(fmt::format("{}: has no frame to draw over", film.path().string()));
  cv::Mat sheet = strips[0];
  if (!strips[1].empty()) {
    cv::copyMakeBorder(strips[1], strips[1], 0, 0, 0, sheet.cols - strips[1].cols,
                       cv::BORDER_CONSTANT);
    sheet.push_back(strips[1]);
  }
  std::vector<unsigned char> png;
  cv::imencode(".png", sheet, png);
  write_text_file(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace

void render_over(const std::vector<Figure>& figures, const std::filesystem::path& path,
                 const RenderOptions& options) {
  if (!options.camera)
    throw ConfigError("a film is drawn over through the camera that filmed it; give one");
  FilmReader film(options.over, options.over_from);
  const int frames = frames_shown(figures, film.fps());
  if (path.extension() == ".png")
    write_sheet(film, frames, figures, *options.camera, path, options.sheet_columns);
  else
    write_film(film, frames, figures, *options.camera, path);
}

}  // namespace mcdbn::rendering
