#include "drawing/film_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <string_view>
#include <utility>

#include "base/interruption.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn::rendering {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

/// Bytes that a kind of film has at a place near its beginning.
struct Mark {
  std::size_t at;
  std::string_view bytes;
};

constexpr std::array kMarks = {
    Mark{4, "ftyp"sv},  // MPEG-4 and QuickTime, which may begin otherwise, too
    Mark{4, "moov"sv},
    Mark{4, "mdat"sv},
    Mark{4, "wide"sv},
    Mark{4, "free"sv},
    Mark{4, "skip"sv},
    Mark{8, "AVI "sv},
    Mark{0, "\x1A\x45\xDF\xA3"sv},  // Matroska, WebM
    Mark{0, "\x00\x00\x01\xBA"sv},  // MPEG
    Mark{0, "\x00\x00\x01\xB3"sv},
    Mark{0, "G\x40"sv},  // MPEG transport stream
    Mark{4, "G\x40"sv},  // the same with times, of camcorders
    Mark{0, "FLV"sv},
    Mark{0, "OggS"sv},
    Mark{0, "\x30\x26\xB2\x75"sv},  // Windows Media
    Mark{0, "GIF8"sv},
};

bool begins_like_a_film(const fs::path& path) {
  std::array<char, 12> first{};
  std::ifstream(path, std::ios::binary).read(first.data(), first.size());
  const std::string_view head(first.data(), first.size());
  return std::ranges::any_of(
      kMarks, [&](const Mark& mark) { return head.substr(mark.at).starts_with(mark.bytes); });
}

/// By what reads films alone: asked for anything, OpenCV takes the name of a film that it cannot
/// read for a camera's, and looks for that on USB.
bool open_film(cv::VideoCapture& film, const fs::path& path) {
  return std::ranges::any_of(
      std::array{cv::CAP_FFMPEG, cv::CAP_GSTREAMER, cv::CAP_OPENCV_MJPEG},
      [&](cv::VideoCaptureAPIs reader) { return film.open(path.string(), reader); });
}

bool is_whole(const fs::path& path, int frames) {
  cv::VideoCapture film;
  return open_film(film, path) &&
         static_cast<int>(std::lround(film.get(cv::CAP_PROP_FRAME_COUNT))) == frames;
}

}  // namespace

double rate_of_film_hz(double fps) {
  // A second has as many ticks, of which a frame takes a power of ten: so OpenCV writes it.
  constexpr double kMostTicks = 65535;
  double of_frame = 1000;
  while (of_frame > 1 && std::round(fps * of_frame) > kMostTicks) of_frame /= 10;
  return std::round(fps * of_frame) / of_frame;
}

FilmWriter::FilmWriter(fs::path path, double fps)
    : path_(std::move(path)), fps_(rate_of_film_hz(fps)), file_(path_) {}

void FilmWriter::write(const cv::Mat& image) {
  if (frames_ == 0 &&
      !writer_.open(file_.temporary().string(), cv::VideoWriter::fourcc('m', 'p', '4', 'v'), fps_,
                    image.size()))
    throw InputError(fmt::format(
        "{}: the video cannot be opened for writing; check that its folder exists and is "
        "writable, or write a .png instead",
        path_.string()));
  writer_.write(image);
  ++frames_;
}

void FilmWriter::finish() {
  writer_.release();
  if (!is_whole(file_.temporary(), frames_))
    throw InputError(
        fmt::format("{}: cannot be written to its end; is the disk full?", path_.string()));
  file_.put_in_place();
}

FilmReader::FilmReader(const fs::path& path, int from) : path_(path) {
  cv::Mat skipped;
  if (!fs::is_regular_file(path) || !begins_like_a_film(path) || !open_film(capture_, path))
    throw InputError(fmt::format("{}: is not a film that can be read", path.string()));
  for (int frame = 0; frame < from; ++frame) {
    check_interruption();
    if (!capture_.read(skipped))
      throw InputError(fmt::format("{}: ends before its frame {}", path.string(), from));
  }
}

double FilmReader::fps() const {
  constexpr double kUsual = 30;
  const double fps = capture_.get(cv::CAP_PROP_FPS);
  if (fps > 0 && !kFrameRate_hz.contains(fps))
    throw InputError(fmt::format("{}: gives {:g} frames a second, which must be {}", path_.string(),
                                 fps, kFrameRate_hz.text()));
  return fps > 0 ? fps : kUsual;
}

cv::Mat FilmReader::next() {
  cv::Mat image;
  capture_.read(image);
  return image;
}

int film_frames(double duration_s, double fps, const fs::path& path) {
  constexpr double kMost = 1e7;
  const double frames = std::round(duration_s * fps);
  if (frames > kMost)
    throw InputError(
        fmt::format("{}: would have {:.0f} frames, {:.0f} are the most; draw a .png, "
                    "or correct the clip's frame time",
                    path.string(), frames, kMost));
  return std::max(1, static_cast<int>(frames));
}

}  // namespace mcdbn::rendering
