#include "learning/fine_tuner.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include "base/random_phases.hpp"
#include "base/random_streams.hpp"
#include "device/kernel_arguments.hpp"
#include "learning/rate_schedule.hpp"
#include "learning/squared_loss.hpp"

namespace mcdbn {
namespace {

/// Longest gradient of the loss, whose parts start near 1: a longer one is cut to it, as errors may
/// explode through time.
constexpr float kLongestGradient = 1.0F;

/// Adam's rate: rises over the first steps, then falls along a cosine.
double rate_at(double rate, std::size_t step, std::size_t steps) {
  constexpr double kRise = 30.0;
  const double progress = static_cast<double>(step) / static_cast<double>(steps);
  return rate * cosine_fall(progress) * std::min(1.0, static_cast<double>(step + 1) / kRise);
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
  windows.judged_from = windows.first + settings.settle_frames;
  windows.frames = windows.judged_from + settings.window_frames;
  return windows;
}

namespace {

/// The rows of a modality's clips, counted through all of them.
MatrixF gathered(std::span<const MatrixF> clips, std::span<const std::int32_t> rows) {
  std::vector<Eigen::Index> ends;
  for (const MatrixF& clip : clips) ends.push_back((ends.empty() ? 0 : ends.back()) + clip.rows());
  MatrixF result(static_cast<Eigen::Index>(rows.size()), clips.front().cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto clip =
        static_cast<std::size_t>(std::ranges::upper_bound(ends, rows[i]) - ends.begin());
    const Eigen::Index first = clip == 0 ? 0 : ends[clip - 1];
    result.row(static_cast<Eigen::Index>(i)) = clips[clip].row(rows[i] - first);
  }
  return result;
}

}  // namespace

DeviceWindows::DeviceWindows(Device& device, const SynchronizedClips& clips,
                             const SequenceWindows& windows) {
  std::vector<std::int32_t> all(windows.rows());
  std::iota(all.begin(), all.end(), 0);
  index_ = IndexBuffer(device, all);
  for (const ModalityClips& modality : clips.modalities) {
    values_.emplace_back(device, windows.rows(), modality.dimension());
    seen_.push_back(modality.seen.empty() ? Matrix() : Matrix::like(values_.back()));
  }
}

void DeviceWindows::load(const SynchronizedClips& clips, std::span<const std::int32_t> rows) {
  const std::size_t count = rows.size() / 2;
  for (std::size_t m = 0; m < values_.size(); ++m) {
    const ModalityClips& modality = clips.modalities[m];
    require(modality.seen.empty() == seen_[m].empty(),
            "fine-tuning: other clips are not seen as the first were");
    const std::span<const std::int32_t> own = rows.subspan(m == 0 ? count : 0, count);
    values_[m].upload(gathered(modality.clips, own));
    if (!seen_[m].empty()) seen_[m].upload(gathered(modality.seen, own));
  }
}

std::vector<Rows> DeviceWindows::rows() const {
  std::vector<Rows> rows;
  for (const Matrix& values : values_)
    rows.push_back(Rows::indexed(values, index_, 0, values.rows()));
  return rows;
}

void FineTuner::Direction::learn(std::span<const Rows> rows, float kept, const RandomKey& key) {
  pass.forward(rows, kept, key);
  loss->differentiate(pass.prediction(), *rows[modality].matrix, pass.prediction_error());
  pass.backward();
}

FineTuner::FineTuner(Device& device, const Mcdbn& start, const SynchronizedClips& clips,
                     const SequenceWindows& windows, const LearningSettings& settings,
                     const SequenceLossMaker& make_loss)
    : learning_(settings),
      settings_(settings.fine_tuning),
      shape_(windows),
      network_(device, start, settings_.mean_field_steps),
      clips_(clips),
      windows_(device, clips, windows),
      sampler_(clips, windows, settings) {
  const std::size_t last = start.modality_count() - 1;
  add_direction(last, make_loss(device, windows));
  const double others = settings_.reverse * static_cast<double>(kReverseEvery);
  for (std::size_t m = last; m-- > 0;) {
    const Matrix& seen = windows_.seen(m);
    add_direction(
        m, std::make_unique<SquaredLoss>(device, windows, others, seen.empty() ? nullptr : &seen));
  }
}

void FineTuner::see(const SynchronizedClips& clips) {
  clips_ = clips;
  sampler_ = WindowSampler(clips, shape_, learning_);
}

void FineTuner::step(std::size_t step) {
  windows_.load(clips_, sampler_.rows(step));
  const std::vector<Rows> rows = windows_.rows();
  const auto kept = static_cast<float>(1.0 - settings_.dropout);
  RandomKey key{learning_.seed, static_cast<std::uint32_t>(step), random_streams::kDropout, 0};
  network_.clear_gradients();
  for (Direction& direction : directions_) {
    direction.learn(rows, kept, key);
    if (settings_.reverse == 0 || step % kReverseEvery != 0) break;
    key.phase = static_cast<std::uint16_t>(key.phase + random_phases::kPhasesOfDirection);
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

void FineTuner::add_direction(std::size_t modality, std::unique_ptr<SequenceLoss> loss) {
  directions_.push_back({modality, UnrolledPass(network_, modality, shape_), std::move(loss)});
}

}  // namespace mcdbn
