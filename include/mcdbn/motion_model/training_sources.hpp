#pragma once

#include <optional>
#include <vector>

#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/corpus/training_set.hpp"
#include "mcdbn/learning/sequence_source.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

/// A training set's clips; the set must live on.
class ClipSource : public SequenceSource {
 public:
  explicit ClipSource(const TrainingSet& set) : set_(set) {}
  PairedClips sequences() const override { return {set_.tracks, set_.poses, set_.people}; }

 private:
  const TrainingSet& set_;
};

/// Augmented views of clips (make_augmented_views), made when they are first asked for.
class ViewSource : public SequenceSource {
 public:
  /// @param clips at their own rate, gone once the views are made  @param modalities must live on
  ViewSource(std::vector<LoadedClip> clips, const Modalities& modalities,
             const TrainingConfig& config)
      : clips_(std::move(clips)), modalities_(modalities), config_(config) {}

  const TrainingSet& views() const;
  PairedClips sequences() const override { return ClipSource(views()).sequences(); }

 private:
  mutable std::vector<LoadedClip> clips_;
  const Modalities& modalities_;
  TrainingConfig config_;
  mutable std::optional<TrainingSet> views_;
};

}  // namespace mcdbn
