#include "mcdbn/learning/fine_tuning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "learning/divergence_guard.hpp"
#include "learning/epoch_clock.hpp"
#include "learning/fine_tuner.hpp"
#include "learning/resumable_training.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr const char* kStage = "fine-tuning";

/// Mini-batches between two reports.
constexpr std::size_t kReportEvery = 25;

/// Windows of the clips held out, always the same, seen without drop-out.
class HeldOutWindows {
 public:
  HeldOutWindows(Device& device, const SynchronizedClips& clips, const SequenceWindows& windows,
                 const LearningSettings& settings, const SequenceLossMaker& make_loss)
      : loss_(make_loss(device, windows)) {
    const WindowSampler sampler(clips, windows, settings);
    for (std::size_t i = 0; i < kBatches; ++i)
      batches_.emplace_back(device, clips, windows).load(clips, sampler.rows(i));
  }

  /// Loss of the parameters' moving average.
  double loss(FineTuner& tuner) {
    UnrolledPass& forward = tuner.forward();
    tuner.exchange_averages();
    for (const DeviceWindows& batch : batches_) {
      const std::vector<Rows> rows = batch.rows();
      forward.forward(rows, 1.0F, {});
      loss_->differentiate(forward.prediction(), *rows.back().matrix, forward.prediction_error());
    }
    tuner.exchange_averages();
    return loss_->read_and_reset();
  }

 private:
  static constexpr std::size_t kBatches = 4;

  std::unique_ptr<SequenceLoss> loss_;
  std::vector<DeviceWindows> batches_;
};

/// The last parameters that did about as well as any on the clips held out. About, as people
/// differ: stopping at the very best for one CMU walker, 250 of 1500 mini-batches at a loss 2 %
/// below the later ones, cost other people held out 3 mm.
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
    if (averages_.empty()) averages_ = Matrix::like(tuner.averages());
    averages_.copy_from(tuner.averages());
    return false;
  }
  FineTuned result(FineTuner& tuner) const { return {tuner.result(averages_), kept_}; }

  void visit_state(TrainingState& state, const FineTuner& tuner) {
    state.number("held_out.best_loss", best_loss_);
    state.number("held_out.steps", kept_.steps);
    state.number("held_out.loss", kept_.loss);
    state.matrix_if_any("held_out.averages", averages_,
                        [&] { return Matrix::like(tuner.averages()); });
  }

 private:
  double best_loss_ = std::numeric_limits<double>::max();
  KeptStep kept_;
  Matrix averages_;  ///< that were kept
};

/// Time since the last report, and how much of it was waited.
class ReportClock {
 public:
  explicit ReportClock(Device& device) : trained_(device) {}

  template <typename Call>
  auto waiting(const Call& call) {
    const auto begin = Clock::now();
    auto result = call();
    waited_s_ += seconds(begin);
    return result;
  }
  double took_s() const { return seconds(begin_); }
  double trained_s() const { return trained_.took_s(); }
  /// To a thousandth.
  double waiting_share() const { return std::round(1e3 * waited_s_ / took_s()) / 1e3; }
  void restart() {
    begin_ = Clock::now();
    trained_.restart();
    waited_s_ = 0;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double seconds(Clock::time_point since) {
    return std::chrono::duration<double>(Clock::now() - since).count();
  }

  Clock::time_point begin_ = Clock::now();
  EpochClock trained_;
  double waited_s_ = 0;
};

/// @param batches since the last report, which took `trained_s`
EpochReport report_of(std::size_t done, const FineTuningSettings& settings, double loss,
                      std::size_t batches, double trained_s) {
  EpochReport report;
  report.stage = kStage;
  report.epoch = done;
  report.epochs = settings.steps;
  report.loss = loss;
  report.windows_per_s = static_cast<double>(batches * settings.windows) / trained_s;
  report.stage_progress = static_cast<double>(done) / static_cast<double>(settings.steps);
  report.overall_progress = report.stage_progress;
  return report;
}

/// A source's sequences, which fit the network. @throws ShapeError, InputError
SynchronizedClips checked_sequences(const SequenceSource& source, const Mcdbn& network) {
  SynchronizedClips clips = source.sequences();
  clips.check();
  if (clips.modalities.size() != network.modality_count())
    throw ShapeError(fmt::format("fine-tuning: sequences of {} modalities, not {}",
                                 clips.modalities.size(), network.modality_count()));
  for (std::size_t m = 0; m < network.modality_count(); ++m) {
    const std::size_t visible = network.cdbns[m].layers.front().shape().visible;
    if (clips.modalities[m].dimension() != visible)
      throw ShapeError(fmt::format("fine-tuning: {} has {} visible units, its sequences {} columns",
                                   network.modality(m).name, visible,
                                   clips.modalities[m].dimension()));
  }
  return clips;
}

}  // namespace

FineTuned fine_tune(Device& device, const Mcdbn& start, const SequenceSource& source,
                    const SequenceSource* held_out, const LearningSettings& settings,
                    const SequenceLossMaker& make_loss, const EpochObserver& observer) {
  return fine_tune(device, nullptr, start, source, held_out, settings, make_loss, observer);
}

FineTuned fine_tune(Device& device, Checkpoints* checkpoints, const Mcdbn& start,
                    const SequenceSource& source, const SequenceSource* held_out,
                    const LearningSettings& settings, const SequenceLossMaker& make_loss,
                    const EpochObserver& observer) {
  if (settings.look_ahead != start.look_ahead)
    throw ConfigError(fmt::format("`look-ahead` is {}, but {} in the network to start from",
                                  settings.look_ahead, start.look_ahead));
  const std::size_t steps = settings.fine_tuning.steps;
  const SequenceWindows windows = sequence_windows(start, settings.fine_tuning);
  std::optional<HeldOutWindows> judged;
  if (held_out)
    judged.emplace(device, checked_sequences(*held_out, start), windows, settings, make_loss);
  const SynchronizedClips clips = checked_sequences(source, start);
  FineTuner tuner(device, start, clips, windows, settings, make_loss);
  HeldOutRecord record;
  DivergenceGuard guard(
      kStage, fmt::format("lower `fine-tuning.rate` (now {:g})", settings.fine_tuning.rate));
  const auto visit = [&](TrainingState& state) {
    tuner.visit_state(state);
    guard.visit_state(state);
    record.visit_state(state, tuner);
  };
  StageRun run(device, checkpoints, kStage, visit, [](TrainingState&) {});
  ReportClock clock(device);
  std::size_t reported = run.done();
  for (std::size_t done = run.done() + 1; done <= steps && !run.is_over(); ++done) {
    if (clock.waiting([&] { return source.renew(done - 1); })) tuner.see(source.sequences());
    tuner.step(done - 1);
    if (done % kReportEvery != 0 && done != steps) {
      run.after_step(done);
      continue;
    }
    const double loss = tuner.read_loss();
    guard.check(done, loss);
    EpochReport report =
        report_of(done, settings.fine_tuning, loss, done - reported, clock.trained_s());
    reported = done;
    report.waiting_share = clock.waiting_share();
    if (judged) report.held_out_loss = judged->loss(tuner);
    clock.restart();
    if (observer) observer(report);
    if (judged && record.add(tuner, done, steps, *report.held_out_loss)) break;
    run.after_step(done);
  }
  run.end();
  if (judged) return record.result(tuner);
  return {tuner.result(tuner.averages()), {}};
}

}  // namespace mcdbn
