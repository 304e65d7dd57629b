#include "learning/clip_weights.hpp"

#include <cmath>
#include <map>

namespace mcdbn {

std::vector<double> clip_weights(const SynchronizedClips& clips, double power) {
  const auto group = [&](std::size_t clip) {
    return clips.groups.empty() ? 0 : clips.groups[clip];
  };
  std::map<std::size_t, double> frames_of;
  for (std::size_t i = 0; i < clips.count(); ++i)
    frames_of[group(i)] += static_cast<double>(clips.frames(i));
  std::vector<double> weights;
  for (std::size_t i = 0; i < clips.count(); ++i)
    weights.push_back(std::pow(frames_of[group(i)], power - 1.0));
  return weights;
}

}  // namespace mcdbn
