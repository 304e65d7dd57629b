#pragma once

#include <filesystem>
#include <opencv2/videoio.hpp>

#include "base/output_file.hpp"

namespace mcdbn::rendering {

/// The nearest rate that an MPEG-4 film can have: it divides a second into 65535 ticks at most.
/// Within 0.01 %, of 6 frames a second and more.
double rate_of_film_hz(double fps);

/// A film that is written, as MPEG-4.
class FilmWriter {
 public:
  /// @param fps frames a second; the film gets rate_of_film_hz of it
  FilmWriter(std::filesystem::path path, double fps);
  /// At which the film runs.
  double fps() const { return fps_; }
  /// @param image of the first one's size  @throws InputError if no film can be written there
  void write(const cv::Mat& image);
  int frames() const { return frames_; }
  /// Puts the film in place. @throws InputError if it is not whole: OpenCV does not report a full
  /// disk
  void finish();

 private:
  std::filesystem::path path_;
  double fps_;
  OutputFile file_;
  cv::VideoWriter writer_;
  int frames_ = 0;
};

/// The frames of a film from one on, one after another.
class FilmReader {
 public:
  /// @throws InputError if it cannot be read, has fewer frames, or is no film by its first bytes:
  /// lists of films, which OpenCV takes too, name files and addresses of their own
  FilmReader(const std::filesystem::path& path, int from);
  /// @throws InputError if it gives a rate that no film has
  double fps() const;
  /// An empty image where the film ends.
  cv::Mat next();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  cv::VideoCapture capture_;
};

/// How many frames so many seconds have: one at least. @throws InputError if there are too
/// many for a film
int film_frames(double duration_s, double fps, const std::filesystem::path& path);

}  // namespace mcdbn::rendering
