#include "mcdbn/learning/fine_tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/random_streams.hpp"
#include "device/pointwise.hpp"
#include "learning/divergence_guard.hpp"
#include "learning/squared_loss.hpp"
#include "learning/unrolled_pass.hpp"
#include "learning/window_sampler.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr const char* kStage = "fine-tuning";

/// Mini-batches between two reports.
constexpr std::size_t kReportEvery = 25;
/// The other directions take part in every so many mini-batches, with as many times their weight.
constexpr std::size_t kReverseEvery = 4;

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

/// All modalities' clips on the device, and the rows of a mini-batch's windows in them.
class Windows {
 public:
  Windows(Device& device, const SynchronizedClips& clips, std::size_t rows) : rows_(rows) {
    for (const ModalityClips& modality : clips.modalities)
      sequences_.push_back(Sequences::from_host(device, modality.clips, modality.seen));
  }

  /// The first modality's frames are those look_ahead later (WindowSampler::rows).
  std::vector<Rows> rows(const IndexBuffer& index) const {
    std::vector<Rows> rows;
    for (const Sequences& sequences : sequences_)
      rows.push_back(Rows::indexed(sequences.values, index, rows.empty() ? rows_ : 0, rows_));
    return rows;
  }
  std::size_t dimension(std::size_t modality) const {
    return sequences_[modality].values.columns();
  }
  /// What was seen, like the modality's values; empty where everything was.
  const Matrix& seen(std::size_t modality) const { return sequences_[modality].seen; }

 private:
  std::size_t rows_;
  std::vector<Sequences> sequences_;
};

/// Windows of the clips held out, always the same, seen without drop-out.
class HeldOutWindows {
 public:
  HeldOutWindows(Device& device, const SynchronizedClips& clips, const SequenceWindows& windows,
                 const LearningSettings& settings, const SequenceLossMaker& make_loss)
      : windows_(device, clips, windows.rows()),
        loss_(make_loss(device, windows)),
        target_(device, windows.rows(), windows_.dimension(clips.modalities.size() - 1)) {
    const WindowSampler sampler(clips, windows, settings);
    for (std::size_t i = 0; i < kBatches; ++i) indices_.emplace_back(device, sampler.rows(i));
  }

  double loss(UnrolledPass& forward) {
    for (const IndexBuffer& index : indices_) {
      const std::vector<Rows> rows = windows_.rows(index);
      gather(rows.back(), target_);
      forward.forward(rows, 1.0F, {});
      loss_->differentiate(forward.prediction(), target_, forward.prediction_error());
    }
    return loss_->read_and_reset();
  }

 private:
  static constexpr std::size_t kBatches = 4;

  Windows windows_;
  std::unique_ptr<SequenceLoss> loss_;
  Matrix target_;
  std::vector<IndexBuffer> indices_;
};

/// One direction: a modality predicted from all others, and its loss.
struct Direction {
  std::size_t modality;
  UnrolledPass pass;
  Matrix target;
  std::unique_ptr<Matrix> seen;  ///< like target, if some of it was not and the loss asks
  std::unique_ptr<SequenceLoss> loss;

  /// @param all_seen Windows::seen of the modality
  void learn(std::span<const Rows> rows, const Matrix& all_seen, float kept, const RandomKey& key) {
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
};

/// All directions, and what a mini-batch of them needs.
class FineTuner {
 public:
  FineTuner(Device& device, const Mcdbn& start, const SynchronizedClips& clips,
            const SequenceWindows& windows, const LearningSettings& settings,
            const SequenceLossMaker& make_loss)
      : settings_(settings.fine_tuning),
        seed_(settings.seed),
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

