#include "learning/clip_weights.hpp"

#include <cmath>
#include <map>

namespace mcdbn {
namespace {

/// Number of frames of each group, where the clips are the whole corpus.
std::map<std::size_t, double> frames_of_groups(const SynchronizedClips& clips) {
  std::map<std::size_t, double> frames;
  for (std::size_t i = 0; i < clips.count(); ++i)
    frames[clips.groups.empty() ? 0 : clips.groups[i]] += static_cast<double>(clips.frames(i));
  return frames;
}

}  // namespace

std::vector<double> clip_weights(const SynchronizedClips& clips, double power) {
  const bool are_pieces = !clips.group_frames.empty();
  const auto counted = are_pieces ? std::map<std::size_t, double>() : frames_of_groups(clips);
  std::vector<double> weights;
  for (std::size_t i = 0; i < clips.count(); ++i) {
    const std::size_t group = clips.groups.empty() ? 0 : clips.groups[i];
    const double frames = are_pieces ? clips.group_frames[group] : counted.at(group);
    weights.push_back(std::pow(frames, power - clips.drawn_power));
  }
  return weights;
}

}  // namespace mcdbn
