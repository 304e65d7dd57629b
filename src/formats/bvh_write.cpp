#include <fmt/format.h>

#include <iterator>

#include "base/interruption.hpp"
#include "base/text_file.hpp"
#include "formats/bvh_header.hpp"
#include "formats/bvh_parser.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"

namespace mcdbn {
namespace {

/// Writes a hierarchy joint by joint with its own stack of open joints.
class HierarchyWriter {
 public:
  explicit HierarchyWriter(const Skeleton& skeleton, bool fixed_width = false)
      : skeleton_(skeleton), fixed_width_(fixed_width) {}

  std::string write() {
    text_ = "HIERARCHY\n";
    for (int joint = 0; joint < skeleton_.joint_count(); ++joint) {
      close_down_to(skeleton_.joints[joint].parent);
      if (open_.empty() && joint > 0) {
        throw ShapeError("bvh_header_text: the joints do not stand in depth-first order");
      }
      open(joint);
    }
    close_down_to(-1);
    return std::move(text_);
  }

 private:
  void open(int index) {
    const Joint& joint = skeleton_.joints[index];
    line(fmt::format("{} {}", index == 0 ? "ROOT" : "JOINT", joint.name));
    line("{");
    open_.push_back(index);
    line(offset_text(joint.offset));
    std::string channels = fmt::format("CHANNELS {}", joint.channels.size());
    for (const Channel channel : joint.channels) {
      fmt::format_to(std::back_inserter(channels), " {}", bvh::channel_word(channel));
    }
    line(channels);
    for (const Eigen::Vector3d& site : joint.end_sites) {
      line("End Site");
      line("{");
      line(fmt::format("\t{}", offset_text(site)));
      line("}");
    }
  }

  void close_down_to(int parent) {
    while (!open_.empty() && open_.back() != parent) {
      open_.pop_back();
      line("}");
    }
  }

  std::string offset_text(const Eigen::Vector3d& offset) const {
    if (fixed_width_)
      return fmt::format("OFFSET {:14.6f} {:14.6f} {:14.6f}", offset.x(), offset.y(), offset.z());
    return fmt::format("OFFSET {} {} {}", offset.x(), offset.y(), offset.z());
  }

  void line(std::string_view text) {
    text_.append(open_.size(), '\t').append(text).push_back('\n');
  }

  const Skeleton& skeleton_;
  bool fixed_width_;
  std::string text_;
  std::vector<int> open_;
};

}  // namespace

std::string bvh_header_text(const Skeleton& skeleton) {
  return HierarchyWriter(skeleton).write();
}

std::string bvh_header_text_of_fixed_width(const Skeleton& skeleton) {
  return HierarchyWriter(skeleton, true).write();
}

std::string bvh_text(const Motion& motion) {
  if (motion.channels.cols() != motion.skeleton.channel_count()) {
    throw ShapeError(fmt::format("bvh_text: {} columns for a skeleton of {} channels",
                                 motion.channels.cols(), motion.skeleton.channel_count()));
  }
  std::string text = bvh_header_text(motion.skeleton);
  auto out = std::back_inserter(text);
  fmt::format_to(out, "MOTION\nFrames: {}\nFrame Time: {}\n", motion.frames(), motion.frame_time_s);
  for (int frame = 0; frame < motion.frames(); ++frame) {
    check_interruption();
    for (Eigen::Index column = 0; column < motion.channels.cols(); ++column) {
      fmt::format_to(out, "{}{:.6f}", column > 0 ? " " : "", motion.channels(frame, column));
    }
    text.push_back('\n');
  }
  return text;
}

void write_bvh(const std::filesystem::path& path, const Motion& motion) {
  write_text_file(path, bvh_text(motion));
}

}  // namespace mcdbn
