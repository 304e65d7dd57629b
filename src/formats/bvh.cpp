#include "mcdbn/formats/bvh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/interruption.hpp"
#include "base/text_file.hpp"
#include "formats/bvh_header.hpp"
#include "formats/bvh_parser.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn {
namespace {

using bvh::Cursor;

struct MotionHeader {
  int frames = 0;
  double frame_time_s = 0;
};

MotionHeader parse_motion_header(Cursor& cursor) {
  MotionHeader header;
  cursor.expect("Frames:", "write Frames: and their number after MOTION");
  const double frames = cursor.number("the number of frames");
  if (!(frames >= 1 && frames <= std::numeric_limits<int>::max()) ||
      frames != static_cast<int>(frames)) {
    cursor.fail("the number of frames must be a whole number of at least 1");
  }
  header.frames = static_cast<int>(frames);
  constexpr std::string_view kAdvice = "write Frame Time: and the seconds of one frame";
  cursor.expect("Frame", kAdvice);
  cursor.expect("Time:", kAdvice);
  header.frame_time_s = cursor.number("the seconds of one frame");
  if (!kFrameRate_hz.contains(1 / header.frame_time_s))
    cursor.fail(fmt::format("the frame time must be at least {:g} and at most {:g} seconds",
                            1 / kFrameRate_hz.most, 1 / kFrameRate_hz.least));
  return header;
}

/// Reads the frames as a stream of numbers, since some writers wrap a frame over several lines,
/// and keeps account of the lines so that a short frame can be named.
class FrameReader {
 public:
  FrameReader(Cursor& cursor, int frames, int channels)
      : cursor_(cursor),
        frames_(frames),
        channels_(static_cast<std::size_t>(channels)),
        wanted_(static_cast<std::size_t>(frames) * channels_) {}

  MatrixD read() {
    // A false `Frames:` must not make us ask for memory that its values could never fill.
    values_.reserve(std::min(wanted_, cursor_.bytes_left() / 2 + 1));
    while (values_.size() < wanted_ && !cursor_.at_end()) {
      check_interruption();
      read_line();
    }
    if (values_.size() < wanted_ && odd_line_ == 0) {
      cursor_.fail(
          fmt::format("only {} of the {} frames that Frames: gives, correct it or restore the rest",
                      values_.size() / channels_, frames_));
    }
    if (odd_line_ > 0 && (values_.size() != wanted_ || !cursor_.at_end())) {
      cursor_.fail_at(
          odd_line_,
          fmt::format(
              "{} values on this line and {} channels in the skeleton (and the lines do not "
              "add up to {} frames), restore the missing values or remove the others",
              odd_line_values_, channels_, frames_));
    }
    if (!cursor_.at_end()) {
      cursor_.warn(fmt::format(
          "more lines than the {} frames that Frames: gives, left out from here", frames_));
    }
    return Eigen::Map<const MatrixD>(values_.data(), frames_, static_cast<Eigen::Index>(channels_));
  }

 private:
  void read_line() {
    const std::size_t before = values_.size();
    while (!cursor_.at_line_end()) values_.push_back(cursor_.number("the next channel's value"));
    const std::size_t count = values_.size() - before;
    if (count == channels_ || odd_line_ > 0) return;
    odd_line_ = cursor_.line();
    odd_line_values_ = count;
  }

  Cursor& cursor_;
  int frames_;
  std::size_t channels_, wanted_;
  std::vector<double> values_;
  int odd_line_ = 0;  ///< the first line that does not hold exactly one frame, 0 if none
  std::size_t odd_line_values_ = 0;
};

}  // namespace

Motion parse_bvh(std::string_view text, const std::string& name,
                 std::vector<std::string>* warnings) {
  Cursor cursor(text, name, warnings);
  Motion motion;
  motion.skeleton = bvh::parse_hierarchy(cursor, true);
  const int channels = motion.skeleton.channel_count();
  if (channels == 0) cursor.fail("no joint has CHANNELS, so there is nothing to move");
  const MotionHeader header = parse_motion_header(cursor);
  motion.frame_time_s = header.frame_time_s;
  motion.channels = FrameReader(cursor, header.frames, channels).read();
  return motion;
}

Skeleton read_bvh_skeleton(const std::filesystem::path& path) {
  const std::string text = read_text_file(path);
  Cursor cursor(text, path.string(), nullptr);
  return bvh::parse_hierarchy(cursor, true);
}

Motion read_bvh(const std::filesystem::path& path, std::vector<std::string>* warnings) {
  return parse_bvh(read_text_file(path), path.string(), warnings);
}

}  // namespace mcdbn
