#pragma once

#include <cstdint>
#include <vector>

#include "mcdbn/base/random.hpp"
#include "mcdbn/learning/fine_tuning_settings.hpp"
#include "mcdbn/learning/learning_settings.hpp"
#include "mcdbn/learning/sequence_loss.hpp"
#include "mcdbn/learning/sequence_source.hpp"
#include "mcdbn/machines/sequences.hpp"

namespace mcdbn {

/// Draws windows and names the rows of their frames. Beyond a clip's ends its first and last frame
/// stand, as they do where regeneration starts without history. Frames of groups of which there
/// are many are drawn less often (FineTuningSettings::people_power).
class WindowSampler {
 public:
  WindowSampler(const SynchronizedClips& clips, const SequenceWindows& windows,
                const LearningSettings& learning);

  /// Windows of mini-batch `step`: rows of their frames, then those of the frames look_ahead later,
  /// which are the first modality's.
  std::vector<std::int32_t> rows(std::size_t step) const;

 private:
  const Sequences::Clip& draw_clip(float uniform) const;

  SequenceWindows windows_;
  std::size_t look_ahead_;
  std::uint64_t seed_;
  std::vector<Sequences::Clip> clips_;
  std::vector<double> ends_;  ///< of each clip's share in the draw, added up
};

}  // namespace mcdbn
