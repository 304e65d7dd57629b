#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace mcdbn {

/// Small entries kept in the user's cache folder ($XDG_CACHE_HOME/mcdbn-cl or ~/.cache/mcdbn-cl).
/// Its file's name is a hash of the key; with another one of it and a checksum in the file a stale,
/// foreign or damaged entry reads as absent. Neither function throws: a cache that does not work
/// costs time alone, where the value can be made again.
std::optional<std::string> read_cache_entry(const std::string& kind, const std::string& key);
/// @return whether the entry is there now; not where the folder is unknown or cannot be written
bool write_cache_entry(const std::string& kind, const std::string& key, const std::string& value);

/// FNV-1a, 64 bit.
std::uint64_t fnv1a(const std::string& text);

}  // namespace mcdbn
