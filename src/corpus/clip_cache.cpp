#include "corpus/clip_cache.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/interruption.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;
namespace ipc = boost::interprocess;
using nlohmann::json;

/// Behind the JSON, at the end of the file.
struct Trailer {
  std::array<char, 8> magic{'m', 'c', 'd', 'b', 'n', 'c', 'l', '1'};
  std::uint64_t json_bytes = 0, json_checksum = 0;
};

/// FNV-1a over numbers of 8 bytes.
class Checksum {
 public:
  void add(const double* numbers, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, numbers + i, sizeof bits);
      add(bits);
    }
  }
  void add(const std::string& text) {
    for (const char letter : text) add(static_cast<unsigned char>(letter));
  }
  std::uint64_t value() const { return value_; }

 private:
  void add(std::uint64_t bits) {
    constexpr std::uint64_t kPrime = 0x100000001b3;
    value_ = (value_ ^ bits) * kPrime;
    value_ ^= value_ >> 29;  // the product alone never moves high bits down
  }
  std::uint64_t value_ = 0xcbf29ce484222325;
};

json vector_json(const Eigen::Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

Eigen::Vector3d vector_from(const json& numbers) {
  return {numbers.at(0).get<double>(), numbers.at(1).get<double>(), numbers.at(2).get<double>()};
}

json skeleton_json(const Skeleton& skeleton) {
  json joints = json::array();
  for (const Joint& joint : skeleton.joints) {
    json ends = json::array();
    for (const Eigen::Vector3d& end : joint.end_sites) ends.push_back(vector_json(end));
    joints.push_back({{"name", joint.name},
                      {"parent", joint.parent},
                      {"offset", vector_json(joint.offset)},
                      {"channels", joint.channels},
                      {"end_sites", ends}});
  }
  return joints;
}

Skeleton skeleton_from(const json& joints) {
  Skeleton skeleton;
  for (const json& entry : joints) {
    Joint joint{entry.at("name"),
                entry.at("parent"),
                vector_from(entry.at("offset")),
                entry.at("channels"),
                {}};
    for (const json& end : entry.at("end_sites")) joint.end_sites.push_back(vector_from(end));
    skeleton.joints.push_back(std::move(joint));
  }
  return skeleton;
}

/// A clip's numbers in the mapped file.
struct Extent {
  std::uint64_t first_byte = 0;
  Eigen::Index frames = 0, channels = 0;
  std::uint64_t checksum = 0;

  std::size_t count() const { return static_cast<std::size_t>(frames * channels); }
};

class MappedChannels : public ClipChannels {
 public:
  MappedChannels(ipc::mapped_region region, std::vector<Extent> extents)
      : region_(std::move(region)), extents_(std::move(extents)) {}

  MatrixD rows(std::size_t clip, int first, int frames) const override {
    const Extent& extent = extents_[clip];
    MatrixD result = Eigen::Map<const MatrixD>(numbers(extent), extent.frames, extent.channels)
                         .middleRows(first, frames);
    has_read(static_cast<std::size_t>(result.size()) * sizeof(double));
    return result;
  }

  bool is_whole(std::size_t clip) const {
    Checksum checksum;
    checksum.add(numbers(extents_[clip]), extents_[clip].count());
    has_read(extents_[clip].count() * sizeof(double));
    return checksum.value() == extents_[clip].checksum;
  }

 private:
  const double* numbers(const Extent& extent) const {
    const void* first = static_cast<const char*>(region_.get_address()) + extent.first_byte;
    return static_cast<const double*>(first);
  }
  /// Pages that were read stay with the process until it gives them back.
  void has_read(std::size_t bytes) const {
    constexpr std::size_t kMost = 128U << 20U;
    if ((read_ += bytes) < kMost) return;
    read_ = 0;
    // Not Boost's advise(): posix_madvise does nothing in glibc for what is not needed.
    ::madvise(region_.get_address(), region_.get_size(), MADV_DONTNEED);
  }

  ipc::mapped_region region_;
  std::vector<Extent> extents_;
  mutable std::atomic<std::size_t> read_ = 0;
};

[[noreturn]] void fail_damaged(const fs::path& path) {
  throw InputError(fmt::format("{}: no cache of clips, or a damaged one", path.string()));
}

json read_contents(const fs::path& path, const ipc::mapped_region& region) {
  Trailer trailer;
  const std::string_view bytes(static_cast<const char*>(region.get_address()), region.get_size());
  if (bytes.size() < sizeof trailer) fail_damaged(path);
  std::memcpy(&trailer, bytes.data() + bytes.size() - sizeof trailer, sizeof trailer);
  const std::size_t before = bytes.size() - sizeof trailer;
  if (trailer.magic != Trailer{}.magic || trailer.json_bytes > before) fail_damaged(path);
  const std::string text(bytes.substr(before - trailer.json_bytes, trailer.json_bytes));
  Checksum checksum;
  checksum.add(text);
  if (checksum.value() != trailer.json_checksum) fail_damaged(path);
  return json::parse(text);
}

ipc::mapped_region mapped(const fs::path& path) {
  try {
    const ipc::file_mapping file(path.c_str(), ipc::read_only);
    return {file, ipc::read_only};
  } catch (const ipc::interprocess_exception&) {
    fail_damaged(path);
  }
}

}  // namespace

