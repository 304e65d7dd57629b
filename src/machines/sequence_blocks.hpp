#pragma once

#include <vector>

#include "mcdbn/machines/sequences.hpp"

namespace mcdbn {

/// The rows of each clip from its frame `from` on; clips that have none are left out.
inline std::vector<Sequences::Clip> blocks_from(const std::vector<Sequences::Clip>& clips,
                                                std::size_t from) {
  std::vector<Sequences::Clip> blocks;
  for (const Sequences::Clip& clip : clips)
    if (clip.frames > from) blocks.push_back({clip.first + from, clip.frames - from});
  return blocks;
}

}  // namespace mcdbn
