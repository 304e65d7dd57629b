#include "learning/fine_tuner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/random_streams.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "learning/squared_loss.hpp"

namespace mcdbn {
namespace {

/// Of the loss, whose parts start near 1: errors that explode through time are cut here.
constexpr float kLongestGradient = 1.0F;

/// Adam's rate: rises over the first steps, then falls along a cosine.
double rate_at(double rate, std::size_t step, std::size_t steps) {
  constexpr double kRise = 30.0, kEnd = 0.02;
  const double progress = static_cast<double>(step) / static_cast<double>(steps);
  const double fall = kEnd + (1.0 - kEnd) * 0.5 * (1.0 + std::cos(std::numbers::pi * progress));
  return rate * fall * std::min(1.0, static_cast<double>(step + 1) / kRise);
}

/// Frames that every direction's up-pass needs before the first it can judge.
std::size_t longest_history(const Mcdbn& network) {
  std::size_t longest = 0;
  for (const Cdbn& cdbn : network.cdbns) longest = std::max(longest, cdbn.total_order());
  return longest;
}

}  // namespace

SequenceWindows sequence_windows(const Mcdbn& network, const FineTuningSettings& settings) {
  SequenceWindows windows;
  windows.count = settings.windows;
  windows.first = longest_history(network);
  windows.lead = windows.first + settings.settle_frames;
  windows.frames = windows.lead + settings.window_frames;
  return windows;
}

ClipWindows::ClipWindows(Device& device, const SynchronizedClips& clips, std::size_t rows)
    : rows_(rows) {
  for (const ModalityClips& modality : clips.modalities)
    sequences_.push_back(Sequences::from_host(device, modality.clips, modality.seen));
}

std::vector<Rows> ClipWindows::rows(const IndexBuffer& index) const {
  std::vector<Rows> rows;
  for (const Sequences& sequences : sequences_)
    rows.push_back(Rows::indexed(sequences.values, index, rows.empty() ? rows_ : 0, rows_));
  return rows;
}

void FineTuner::Direction::learn(std::span<const Rows> rows, const Matrix& all_seen, float kept,
                                 const RandomKey& key) {
  gather(rows[modality], target);
  if (seen) {
    Rows those = rows[modality];
    those.matrix = &all_seen;
    gather(those, *seen);
  }
  pass.forward(rows, kept, key);
  loss->differentiate(pass.prediction(), target, pass.prediction_error());
  pass.backward();
}

FineTuner::FineTuner(Device& device, const Mcdbn& start, const SynchronizedClips& clips,
                     const SequenceWindows& windows, const LearningSettings& settings,
                     const SequenceLossMaker& make_loss)
    : learning_(settings),
      settings_(settings.fine_tuning),
      shape_(windows),
      network_(device, start, settings_.mean_field_steps),
      windows_(device, clips, windows.rows()),
      sampler_(clips, windows, settings),
      index_(device, sampler_.rows(0)) {
  const std::size_t last = start.modality_count() - 1;
  add_direction(windows, last, make_loss(device, windows));
  const double others = settings_.reverse * static_cast<double>(kReverseEvery);
  for (std::size_t m = last; m-- > 0;) {
    std::unique_ptr<Matrix> seen;
    if (!windows_.seen(m).empty())
      seen = std::make_unique<Matrix>(device, windows.rows(), windows_.dimension(m));
    auto loss = std::make_unique<SquaredLoss>(device, windows, others, seen.get());
    add_direction(windows, m, std::move(loss), std::move(seen));
  }
}

void FineTuner::see(const SynchronizedClips& clips) {
  network_.device().finish();
  windows_ = ClipWindows(network_.device(), clips, shape_.rows());
  sampler_ = WindowSampler(clips, shape_, learning_);
  for (const Direction& direction : directions_)
    require(windows_.seen(direction.modality).empty() == (direction.seen == nullptr) ||
                &direction == &directions_.front(),
            "fine-tuning: other clips are not seen as the first were");
}

void FineTuner::step(std::size_t step) {
  index_.upload(network_.device(), sampler_.rows(step));
  const std::vector<Rows> rows = windows_.rows(index_);
  const auto kept = static_cast<float>(1.0 - settings_.dropout);
  RandomKey key{learning_.seed, static_cast<std::uint32_t>(step), random_streams::kDropout, 0};
  network_.clear_gradients();
  for (Direction& direction : directions_) {
    direction.learn(rows, windows_.seen(direction.modality), kept, key);
    if (settings_.reverse == 0 || step % kReverseEvery != 0) break;
    key.phase = static_cast<std::uint16_t>(key.phase + 0x100);
  }
  UpdateRule rule =
      UpdateRule::adam(static_cast<float>(rate_at(settings_.rate, step, settings_.steps)),
                       static_cast<float>(settings_.weight_decay));
  rule.beta2 = 0.99F;
  // A young average is that of few steps.
  const double young = static_cast<double>(step + 1) / static_cast<double>(step + 10);
  network_.update(rule, kLongestGradient, static_cast<float>(std::min(settings_.average, young)));
}

void FineTuner::visit_state(TrainingState& state) {
  network_.visit_state(state);
  for (Direction& direction : directions_) {
    TrainingState own = state.under(std::to_string(direction.modality) + ".");
    direction.loss->visit_state(own);
  }
}

void FineTuner::add_direction(const SequenceWindows& windows, std::size_t modality,
                              std::unique_ptr<SequenceLoss> loss, std::unique_ptr<Matrix> seen) {
  directions_.push_back({modality, UnrolledPass(network_, modality, windows),
                         Matrix(network_.device(), windows.rows(), windows_.dimension(modality)),
                         std::move(seen), std::move(loss)});
}

}  // namespace mcdbn
