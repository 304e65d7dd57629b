#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "mcdbn/machines/sequences.hpp"

namespace mcdbn {

/// Rows that are taken at once where what is kept of each is as long as a machine's hidden units.
inline constexpr std::size_t kRowsAtOnce = 4800;

/// The rows of each clip from its frame `from` on; clips that have none are left out.
/// @param most rows of a block; a clip of more has several
inline std::vector<Sequences::Clip> blocks_from(
    const std::vector<Sequences::Clip>& clips, std::size_t from,
    std::size_t most = std::numeric_limits<std::size_t>::max()) {
  std::vector<Sequences::Clip> blocks;
  for (const Sequences::Clip& clip : clips)
    for (std::size_t t = from; t < clip.frames; t += std::min(most, clip.frames - t))
      blocks.push_back({clip.first + t, std::min(most, clip.frames - t)});
  return blocks;
}

}  // namespace mcdbn
