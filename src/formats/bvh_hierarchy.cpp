#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_set>

#include "formats/bvh_parser.hpp"
#include "mcdbn/formats/bvh.hpp"

namespace mcdbn::bvh {
namespace {

/// Far above any body; without a limit a hostile file nests until memory is gone.
constexpr std::size_t kDeepest = 1000;

struct ChannelName {
  std::string_view word;
  Channel channel;
};
constexpr std::array kChannelNames{
    ChannelName{"Xposition", Channel::x_position}, ChannelName{"Yposition", Channel::y_position},
    ChannelName{"Zposition", Channel::z_position}, ChannelName{"Xrotation", Channel::x_rotation},
    ChannelName{"Yrotation", Channel::y_rotation}, ChannelName{"Zrotation", Channel::z_rotation}};

std::optional<Channel> channel_of(std::string_view word) {
  for (const ChannelName& name : kChannelNames) {
    if (same_word(word, name.word)) return name.channel;
  }
  return std::nullopt;
}

/// Builds the skeleton with its own stack of open joints, as files may nest deeper than the
/// program's stack can.
class HierarchyParser {
 public:
  explicit HierarchyParser(Cursor& cursor) : cursor_(cursor) {}

  Skeleton parse(bool motion_follows) {
    cursor_.expect("HIERARCHY", "this is not a BVH file");
    for (;;) {
      const std::string_view word = cursor_.next();
      if (word.empty() || same_word(word, "MOTION")) {
        close(word, motion_follows);
        return std::move(skeleton_);
      }
      statement(word);
    }
  }

 private:
  void statement(std::string_view word) {
    if (same_word(word, "ROOT") || same_word(word, "JOINT")) return open_joint(word);
    if (word == "}") return close_joint();
    const bool known =
        same_word(word, "OFFSET") || same_word(word, "CHANNELS") || same_word(word, "End");
    if (!known) {
      cursor_.fail(fmt::format(
          "{} is unknown here, expected ROOT, JOINT, OFFSET, CHANNELS, End Site, a brace or MOTION",
          shown(word)));
    }
    if (open_.empty()) cursor_.fail(fmt::format("{} stands outside of any joint", shown(word)));
    if (same_word(word, "OFFSET")) return set_offset();
    if (same_word(word, "CHANNELS")) return set_channels();
    add_end_site();
  }

  void open_joint(std::string_view keyword) {
    const bool is_root = same_word(keyword, "ROOT");
    if (is_root && !open_.empty()) cursor_.fail("ROOT stands inside of a joint, use JOINT");
    if (!is_root && open_.empty()) cursor_.fail("JOINT stands outside of ROOT's braces");
    if (is_root && skeleton_.joint_count() > 0) {
      cursor_.fail("a second ROOT, put each skeleton into a file of its own");
    }
    Joint joint;
    joint.name = cursor_.rest_of_line();
    if (joint.name.empty()) cursor_.fail(fmt::format("{} without a name", shown(keyword)));
    if (!names_.insert(joint.name).second) {
      cursor_.warn(fmt::format("a second joint named {}, only the first is found by name",
                               shown(joint.name)));
    }
    joint.parent = open_.empty() ? -1 : open_.back().joint;
    cursor_.expect("{", "open the joint with a brace");
    if (open_.size() >= kDeepest) {
      cursor_.fail(fmt::format("joints are nested deeper than {}: not a body", kDeepest));
    }
    open_.push_back({skeleton_.joint_count()});
    skeleton_.joints.push_back(std::move(joint));
  }

  void close_joint() {
    if (open_.empty()) cursor_.fail("a closing brace too many, delete it");
    if (!open_.back().has_offset) {
      cursor_.warn(fmt::format("joint {} has no OFFSET, taken as 0 0 0", shown(current().name)));
    }
    open_.pop_back();
  }

  void set_offset() {
    if (open_.back().has_offset) {
      cursor_.fail(fmt::format("joint {} has a second OFFSET", shown(current().name)));
    }
    open_.back().has_offset = true;
    current().offset = read_offset();
  }

  void set_channels() {
    if (open_.back().has_channels) {
      cursor_.fail(fmt::format("joint {} has CHANNELS twice", shown(current().name)));
    }
    open_.back().has_channels = true;
    const double count = cursor_.number("the count of channels");
    if (!(count >= 0 && count <= 6 && count == static_cast<int>(count))) {
      cursor_.fail("the count of channels must be a whole number from 0 to 6");
    }
    for (int i = 0; i < static_cast<int>(count); ++i) add_channel();
  }

  void add_channel() {
    const std::string_view word = cursor_.next();
    const std::optional<Channel> channel = channel_of(word);
    if (!channel) {
      cursor_.fail(fmt::format(
          "unknown channel {}, there are X, Y and Z each followed by position or rotation",
          shown(word)));
    }
    std::vector<Channel>& channels = current().channels;
    if (std::find(channels.begin(), channels.end(), *channel) != channels.end()) {
      cursor_.fail(fmt::format("channel {} twice in one joint", shown(word)));
    }
    channels.push_back(*channel);
  }

  void add_end_site() {
    cursor_.expect("Site", "write End Site");
    cursor_.rest_of_line();  // some writers name their End Sites
    cursor_.expect("{", "open the End Site with a brace");
    cursor_.expect("OFFSET", "an End Site holds an OFFSET alone");
    current().end_sites.push_back(read_offset());
    cursor_.expect("}", "close the End Site with a brace");
  }

  Eigen::Vector3d read_offset() {
    Eigen::Vector3d offset;
    for (double& value : offset) value = cursor_.number("one of an OFFSET's three numbers");
    return offset;
  }

  /// @param word MOTION, or empty at the end of the text
  void close(std::string_view word, bool motion_follows) {
    if (word.empty() && motion_follows) {
      cursor_.fail("the file ends without MOTION, export it again with its frames");
    }
    if (!open_.empty()) {
      cursor_.fail(
          fmt::format("joint {} is still open, a closing brace is missing", shown(current().name)));
    }
    if (skeleton_.joints.empty()) cursor_.fail("a hierarchy without ROOT holds no joint");
  }

  Joint& current() { return skeleton_.joints[open_.back().joint]; }

  struct OpenJoint {
    int joint;
    bool has_offset = false, has_channels = false;
  };
  Cursor& cursor_;
  Skeleton skeleton_;
  std::vector<OpenJoint> open_;
  std::unordered_set<std::string> names_;
};

}  // namespace

Skeleton parse_hierarchy(Cursor& cursor, bool motion_follows) {
  return HierarchyParser(cursor).parse(motion_follows);
}

std::string_view channel_word(Channel channel) {
  return kChannelNames[static_cast<std::size_t>(channel)].word;
}

}  // namespace mcdbn::bvh

namespace mcdbn {

Skeleton parse_bvh_header(std::string_view text, const std::string& name) {
  bvh::Cursor cursor(text, name, nullptr);
  return bvh::parse_hierarchy(cursor, false);
}

}  // namespace mcdbn
