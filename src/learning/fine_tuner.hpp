#pragma once

#include <memory>
#include <span>
#include <vector>

#include "learning/unrolled_pass.hpp"
#include "learning/window_sampler.hpp"

namespace mcdbn {

/// Windows of a mini-batch as fine-tuning takes them: the history that the network needs, then
/// frames that settle, then those that are judged.
SequenceWindows sequence_windows(const Mcdbn& network, const FineTuningSettings& settings);

/// A mini-batch's windows of all modalities on the device, copied there from the clips, which stay
/// where they are: what the device holds does not grow with them.
class DeviceWindows {
 public:
  /// @param clips of the modalities to come, as completely seen
  DeviceWindows(Device& device, const SynchronizedClips& clips, const SequenceWindows& windows);
  /// @param rows WindowSampler::rows; the first modality's frames are those look_ahead later
  /// @throws ShapeError if the clips are not seen as the first were
  void load(const SynchronizedClips& clips, std::span<const std::int32_t> rows);
  /// Values of each modality.
  std::vector<Rows> rows() const;
  /// What was seen, like the modality's values; empty where everything was.
  const Matrix& seen(std::size_t modality) const { return seen_[modality]; }

 private:
  std::vector<Matrix> values_, seen_;
  IndexBuffer index_;  ///< every row, for those that name rows
};

/// Fine-tuning's mini-batches: all directions, the optimizer, the moving average of the parameters.
class FineTuner {
 public:
  /// The other directions take part in every so many mini-batches, with as many times their weight.
  static constexpr std::size_t kReverseEvery = 4;

  /// @param settings must live on  @param make_loss of the last modality
  FineTuner(Device& device, const Mcdbn& start, const SynchronizedClips& clips,
            const SequenceWindows& windows, const LearningSettings& settings,
            const SequenceLossMaker& make_loss);

  /// Windows are those of these clips from now on, which live as long as they are drawn from; of
  /// the same modalities, as completely seen.
  void see(const SynchronizedClips& clips);
  /// Mini-batch `step` of settings.fine_tuning.steps, counted from 0. Enqueues and returns.
  void step(std::size_t step);
  /// The weighted loss of the last modality since the last call.
  double read_loss() { return directions_.front().loss->read_and_reset(); }
  /// The last modality from the others.
  UnrolledPass& forward() { return directions_.front().pass; }
  /// The moving average of the parameters in their place, to be judged; again: back.
  void exchange_averages() { network_.exchange_averages(); }
  /// The moving average of the parameters, for result().
  const Matrix& averages() const { return network_.averages(); }
  /// The network that averages() of now or before make.
  Mcdbn result(const Matrix& averages) { return network_.with_parameters(averages); }
  /// State that is kept from one mini-batch to the next.
  void visit_state(TrainingState& state);

 private:
  /// A modality predicted from all others, and its loss.
  struct Direction {
    std::size_t modality;
    UnrolledPass pass;
    std::unique_ptr<SequenceLoss> loss;

    void learn(std::span<const Rows> rows, float kept, const RandomKey& key);
  };
  void add_direction(std::size_t modality, std::unique_ptr<SequenceLoss> loss);

  const LearningSettings& learning_;
  const FineTuningSettings& settings_;
  SequenceWindows shape_;
  UnrolledNetwork network_;
  SynchronizedClips clips_;
  DeviceWindows windows_;
  WindowSampler sampler_;
  std::vector<Direction> directions_;  ///< of the last modality, then of those before it
};

}  // namespace mcdbn
