#include "line_source.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/interruption.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn::cli {
namespace {

constexpr int kLookEvery_ms = 50;
/// No frame is that long.
constexpr std::size_t kLongestLine = std::size_t{1} << 24;

}  // namespace

LineSource::LineSource(const std::filesystem::path& path)
    : name_(path == "-" ? "standard input" : path.string()) {
  if (path == "-") return;
  struct stat what {};
  // Opening a pipe without a writer yet would wait for one, and not for Ctrl-C.
  const bool is_pipe = ::stat(path.c_str(), &what) == 0 && S_ISFIFO(what.st_mode);
  file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | (is_pipe ? O_NONBLOCK : 0));
  if (file_ < 0)
    throw InputError(fmt::format("{}: cannot be opened: {}", name_, std::strerror(errno)));
}

LineSource::~LineSource() {
  if (file_ > 0) ::close(file_);
}

/// @return false: nothing came within a while, or nothing will
bool LineSource::read_more() {
  pollfd wanted{file_, POLLIN, 0};
  const int ready = ::poll(&wanted, 1, kLookEvery_ms);
  if (ready == 0 || (ready < 0 && errno == EINTR)) return false;
  std::array<char, 1 << 16> piece;
  const ssize_t count = ::read(file_, piece.data(), piece.size());
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  if (count < 0)
    throw InputError(fmt::format("{}: cannot be read: {}", name_, std::strerror(errno)));
  ended_ = count == 0;  // poll waits for a pipe's first writer
  buffer_.append(piece.data(), static_cast<std::size_t>(count));
  return true;
}

std::optional<std::string> LineSource::next() {
  for (std::size_t searched = at_;;) {
    if (interruption_requested()) return {};
    if (const std::size_t end = buffer_.find('\n', searched); end != std::string::npos) {
      std::string line = buffer_.substr(at_, end - at_);
      at_ = end + 1;
      return line;
    }
    searched = buffer_.size();
    if (ended_) {
      if (at_ == buffer_.size()) return {};
      std::string line = buffer_.substr(at_);
      at_ = buffer_.size();
      return line;
    }
    if (searched - at_ > kLongestLine)
      throw InputError(fmt::format("{}: a line of more than {} bytes", name_, kLongestLine));
    buffer_.erase(0, at_);
    searched -= at_;
    at_ = 0;
    read_more();
  }
}

}  // namespace mcdbn::cli
