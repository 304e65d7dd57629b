#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "mcdbn/corpus/clip_store.hpp"

namespace mcdbn {

/// Writes clips one after another into a file that a store reads: channels as they are, 8 bytes a
/// number, then who and what they are, as JSON. The file does not appear before it is whole.
class ClipCacheWriter {
 public:
  /// @param key identifies what the clips were made of, and how
  ClipCacheWriter(std::filesystem::path path, std::string key);
  /// Removes what was not finished.
  ~ClipCacheWriter();
  ClipCacheWriter(const ClipCacheWriter&) = delete;
  ClipCacheWriter& operator=(const ClipCacheWriter&) = delete;

  /// @throws InputError if it cannot be written
  void add(const LoadedClip& clip);
  /// Puts the file in its place and opens it. @throws InputError
  ClipStore finish();
  /// Opens the file without a place, for clips that others are made of: no later program finds it,
  /// and its room is free with the last copy of the store. @throws InputError
  ClipStore finish_without_place();

 private:
  struct Entry {
    ClipRecord record;
    std::uint64_t first_byte, checksum;
  };
  void write(const void* bytes, std::size_t count);
  void write_contents();

  std::filesystem::path path_, temporary_;
  std::string key_;
  std::ofstream stream_;
  std::vector<Entry> entries_;
  std::uint64_t written_ = 0;
};

/// The clips of such a file, mapped into memory: what is read of it is given back now and then, so
/// that the whole of it never takes room at once. All of it is checked first.
/// @throws InputError if it is damaged or no such file, or of another key
ClipStore open_clip_cache(const std::filesystem::path& path, const std::string& key);

}  // namespace mcdbn
