#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// The sequences of one modality: clip i is [frames x dimension], standardized where its units are
/// Gaussian, within 0 … 1 where they are binary. Holds references only.
struct ModalityClips {
  std::string name;  ///< in names of stages and tensors
  std::span<const MatrixF> clips;
  VisibleKind kind = VisibleKind::gaussian;
  /// What was seen of each clip, 1, and what was not, 0, shaped as the clips; none: all of it. What
  /// was not seen is 0 in the clip and teaches nothing: those units are no part of the lowest
  /// machine for that frame, and no loss of the modality counts them.
  std::span<const MatrixF> seen = {};

  /// Whether every value was seen.
  bool is_whole() const;
  std::size_t dimension() const {
    return clips.empty() ? 0 : static_cast<std::size_t>(clips.front().cols());
  }
};

/// Synchronized sequences of all modalities: clip i has as many frames in each.
struct SynchronizedClips {
  std::vector<ModalityClips> modalities;
  /// Which clips belong together (e.g. of one person), counted from 0; empty: all alike.
  std::span<const std::size_t> groups;
  /// Where the clips are pieces of a larger corpus: the frames of each group in it, by its number;
  /// pieces of a group were drawn as these to the power `drawn_power`. Empty: the clips are all
  /// there is.
  std::span<const double> group_frames = {};
  double drawn_power = 1;

  std::size_t count() const { return modalities.front().clips.size(); }
  std::size_t frames(std::size_t clip) const {
    return static_cast<std::size_t>(modalities.front().clips[clip].rows());
  }
  /// One pass over all values.
  /// @throws ShapeError without modalities or clips, or where they differ in clips or frames, or
  ///         the clips of one in columns; where `seen` has another shape than its clips, or a clip
  ///         a number that was not seen; where a clip's group is not known. InputError naming
  ///         modality, clip, row and column of the first value that its units cannot take
  void check() const;
};

/// Where the sequences of a training come from. Here matrices in memory; clips of motion and
/// augmented views of them are motion_model's (training_sources.hpp).
class SequenceSource {
 public:
  virtual ~SequenceSource() = default;
  /// All of them; they live as long as the source. May take a while the first time.
  virtual SynchronizedClips sequences() const = 0;
  /// Makes them those that mini-batch `step` of fine-tuning is drawn from, counted from 0, if these
  /// change on the way: the same of the same step, however it comes there. What sequences() gave is
  /// gone then. @return whether they changed
  virtual bool renew(std::size_t /*step*/) const { return false; }
};

/// Sequences of one modality that the source keeps.
struct ModalityMatrices {
  std::string name;
  std::vector<MatrixF> clips;
  VisibleKind kind = VisibleKind::gaussian;
  std::vector<MatrixF> seen = {};  ///< as ModalityClips::seen
};

class MatrixSource : public SequenceSource {
 public:
  /// @param groups of the clips, or none
  explicit MatrixSource(std::vector<ModalityMatrices> modalities,
                        std::vector<std::size_t> groups = {})
      : modalities_(std::move(modalities)), groups_(std::move(groups)) {}
  SynchronizedClips sequences() const override;

 private:
  std::vector<ModalityMatrices> modalities_;
  std::vector<std::size_t> groups_;
};

}  // namespace mcdbn
