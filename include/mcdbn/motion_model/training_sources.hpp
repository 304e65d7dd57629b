#pragma once

#include <array>
#include <memory>
#include <optional>

#include "mcdbn/corpus/clip_store.hpp"
#include "mcdbn/corpus/training_set.hpp"
#include "mcdbn/learning/sequence_source.hpp"
#include "mcdbn/motion_model/training_config.hpp"

namespace mcdbn {

/// The modalities of the model of motion, in the network's order.
inline constexpr std::size_t kTrack = 0, kPose = 1;  // 2D, 3D
inline constexpr std::array<const char*, 2> kModalityNames{"track", "pose"};

/// A training set's clips; the set must live on. Clips of one person and action belong together, or
/// of one person where no actions are given.
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

/// Augmented views of clips that are made when they are first asked for and then kept
/// (make_augmented_views).
class ViewSource : public SequenceSource {
 public:
  /// One person is held out as config.hold_out_among specifies.
  /// @param data of those clips (make_training_set), must live on
  ViewSource(ClipStore clips, const TrainingSet& data, TrainingConfig config);

  /// The views to learn from, without those of the person held out.
  SynchronizedClips sequences() const override { return ClipSource(made().to_learn).sequences(); }
  /// Views of the person held out, if one is.
  const std::optional<TrainingSet>& held_out_views() const { return made().held_out; }

 private:
  struct Views {
    TrainingSet to_learn;
    std::optional<TrainingSet> held_out;
  };
  const Views& made() const;

  ClipStore clips_;
  const TrainingSet& data_;
  TrainingConfig config_;
  std::optional<std::size_t> held_out_;
  mutable std::optional<Views> views_;
};

class ViewLoader;

/// Views of pieces of clips (FreshViews), each replaced by a new one after
/// config.fine_tuning.view_uses windows were drawn from it. People and actions come as their frames
/// to the power config.fine_tuning.people_power; the greedy stages weigh the views for theirs.
/// Threads of its own make the views ahead. Which views a mini-batch is drawn from depends on its
/// number alone. Its cost depends on that number too, not on the corpus.
class FreshViewSource : public SequenceSource {
 public:
  /// One person is held out as config.hold_out_among specifies.
  FreshViewSource(const ClipStore& clips, const TrainingSet& data, const TrainingConfig& config);
  ~FreshViewSource() override;
  FreshViewSource(const FreshViewSource&) = delete;
  FreshViewSource& operator=(const FreshViewSource&) = delete;

  SynchronizedClips sequences() const override;
  bool renew(std::size_t step) const override;
  /// Number of mini-batches after which all views have been replaced, from any one on.
  std::size_t lifetime() const;
  /// Views of the person held out, always the same, if one is.
  const std::optional<TrainingSet>& held_out_views() const { return held_out_views_; }

 private:
  std::unique_ptr<ViewLoader> loader_;
  std::optional<TrainingSet> held_out_views_;
};

/// Whether fine-tuning learns from a FreshViewSource: if the settings ask for it, or all views at
/// once would be more than some two hours.
bool learns_from_fresh_views(const ClipStore& clips, const TrainingConfig& config);

/// Some two hours of the views that a FreshViewSource begins with, for others to learn from.
/// @param clips as they were learnt from
TrainingSet some_fresh_views(const ClipStore& clips, const Modalities& modalities,
                             const TrainingConfig& config);

/// Frames of the pieces of clips that fresh views are of: windows begin and end at more than a few
/// places of one.
int frames_of_pieces(const TrainingConfig& config);

/// Views that a FreshViewSource holds at a time: config.augment.views of each piece, but not more
/// than some half an hour.
std::size_t fresh_views_at_once(const ClipStore& clips, const TrainingConfig& config);

}  // namespace mcdbn
