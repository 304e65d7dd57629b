#include "mcdbn/formats/frame_stream.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "formats/bvh_header.hpp"
#include "formats/csv_text.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

void put(std::ostream& out, const std::string& text) {
  out << text << std::flush;
  if (!out) throw InputError("a frame cannot be written; is the disk full, or the reader gone?");
}

/// Where each joint is. @return [1 x 3·joints]
RowVectorD places_of(const Skeleton& skeleton, const RowVectorD& channels) {
  return joint_positions({skeleton, 1, channels}).row(0);
}

class BvhStream : public FrameStream {
 public:
  BvhStream(std::ostream& out, double fps, bool rewritable)
      : out_(out), fps_(fps), rewritable_(rewritable) {}

  void write(const Skeleton& skeleton, const RowVectorD& channels, bool) override {
    std::string text;
    if (frames_ == 0) {
      start_ = out_.tellp();
      text = before_frames(skeleton, 1);
      size_ = text.size();
    }
    skeleton_ = skeleton;
    for (Eigen::Index column = 0; column < channels.size(); ++column)
      fmt::format_to(std::back_inserter(text), "{}{:.6f}", column > 0 ? " " : "", channels[column]);
    text += '\n';
    put(out_, text);
    ++frames_;
  }

  void finish() override {
    if (!rewritable_ || frames_ == 0) return;
    const std::string text = before_frames(skeleton_, frames_);
    if (text.size() != size_) return;  // bones of kilometres: the first frame's stay
    out_.seekp(start_);
    put(out_, text);
    out_.seekp(0, std::ios::end);
  }

 private:
  std::string before_frames(const Skeleton& skeleton, long long frames) const {
    return fmt::format("{}MOTION\nFrames: {:<12}\nFrame Time: {}\n",
                       bvh_header_text_of_fixed_width(skeleton), frames, 1 / fps_);
  }

  std::ostream& out_;
  double fps_;
  bool rewritable_;
  std::ostream::pos_type start_ = 0;
  std::size_t size_ = 0;
  long long frames_ = 0;
  Skeleton skeleton_;
};

/// A text for each frame, with its number and time.
class NumberedStream : public FrameStream {
 public:
  NumberedStream(std::ostream& out, double fps) : out_(out), fps_(fps) {}
  void finish() override {}

 protected:
  long long frame() const { return frames_; }
  double time_s() const { return static_cast<double>(frames_) / fps_; }
  void put_frame(const std::string& text) {
    put(out_, text);
    ++frames_;
  }

 private:
  std::ostream& out_;
  double fps_;
  long long frames_ = 0;
};

class CsvStream : public NumberedStream {
 public:
  using NumberedStream::NumberedStream;

  void write(const Skeleton& skeleton, const RowVectorD& channels, bool) override {
    std::string text;
    if (frame() == 0) {
      text = "frame,time_s";
      for (const Joint& joint : skeleton.joints) {
        require_csv_name(joint.name);
        text += fmt::format(",{0}_x,{0}_y,{0}_z", joint.name);
      }
      text += '\n';
    }
    text += fmt::format("{},{}", frame(), time_cell(time_s()));
    for (const double place : places_of(skeleton, channels)) text += fmt::format(",{:.6g}", place);
    text += '\n';
    put_frame(text);
  }
};

class JsonStream : public NumberedStream {
 public:
  using NumberedStream::NumberedStream;

  void write(const Skeleton& skeleton, const RowVectorD& channels, bool seen) override {
    const RowVectorD places = places_of(skeleton, channels);
    nlohmann::ordered_json joints = nlohmann::ordered_json::object();
    for (Eigen::Index j = 0; j < skeleton.joint_count(); ++j)
      joints[skeleton.joints[static_cast<std::size_t>(j)].name] = {places[3 * j], places[3 * j + 1],
                                                                   places[3 * j + 2]};
    const nlohmann::ordered_json line = {
        {"frame", frame()},
        {"time_s", time_s()},
        {"seen", seen},
        {"channels", std::vector<double>(channels.begin(), channels.end())},
        {"joints", std::move(joints)}};
    put_frame(line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  }
};

}  // namespace

std::unique_ptr<FrameStream> bvh_stream(std::ostream& out, double fps, bool rewritable) {
  return std::make_unique<BvhStream>(out, fps, rewritable);
}
std::unique_ptr<FrameStream> csv_stream(std::ostream& out, double fps) {
  return std::make_unique<CsvStream>(out, fps);
}
std::unique_ptr<FrameStream> json_stream(std::ostream& out, double fps) {
  return std::make_unique<JsonStream>(out, fps);
}

}  // namespace mcdbn
