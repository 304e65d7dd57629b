#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/corpus/training_set.hpp"
#include "mcdbn/learning/sequence_source.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

/// The modalities of the model of motion, in the network's order.
inline constexpr std::size_t kTrack = 0, kPose = 1;  // 2D, 3D
inline constexpr std::array<const char*, 2> kModalityNames{"track", "pose"};

/// A training set's clips; the set must live on. Those of one person and action belong together, or
/// of one person where nobody said actions.
class ClipSource : public SequenceSource {
 public:
  explicit ClipSource(const TrainingSet& set) : set_(set) {}
  SynchronizedClips sequences() const override {
    return {{{kModalityNames[kTrack], set_.tracks, VisibleKind::gaussian, set_.tracks_seen},
             {kModalityNames[kPose], set_.poses}},
            set_.groups.empty() ? set_.people : set_.groups};
  }

 private:
  const TrainingSet& set_;
};

/// Augmented views of clips (make_augmented_views), made when they are first asked for, and others
/// at each renewal.
class ViewSource : public SequenceSource {
 public:
  /// @param clips at their own rate, gone once the last views are made: at once, unless
  ///        config.fine_tuning.new_views_every says that there will be others
  /// @param modalities must live on
  ViewSource(std::vector<LoadedClip> clips, const Modalities& modalities,
             const TrainingConfig& config)
      : clips_(std::move(clips)), modalities_(modalities), config_(config) {}

  const TrainingSet& views() const;
  SynchronizedClips sequences() const override { return ClipSource(views()).sequences(); }
  bool renew(std::size_t round) const override;

 private:
  void make_views(std::size_t round) const;

  mutable std::vector<LoadedClip> clips_;
  const Modalities& modalities_;
  TrainingConfig config_;
  mutable std::optional<TrainingSet> views_;
};

}  // namespace mcdbn
