#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "corpus/clip_groups.hpp"
#include "corpus/clip_pieces.hpp"
#include "corpus/pose_pool.hpp"
#include "mcdbn/corpus/clip_store.hpp"
#include "mcdbn/corpus/training_set.hpp"

namespace mcdbn {

/// An augmented view as a network learns it, standardized.
struct EncodedView {
  MatrixF track, pose;  ///< [frames x dimension]
  MatrixF track_seen;   ///< 1 what was seen, 0 what was not, where the track is at its mean
  std::size_t clip = 0;
};

EncodedView encode_view(const Modalities& modalities, const AugmentedView& view, std::size_t clip);
/// Appends the view to `views` as one more sequence.
void add_view(EncodedView view, const ClipStore& clips, const ClipGroups& groups,
              TrainingSet& views);

/// Which pieces of clips are seen.
struct PieceChoice {
  /// Frames of a piece at the model's rate, before its tempo is another; all of a shorter clip.
  int frames = kPieceFrames;
  /// People and actions (ClipGroups) come as their frames to this power.
  double groups_power = 1;
  PeopleChoice people = {};
};

/// Any number of augmented views of pieces of clips. View n is the same wherever and whenever it is
/// made; the time for it does not depend on the size of the corpus.
class FreshViews {
 public:
  /// @param pool what new poses are made of; none: there are none
  /// @throws InputError if no clip is left
  FreshViews(ClipStore clips, Modalities modalities, CorpusSettings settings,
             std::shared_ptr<const PosePool> pool, std::uint64_t seed, const PieceChoice& choice);

  /// Several threads may call it at once.
  EncodedView make(std::size_t number) const;
  /// Group of the view's clip, as ClipGroups numbers it.
  std::size_t group_of(const EncodedView& view) const { return groups_.groups()[view.clip]; }
  /// Frames of each group at the model's rate in the clips that views are made of, by its number.
  const std::vector<double>& group_frames() const { return group_frames_; }
  double groups_power() const { return choice_.groups_power; }
  /// Views `first` to `first` + `count` − 1, made by several threads. Each has its `tracks_seen`.
  TrainingSet make_set(std::size_t first, std::size_t count) const;

 private:
  ClipStore clips_;
  ClipGroups groups_;
  Modalities modalities_;
  CorpusSettings settings_;
  std::shared_ptr<const PosePool> pool_;
  std::uint64_t seed_;
  PieceChoice choice_;
  std::vector<double> group_frames_;
  std::vector<double> ends_;  ///< of each clip's share in the draw, added up
};

}  // namespace mcdbn