ClipCacheWriter::ClipCacheWriter(fs::path path, std::string key)
    : path_(std::move(path)),
      temporary_(fmt::format("{}.{}.part", path_.string(), ::getpid())),
      key_(std::move(key)),
      stream_(temporary_, std::ios::binary | std::ios::trunc) {}

ClipCacheWriter::~ClipCacheWriter() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void ClipCacheWriter::write(const void* bytes, std::size_t count) {
  stream_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
  if (!stream_)
    throw InputError(
        fmt::format("{}: cannot be written: make room, or use another folder", path_.string()));
  written_ += count;
}

void ClipCacheWriter::add(const LoadedClip& clip) {
  const Motion& motion = clip.motion;
  const auto count = static_cast<std::size_t>(motion.channels.size());
  Checksum checksum;
  checksum.add(motion.channels.data(), count);
  entries_.push_back({{clip.clip, motion.skeleton, motion.frame_time_s, motion.frames()},
                      written_,
                      checksum.value()});
  write(motion.channels.data(), count * sizeof(double));
}

void ClipCacheWriter::write_contents() {
  json contents = {{"key", key_}, {"clips", json::array()}};
  for (const Entry& entry : entries_) {
    const ClipRecord& record = entry.record;
    contents["clips"].push_back({{"path", record.clip.path},
                                 {"fingerprint", record.clip.fingerprint},
                                 {"former_fingerprint", record.clip.former_fingerprint},
                                 {"person", record.clip.person},
                                 {"action", record.clip.action},
                                 {"skeleton", skeleton_json(record.skeleton)},
                                 {"frame_time_s", record.frame_time_s},
                                 {"frames", record.frames},
                                 {"first_byte", entry.first_byte},
                                 {"checksum", entry.checksum}});
  }
  const std::string text = contents.dump();
  Checksum checksum;
  checksum.add(text);
  Trailer trailer;
  trailer.json_bytes = text.size();
  trailer.json_checksum = checksum.value();
  write(text.data(), text.size());
  write(&trailer, sizeof trailer);
  stream_.close();
  if (!stream_) throw InputError(fmt::format("{}: cannot be written", path_.string()));
}

ClipStore ClipCacheWriter::finish() {
  write_contents();
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) throw InputError(fmt::format("{}: cannot be written", path_.string()));
  return open_clip_cache(path_, key_);
}

ClipStore ClipCacheWriter::finish_without_place() {
  write_contents();
  ClipStore clips = open_clip_cache(temporary_, key_);
  std::error_code ignored;
  fs::remove(temporary_, ignored);  // what is mapped into memory stays
  return clips;
}

ClipStore open_clip_cache(const fs::path& path, const std::string& key) {
  ipc::mapped_region region = mapped(path);
  std::vector<ClipRecord> records;
  std::vector<Extent> extents;
  try {
    const json contents = read_contents(path, region);
    if (contents.at("key") != key)
      throw InputError(fmt::format("{}: a cache of other clips or settings", path.string()));
    for (const json& entry : contents.at("clips")) {
      records.push_back({{entry.at("path"), entry.at("fingerprint"), entry.at("former_fingerprint"),
                          entry.at("person"), entry.at("action")},
                         skeleton_from(entry.at("skeleton")),
                         entry.at("frame_time_s"),
                         entry.at("frames")});
      extents.push_back({entry.at("first_byte"), records.back().frames,
                         records.back().skeleton.channel_count(), entry.at("checksum")});
      if (extents.back().first_byte + extents.back().count() * sizeof(double) > region.get_size())
        fail_damaged(path);
    }
  } catch (const json::exception&) {
    fail_damaged(path);
  }
  auto channels = std::make_shared<MappedChannels>(std::move(region), std::move(extents));
  for (std::size_t i = 0; i < records.size(); ++i) {
    check_interruption();
    if (!channels->is_whole(i)) fail_damaged(path);
  }
  return {std::move(records), std::move(channels)};
}

}  // namespace mcdbn