  void step(std::size_t step) {
    index_.upload(network_.device(), sampler_.rows(step));
    const std::vector<Rows> rows = windows_.rows(index_);
    const auto kept = static_cast<float>(1.0 - settings_.dropout);
    RandomKey key{seed_, static_cast<std::uint32_t>(step), random_streams::kDropout, 0};
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

  /// The weighted loss of the last modality since the last call.
  double read_loss() { return directions_.front().loss->read_and_reset(); }

  /// The loss of the parameters' moving average on the clips held out.
  double loss_on(HeldOutWindows& windows) {
    network_.exchange_averages();
    const double loss = windows.loss(directions_.front().pass);
    network_.exchange_averages();
    return loss;
  }

  Mcdbn result() { return network_.averaged(); }

 private:
  void add_direction(const SequenceWindows& windows, std::size_t modality,
                     std::unique_ptr<SequenceLoss> loss, std::unique_ptr<Matrix> seen = nullptr) {
    directions_.push_back({modality, UnrolledPass(network_, modality, windows),
                           Matrix(network_.device(), windows.rows(), windows_.dimension(modality)),
                           std::move(seen), std::move(loss)});
  }

  const FineTuningSettings& settings_;
  std::uint64_t seed_;
  UnrolledNetwork network_;
  Windows windows_;
  WindowSampler sampler_;
  std::vector<Direction> directions_;  ///< of the last modality, then of those before it
  IndexBuffer index_;
};

/// The last parameters that did about as well as any on the clips held out. About, as nobody is
/// like everybody: stopping at the very best for one CMU walker, 250 of 1500 mini-batches at a loss
/// 2 % below the later ones, cost other strangers 3 mm.
class HeldOutRecord {
 public:
  /// @return whether they last did as well so long ago that going on is not worth while
  bool add(FineTuner& tuner, std::size_t step, std::size_t steps, double loss) {
    constexpr double kAboutAsWell = 1.05;
    constexpr std::size_t kLeastPatience = 100;
    best_loss_ = std::min(best_loss_, loss);
    if (loss > kAboutAsWell * best_loss_)
      return step - kept_.steps >= std::max(kLeastPatience, steps / 4);
    kept_.steps = step;
    kept_.loss = loss;
    network_ = tuner.result();
    return false;
  }
  FineTuned take() { return {std::move(*network_), kept_}; }

 private:
  double best_loss_ = std::numeric_limits<double>::infinity();
  KeptStep kept_;
  std::optional<Mcdbn> network_;
};

SequenceWindows sequence_windows(const Mcdbn& network, const FineTuningSettings& settings) {
  SequenceWindows windows;
  windows.count = settings.windows;
  windows.first = longest_history(network);
  windows.lead = windows.first + settings.settle_frames;
  windows.frames = windows.lead + settings.window_frames;
  return windows;
}

EpochReport report_of(std::size_t done, const FineTuningSettings& settings, double loss,
                      double took_s) {
  EpochReport report;
  report.stage = kStage;
  report.epoch = done;
  report.epochs = settings.steps;
  report.loss = loss;
  report.windows_per_s = static_cast<double>(kReportEvery * settings.windows) / took_s;
  report.stage_progress = static_cast<double>(done) / static_cast<double>(settings.steps);
  report.overall_progress = report.stage_progress;
  return report;
}

}  // namespace

FineTuned fine_tune(Device& device, const Mcdbn& start, const SequenceSource& source,
                    const SequenceSource* held_out, const LearningSettings& settings,
                    const SequenceLossMaker& make_loss, const EpochObserver& observer) {
  const std::size_t steps = settings.fine_tuning.steps;
  const SequenceWindows windows = sequence_windows(start, settings.fine_tuning);
  std::optional<HeldOutWindows> judged;
  if (held_out) judged.emplace(device, held_out->sequences(), windows, settings, make_loss);
  const SynchronizedClips clips = source.sequences();
  clips.check();
  FineTuner tuner(device, start, clips, windows, settings, make_loss);
  HeldOutRecord record;
  DivergenceGuard guard(
      kStage, fmt::format("lower `fine-tuning.rate` (now {:g})", settings.fine_tuning.rate));
  auto last = std::chrono::steady_clock::now();
  for (std::size_t done = 1; done <= steps; ++done) {
    tuner.step(done - 1);
    if (done % kReportEvery != 0 && done != steps) continue;
    const double loss = tuner.read_loss();
    guard.check(done, loss);
    const auto now = std::chrono::steady_clock::now();
    EpochReport report = report_of(done, settings.fine_tuning, loss,
                                   std::chrono::duration<double>(now - last).count());
    if (judged) report.held_out_loss = tuner.loss_on(*judged);
    last = std::chrono::steady_clock::now();
    if (observer) observer(report);
    if (judged && record.add(tuner, done, steps, *report.held_out_loss)) break;
  }
  if (judged) return record.take();
  return {tuner.result(), {}};
}

}  // namespace mcdbn
