#include "drawing/render_over.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/interruption.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn::rendering {
namespace {

/// The frames of a film from one on, one after another.
class Film {
 public:
  Film(const std::filesystem::path& path, int from) : path_(path) {
    cv::Mat skipped;
    if (!std::filesystem::is_regular_file(path) || !opened())
      throw InputError(fmt::format("{}: is not a film that can be read", path.string()));
    for (int frame = 0; frame < from; ++frame) {
      check_interruption();
      if (!capture_.read(skipped))
        throw InputError(fmt::format("{}: ends before its frame {}", path.string(), from));
    }
  }
  double fps() const {
    constexpr double kUsual = 30;
    const double fps = capture_.get(cv::CAP_PROP_FPS);
    if (fps > 0 && !kFrameRate_hz.contains(fps))
      throw InputError(fmt::format("{}: says {:g} frames a second, which must be {}",
                                   path_.string(), fps, kFrameRate_hz.text()));
    return fps > 0 ? fps : kUsual;
  }
  /// An empty image where the film ends.
  cv::Mat next() {
    cv::Mat image;
    capture_.read(image);
    return image;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  /// By what reads films alone: asked for anything, OpenCV takes the name of a file that is none
  /// for a camera's, and looks for that on USB. Its own words about it are not shown.
  bool opened() {
    namespace logging = cv::utils::logging;
    const logging::LogLevel level = logging::setLogLevel(logging::LOG_LEVEL_SILENT);
    const bool opened = std::ranges::any_of(
        std::array{cv::CAP_FFMPEG, cv::CAP_GSTREAMER, cv::CAP_OPENCV_MJPEG},
        [&](cv::VideoCaptureAPIs reader) { return capture_.open(path_.string(), reader); });
    logging::setLogLevel(level);
    return opened;
  }

  std::filesystem::path path_;
  cv::VideoCapture capture_;
};

/// So many frames of the film show some figure.
int frames_shown(const std::vector<Figure>& figures, double fps) {
  double longest_s = 0;
  for (const Figure& figure : figures)
    longest_s = std::max(longest_s, static_cast<double>(figure.points.rows()) / figure.fps);
  return std::max(1, static_cast<int>(std::lround(longest_s * fps)));
}

void draw_figures(cv::Mat& image, const std::vector<Figure>& figures, const Camera& camera,
                  double t_s) {
  const Camera own = scaled(camera, image.cols, image.rows);
  for (const Figure& figure : figures)
    draw_figure(image, own, figure, figure.frame_at(t_s), Palette::second);
}

void write_film(Film& film, int frames, const std::vector<Figure>& figures, const Camera& camera,
                const std::filesystem::path& path) {
  OutputFile file(path);
  cv::VideoWriter writer;
  for (int i = 0; i < frames; ++i) {
    check_interruption();
    cv::Mat image = film.next();
    if (image.empty()) break;
    draw_figures(image, figures, camera, i / film.fps());
    if (!writer.isOpened() &&
        !writer.open(file.temporary().string(), cv::VideoWriter::fourcc('m', 'p', '4', 'v'),
                     film.fps(), image.size()))
      throw InputError(fmt::format("{}: the video cannot be opened for writing", path.string()));
    writer.write(image);
  }
  if (!writer.isOpened())
    throw InputError(fmt::format("{}: has no frame to draw over", film.path().string()));
  writer.release();
  file.put_in_place();
}

/// Two rows of frames at even times.
void write_sheet(Film& film, int frames, const std::vector<Figure>& figures, const Camera& camera,
                 const std::filesystem::path& path, int columns) {
  constexpr int kWidth_px = 640;
  std::vector<cv::Mat> strips(2);
  const int times = 2 * columns;
  int shown = 0;
  for (int i = 0; i < frames && shown < times; ++i) {
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
}

}  // namespace

void render_over(const std::vector<Figure>& figures, const std::filesystem::path& path,
                 const RenderOptions& options) {
  if (!options.camera)
    throw ConfigError("a film is drawn over through the camera that filmed it; give one");
  Film film(options.over, options.over_from);
  const int frames = frames_shown(figures, film.fps());
  if (path.extension() == ".png")
    write_sheet(film, frames, figures, *options.camera, path, options.sheet_columns);
  else
    write_film(film, frames, figures, *options.camera, path);
}

}  // namespace mcdbn::rendering
