#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mcdbn::cli {

/// Lines of a file, a pipe or standard input, as they are written. Ctrl-C ends the wait for one.
class LineSource {
 public:
  /// @param path "-": standard input  @throws InputError if it cannot be opened
  explicit LineSource(const std::filesystem::path& path);
  ~LineSource();
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;

  /// Without the line break; none: the input has ended, or a stop was requested.
  /// @throws InputError if it cannot be read
  std::optional<std::string> next();

 private:
  bool read_more();

  std::string name_;
  int file_ = 0;
  bool ended_ = false;
  std::string buffer_;
  std::size_t at_ = 0;  ///< where the next line begins
};

}  // namespace mcdbn::cli
