#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <system_error>

#include "mcdbn/base/errors.hpp"

namespace mcdbn::rendering {

/// A file that is written beside its final path; removed again unless it was put there.
class PartialFile {
 public:
  explicit PartialFile(const std::filesystem::path& path)
      : path_(path),
        temporary_(path.parent_path() / fmt::format(".{}.{}.tmp{}", path.stem().string(),
                                                    ::getpid(), path.extension().string())) {}
  ~PartialFile() {
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  void put_in_place() const {
    std::error_code error;
    std::filesystem::rename(temporary_, path_, error);
    if (error) {
      throw InputError(fmt::format("{}: cannot be put in place ({}); choose another output path",
                                   path_.string(), error.message()));
    }
  }

 private:
  std::filesystem::path path_, temporary_;
};

}  // namespace mcdbn::rendering
