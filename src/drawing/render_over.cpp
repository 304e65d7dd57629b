#include "drawing/render_over.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "base/interruption.hpp"
#include "base/named_errors.hpp"
#include "base/text_file.hpp"
#include "drawing/film_file.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn::rendering {
namespace {

/// Number of the film's frames that show some figure.
int frames_shown(const std::vector<Figure>& figures, double fps) {
  double longest_s = 0;
  for (const Figure& figure : figures)
    longest_s = std::max(longest_s, static_cast<double>(figure.points.rows()) / figure.fps);
  constexpr double kMost = 1e9;  // the film ends before
  return std::max(1, static_cast<int>(std::min(kMost, std::round(longest_s * fps))));
}

/// The camera as it filmed the film's pictures, of whatever size.
class FilmCamera {
 public:
  /// @param notices collects once that the camera was scaled; may be none
  FilmCamera(const Camera& camera, const FilmReader& film, std::vector<std::string>* notices)
      : camera_(camera), film_(film.path().string()), notices_(notices) {}

  /// @throws InputError where they have another shape: figures would not lie where they were seen
  Camera of(const cv::Size& picture) {
    std::vector<std::string> notices;
    return with_name(film_, [&] {
      Camera own = of_scaled_images(camera_, picture.width, picture.height, &notices);
      if (auto* to = std::exchange(notices_, nullptr))
        for (const std::string& notice : notices) to->push_back(film_ + ": " + notice);
      return own;
    });
  }

 private:
  const Camera& camera_;
  std::string film_;
  std::vector<std::string>* notices_;
};

void draw_figures(cv::Mat& image, const std::vector<Figure>& figures, FilmCamera& camera,
                  double t_s) {
  const Camera own = camera.of(image.size());
  for (const Figure& figure : figures)
    draw_figure(image, own, figure, figure.frame_at(t_s), Palette::second);
}

/// @return number of the film's frames, `frames` or fewer if it ends before
int write_film(FilmReader& film, int frames, const std::vector<Figure>& figures, FilmCamera& camera,
               const std::filesystem::path& path) {
  FilmWriter writer(path, film.fps());
  for (int i = 0; i < frames; ++i) {
    check_interruption();
    cv::Mat image = film.next();
    if (image.empty()) break;
    draw_figures(image, figures, camera, i / film.fps());
    writer.write(image);
  }
  if (writer.frames() == 0)
    throw InputError(fmt::format("{}: has no frame to draw over", film.path().string()));
  writer.finish();
  return writer.frames();
}

/// Two rows of frames at even times, the last of which is the last one.
/// @return as write_film
int write_sheet(FilmReader& film, int frames, const std::vector<Figure>& figures,
                FilmCamera& camera, const std::filesystem::path& path, int columns) {
  constexpr int kWidth_px = 640;
  std::vector<cv::Mat> strips(2);
  const int times = 2 * columns;
  int shown = 0, i = 0;
  for (; i < frames && shown < times; ++i) {
    check_interruption();
    cv::Mat image = film.next();
    if (image.empty()) break;
    if (i < shown * (frames - 1) / std::max(1, times - 1)) continue;
    draw_figures(image, figures, camera, i / film.fps());
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
  return i;
}

/// Frames are matched by time: of other rates they drift apart if they were the same.
void note_other_rate(const FilmReader& film, const std::vector<Figure>& figures,
                     std::vector<std::string>& notices) {
  constexpr double kSameRate = 0.001;  // 29.97 and 30 frames a second differ by more
  const auto other = std::ranges::find_if(figures, [&](const Figure& figure) {
    return std::abs(figure.fps / film.fps() - 1) > kSameRate;
  });
  if (other == figures.end()) return;
  notices.push_back(fmt::format(
      "{}: it has {:.5g} frames a second, the motion {:.5g}, and they are drawn by time; if the "
      "motion's frames are the film's, regenerate it with `fps` {:.5g}",
      film.path().string(), film.fps(), other->fps, film.fps()));
}

void note_early_end(const FilmReader& film, int missing_frames, std::vector<std::string>& notices) {
  if (missing_frames == 0) return;
  notices.push_back(
      fmt::format("{}: it ends {:.2f} s before the motion does, the rest of which is not drawn",
                  film.path().string(), missing_frames / film.fps()));
}

}  // namespace

void render_over(const std::vector<Figure>& figures, const std::filesystem::path& path,
                 const RenderOptions& options, std::vector<std::string>* notices) {
  if (!options.camera)
    throw ConfigError(
        "a film is drawn over through the camera that filmed it: give `camera`; where there is no "
        "calibration, regenerate's `write-camera` writes the one that it found");
  FilmReader film(options.over, options.over_from);
  FilmCamera camera(*options.camera, film, notices);
  const int frames = frames_shown(figures, film.fps());
  const int drawn = path.extension() == ".png"
                        ? write_sheet(film, frames, figures, camera, path, options.sheet_columns)
                        : write_film(film, frames, figures, camera, path);
  if (notices == nullptr) return;
  note_other_rate(film, figures, *notices);
  note_early_end(film, frames - drawn, *notices);
}

}  // namespace mcdbn::rendering
