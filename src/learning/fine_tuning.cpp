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
/// The other direction takes part in every so many mini-batches, with as many times its weight.
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

/// Frames that either direction's up-pass needs before the first it can judge.
std::size_t longest_history(const Mcdbn& network) {
  return std::max(network.track.total_order(), network.pose.total_order());
}

/// Windows of the clips held out, always the same, seen without drop-out.
class HeldOutWindows {
 public:
  HeldOutWindows(Device& device, const PairedClips& clips, const SequenceWindows& windows,
                 const LearningSettings& settings, const SequenceLossMaker& make_loss)
      : windows_(windows),
        tracks_(Sequences::from_host(device, clips.tracks)),
        poses_(Sequences::from_host(device, clips.poses)),
        loss_(make_loss(device, windows)),
        target_(device, windows.rows(), poses_.values.columns()) {
    const WindowSampler sampler(clips, windows, settings);
    for (std::size_t i = 0; i < kBatches; ++i) indices_.emplace_back(device, sampler.rows(i));
  }

  double loss(UnrolledPass& forward) {
    for (const IndexBuffer& index : indices_) {
      gather(Rows::indexed(poses_.values, index, 0, windows_.rows()), target_);
      forward.forward(Rows::indexed(tracks_.values, index, windows_.rows(), windows_.rows()), 1.0F,
                      {});
      loss_->differentiate(forward.prediction(), target_, forward.prediction_error());
    }
    return loss_->read_and_reset();
  }

 private:
  static constexpr std::size_t kBatches = 4;

  SequenceWindows windows_;
  Sequences tracks_, poses_;
  std::unique_ptr<SequenceLoss> loss_;
  Matrix target_;
  std::vector<IndexBuffer> indices_;
};

/// Both directions, their losses, and what a mini-batch of them needs.
class FineTuner {
 public:
  FineTuner(Device& device, const Mcdbn& start, const PairedClips& clips,
            const SequenceWindows& windows, const LearningSettings& settings,
            const SequenceLossMaker& make_loss)
      : settings_(settings.fine_tuning),
        seed_(settings.seed),
        windows_(windows),
        network_(device, start, settings_.mean_field_steps),
        tracks_(Sequences::from_host(device, clips.tracks)),
        poses_(Sequences::from_host(device, clips.poses)),
        sampler_(clips, windows, settings),
        forward_(network_, Modality::track, windows),
        reverse_(network_, Modality::pose, windows),
        pose_loss_(make_loss(device, windows)),
        track_loss_(device, windows, settings_.reverse * static_cast<double>(kReverseEvery)),
        pose_target_(device, windows.rows(), poses_.values.columns()),
        track_target_(device, windows.rows(), tracks_.values.columns()),
        index_(device, sampler_.rows(0)) {}

  void step(std::size_t step) {
    Device& device = network_.device();
    index_.upload(device, sampler_.rows(step));
    const Rows pose = Rows::indexed(poses_.values, index_, 0, windows_.rows());
    const Rows track = Rows::indexed(tracks_.values, index_, windows_.rows(), windows_.rows());
    const auto kept = static_cast<float>(1.0 - settings_.dropout);
    const RandomKey key{seed_, static_cast<std::uint32_t>(step), random_streams::kDropout, 0};
    network_.clear_gradients();
    gather(pose, pose_target_);
    forward_.forward(track, kept, key);
    pose_loss_->differentiate(forward_.prediction(), pose_target_, forward_.prediction_error());
    forward_.backward();
    if (settings_.reverse > 0 && step % kReverseEvery == 0) {
      gather(track, track_target_);
      RandomKey other = key;
      other.phase = 0x100;
      reverse_.forward(pose, kept, other);
      track_loss_.differentiate(reverse_.prediction(), track_target_, reverse_.prediction_error());
      reverse_.backward();
    }
    UpdateRule rule =
        UpdateRule::adam(static_cast<float>(rate_at(settings_.rate, step, settings_.steps)),
                         static_cast<float>(settings_.weight_decay));
    rule.beta2 = 0.99F;
    // A young average is that of few steps.
    const double young = static_cast<double>(step + 1) / static_cast<double>(step + 10);
    network_.update(rule, kLongestGradient, static_cast<float>(std::min(settings_.average, young)));
  }

  /// The weighted loss since the last call.
  double read_loss() { return pose_loss_->read_and_reset(); }

  /// The loss of the parameters' moving average on the clips held out.
  double loss_on(HeldOutWindows& windows) {
    network_.exchange_averages();
    const double loss = windows.loss(forward_);
    network_.exchange_averages();
    return loss;
  }

  Mcdbn result() { return network_.averaged(); }

 private:
  const FineTuningSettings& settings_;
  std::uint64_t seed_;
  SequenceWindows windows_;
  UnrolledNetwork network_;
  Sequences tracks_, poses_;
  WindowSampler sampler_;
  UnrolledPass forward_, reverse_;
  std::unique_ptr<SequenceLoss> pose_loss_;
  SquaredLoss track_loss_;
  Matrix pose_target_, track_target_;
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
  FineTuner tuner(device, start, source.sequences(), windows, settings, make_loss);
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
