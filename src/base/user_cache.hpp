#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace mcdbn {

/// Small entries kept in the user's cache folder ($XDG_CACHE_HOME/mcdbn-cl or ~/.cache/mcdbn-cl).
/// An entry is stored with its whole key and a checksum, so a stale, foreign or damaged one reads
/// as absent. Neither function throws: a cache that does not work only costs time.
std::optional<std::string> read_cache_entry(const std::string& kind, const std::string& key);
void write_cache_entry(const std::string& kind, const std::string& key, const std::string& value);

/// FNV-1a, 64 bit.
std::uint64_t fnv1a(const std::string& text);

}  // namespace mcdbn
