#pragma once

#include <filesystem>

namespace mcdbn {

/// Keeps a folder for one program at a time, by a file `lock` in it that names its owner: process,
/// host and since when. The system's own lock on that file (flock) goes with its process, however
/// that ends: a file whose process on this host is gone, or whose number another has now, is taken
/// over. A process on another host cannot be seen, so its file has to be deleted by hand.
class FolderLock {
 public:
  /// @throws Error naming the folder's owner, InputError if no file can be made in it
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  std::filesystem::path path_;
  int file_ = -1;
};

}  // namespace mcdbn
