#include "learning/window_sampler.hpp"

#include <algorithm>
#include <cmath>

#include "base/random_streams.hpp"
#include "learning/clip_weights.hpp"

namespace mcdbn {
namespace {

std::int32_t row_of(const Sequences::Clip& clip, std::int64_t frame) {
  const auto last = static_cast<std::int64_t>(clip.frames) - 1;
  return static_cast<std::int32_t>(static_cast<std::int64_t>(clip.first) +
                                   std::clamp<std::int64_t>(frame, 0, last));
}

}  // namespace

WindowSampler::WindowSampler(const SynchronizedClips& clips, const SequenceWindows& windows,
                             const LearningSettings& learning)
    : windows_(windows), look_ahead_(learning.look_ahead), seed_(learning.seed) {
  const std::vector<double> weights = clip_weights(clips, learning.fine_tuning.people_power);
  std::size_t first = 0;
  double end = 0;
  for (std::size_t i = 0; i < clips.count(); ++i) {
    const std::size_t frames = clips.frames(i);
    clips_.push_back({first, frames});
    first += frames;
    end += static_cast<double>(frames) * weights[i];
    ends_.push_back(end);
  }
}

std::vector<std::int32_t> WindowSampler::rows(std::size_t step) const {
  std::vector<std::int32_t> rows(2 * windows_.rows());
  for (std::size_t i = 0; i < windows_.count; ++i) {
    const RandomKey key{seed_, static_cast<std::uint32_t>(step), random_streams::kWindows, 0};
    const auto row = static_cast<std::uint32_t>(i);
    const Sequences::Clip& clip = draw_clip(random_uniform(key, row, 0));
    const auto judged = windows_.frames - windows_.judged_from;
    const double starts = clip.frames > judged ? static_cast<double>(clip.frames - judged) : 0.0;
    // Now and then the clip's very first frame: there is no history, and every clip has it.
    constexpr float kFromStart = 0.1F;
    const double where = random_uniform(key, row, 1) < kFromStart
                             ? 0.0
                             : std::floor((starts + 1.0) * random_uniform(key, row, 2));
    const auto judged_from = static_cast<std::int64_t>(windows_.judged_from);
    for (std::size_t t = 0; t < windows_.frames; ++t) {
      const std::int64_t frame =
          static_cast<std::int64_t>(where) + static_cast<std::int64_t>(t) - judged_from;
      const std::size_t at = i * windows_.frames + t;
      rows[at] = row_of(clip, frame);
      rows[windows_.rows() + at] = row_of(clip, frame + static_cast<std::int64_t>(look_ahead_));
    }
  }
  return rows;
}

const Sequences::Clip& WindowSampler::draw_clip(float uniform) const {
  const double at = static_cast<double>(uniform) * ends_.back();
  const auto found = std::upper_bound(ends_.begin(), ends_.end(), at);
  return clips_[std::min<std::size_t>(static_cast<std::size_t>(found - ends_.begin()),
                                      clips_.size() - 1)];
}

}  // namespace mcdbn
