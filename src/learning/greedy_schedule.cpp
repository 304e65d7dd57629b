#include "mcdbn/learning/greedy_schedule.hpp"

#include <fmt/format.h>

#include <memory>

#include "base/random_phases.hpp"
#include "base/random_streams.hpp"
#include "device/pointwise.hpp"
#include "learning/clip_weights.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/divergence_guard.hpp"
#include "learning/epoch_clock.hpp"
#include "learning/history_noise.hpp"
#include "learning/minibatch.hpp"
#include "learning/mrbm_rule.hpp"
#include "learning/overall_progress.hpp"
#include "learning/persistent_contrastive_divergence.hpp"
#include "learning/resumable_training.hpp"
#include "learning/unit_values.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

RandomKey key_of(const LearningSettings& learning, std::uint16_t stream, std::uint32_t step,
                 std::uint16_t phase) {
  return {learning.seed, step, stream, phase};
}

bool is_health_epoch(std::size_t epoch, std::size_t epochs) {
  constexpr std::size_t kEvery = 5;
  return epoch == 1 || epoch == epochs || epoch % kEvery == 0;
}

/// One stage of Algorithm 1: a machine's rule and the mini-batches that it learns from.
struct Stage {
  std::string name;
  std::size_t epochs = 0;
  LearningRule& rule;
  /// The sequences that the machine sees, and by how many frames each is ahead of the window's row.
  std::vector<std::pair<const Matrix*, int>> sequences;
  std::function<LayerHealth()> health;  ///< called now and then for the report
  Checkpoints::Visit machine;           ///< what the rule trains
  const Matrix* seen = nullptr;         ///< of the first sequence: LearningStep::seen
};

/// All epochs: shuffle, all mini-batches, one read of the losses, guard, report.
/// @param random of the mini-batches' draws; the stage's own shuffles have another phase
/// @param checkpoints none: nothing is kept
void run_epochs(const Stage& stage, MinibatchSchedule& schedule, DivergenceGuard guard,
                const RandomKey& random, const EpochObserver& observer, Checkpoints* checkpoints) {
  const std::size_t batches = schedule.batch_count();
  Device& device = stage.sequences.front().first->device();
  LossAccumulator losses(device, stage.rule.loss_count(), schedule.batch());
  StageRun run(device, checkpoints, stage.name, stage.machine, [&](TrainingState& state) {
    stage.rule.visit_state(state);
    losses.visit_state(state);
    guard.visit_state(state);
  });
  if (run.is_over()) return;
  EpochClock clock(device);
  LearningStep step;
  step.random = random;
  step.random.step += static_cast<std::uint32_t>(run.done());
  step.seen = stage.seen;
  std::size_t first = run.done() % batches;
  for (step.epoch = 1; step.epoch <= stage.epochs; ++step.epoch) {
    RandomKey shuffle = random;
    shuffle.phase = random_phases::kShuffle;
    shuffle.step = static_cast<std::uint32_t>(step.epoch);
    schedule.shuffle(shuffle);  // each goes on from the one before
    if (step.epoch <= run.done() / batches) continue;
    for (std::size_t i = first; i < batches; ++i) {
      std::vector<Rows> visible;
      for (const auto& [values, ahead] : stage.sequences)
        visible.push_back(Rows::indexed(*values, schedule.index(), schedule.first_of(i),
                                        schedule.batch(), ahead));
      step.progress =
          static_cast<double>(step.random.step) / static_cast<double>(stage.epochs * batches);
      stage.rule.learn(visible, step, losses);
      ++step.random.step;
      if (i + 1 < batches) run.after_step((step.epoch - 1) * batches + i + 1);
    }
    double loss = 0;
    const auto sums = losses.read_and_reset();
    for (const float sum : sums) loss += sum / static_cast<double>(batches * sums.size());
    guard.check(step.epoch, loss);
    if (observer) {
      EpochReport report;
      report.stage = stage.name;
      report.epoch = step.epoch;
      report.epochs = stage.epochs;
      report.loss = loss;
      report.windows_per_s =
          static_cast<double>((batches - first) * schedule.batch()) / clock.took_s();
      report.stage_progress = static_cast<double>(step.epoch) / static_cast<double>(stage.epochs);
      report.overall_progress = report.stage_progress;
      if (is_health_epoch(step.epoch, stage.epochs)) report.health = stage.health();
      observer(report);
      clock.restart();
    }
    first = 0;
    run.after_step(step.epoch * batches);
  }
  run.end();
}

std::unique_ptr<LearningRule> cd_rule(Crbm& crbm, std::size_t batch, const CdSettings& settings) {
  if (settings.persistent)
    return std::make_unique<PersistentContrastiveDivergence>(crbm, batch, settings);
  return std::make_unique<ContrastiveDivergence>(crbm, batch, settings);
}

/// Mean over the rows that have a code. @return [1 x dimension]
MatrixF mean_of(const Sequences& sequences) {
  RowVectorD sum = RowVectorD::Zero(static_cast<Eigen::Index>(sequences.values.columns()));
  const MatrixF values = sequences.values.to_host();
  const auto rows = sequences.window_rows(0);
  for (const std::int32_t row : rows) sum += values.row(row).cast<double>();
  return (sum / static_cast<double>(std::max<std::size_t>(rows.size(), 1))).cast<float>();
}

/// Work of a stage in multiply-adds, to show progress over all of them.
double crbm_cost(const CrbmShape& shape, const CdSettings& settings) {
  const auto v = static_cast<double>(shape.visible), h = static_cast<double>(shape.hidden);
  const double histories =
      2.0 * v *
      (static_cast<double>(shape.order_A()) * v + static_cast<double>(shape.order_B()) * h);
  return static_cast<double>(settings.epochs) *
         (histories + (2.0 * static_cast<double>(settings.gibbs_steps) + 3.0) * v * h);
}

double mrbm_cost(std::size_t codes, const LearningSettings& learning) {
  return static_cast<double>(learning.mrbm.epochs) * 6.0 *
         static_cast<double>(learning.mrbm.mean_field_steps) *
         static_cast<double>(codes * learning.mrbm_hidden);
}

const CdSettings& settings_for(const CrbmShape& shape, const LearningSettings& learning) {
  return shape.kind == VisibleKind::gaussian ? learning.gaussian : learning.binary;
}

double cdbn_cost(const std::vector<CrbmShape>& layers, const LearningSettings& learning) {
  double cost = 0;
  for (const CrbmShape& shape : layers) cost += crbm_cost(shape, settings_for(shape, learning));
  return cost;
}

CrbmParameters small_weights(const CrbmShape& shape, const LearningSettings& learning,
                             std::uint16_t stream) {
  return CrbmParameters::random(shape, settings_for(shape, learning).initial_deviation,
                                key_of(learning, stream, 0, random_phases::kFirstWeights));
}

MatrixF logit(const MatrixF& p) {
  const auto safe = p.array().max(1e-4F).min(1.0F - 1e-4F);
  return (safe / (1.0F - safe)).log().matrix();
}

/// How many frames ahead each modality's code is of those that it belongs to (Mcdbn::ahead).
std::vector<int> frames_ahead(std::size_t modalities, const LearningSettings& learning) {
  std::vector<int> ahead(modalities, 0);
  ahead.front() = static_cast<int>(learning.look_ahead);
  return ahead;
}

/// Rows t such that every modality has a code where it belongs to t.
std::vector<std::int32_t> paired_rows(std::span<const Sequences> codes, std::size_t look_ahead) {
  std::size_t valid_from = 0;
  for (const Sequences& code : codes) valid_from = std::max(valid_from, code.valid_from);
  std::vector<std::int32_t> rows;
  for (const auto& clip : codes.front().clips)
    for (std::size_t t = valid_from; t + look_ahead < clip.frames; ++t)
      rows.push_back(static_cast<std::int32_t>(clip.first + t));
  return rows;
}

MinibatchSchedule minibatches(const Sequences& sequences, const std::vector<std::int32_t>& rows,
                              const LearningSettings& learning) {
  return {sequences.values.device(), rows, learning.batch, learning.least_batches,
          sequences.weights(rows)};
}

/// Sequences of a modality; people weigh as the settings specify.
Sequences weighted(Device& device, const SynchronizedClips& clips, const ModalityClips& modality,
                   const LearningSettings& learning) {
  const auto seen = modality.is_whole() ? std::span<const MatrixF>() : modality.seen;
  Sequences sequences = Sequences::from_host(device, modality.clips, seen);
  const std::vector<double> weights = clip_weights(clips, learning.people_power);
  for (std::size_t i = 0; i < weights.size(); ++i) sequences.clips[i].weight = weights[i];
  return sequences;
}

/// A hundred windows' codes at most, for mrbm_health. @return [rows x dimension] of each modality
std::vector<MatrixF> some_codes(std::span<const Sequences> codes,
                                const LearningSettings& learning) {
  constexpr std::size_t kMost = 100;
  const auto rows = paired_rows(codes, learning.look_ahead);
  std::vector<std::int32_t> some(std::min(kMost, rows.size()));
  for (std::size_t i = 0; i < some.size(); ++i) some[i] = rows[i * rows.size() / some.size()];
  Device& device = codes.front().values.device();
  const IndexBuffer index(device, some);
  const std::vector<int> ahead = frames_ahead(codes.size(), learning);
  std::vector<MatrixF> gathered;
  for (std::size_t m = 0; m < codes.size(); ++m) {
    const Matrix& values = codes[m].values;
    const Matrix out(device, some.size(), values.columns());
    gather(Rows::indexed(values, index, 0, some.size(), ahead[m]), out);
    gathered.push_back(out.to_host());
  }
  return gathered;
}

/// train_crbm() on values that are known to suit.
Crbm learn_crbm(Device& device, const Sequences& visible, CrbmParameters initial,
                const CdSettings& settings, const LearningSettings& learning, std::uint16_t stream,
                const EpochObserver& observer, const std::string& stage, Checkpoints* checkpoints) {
  const CrbmShape shape = initial.shape;
  initial.visible_mean = mean_of(visible);
  Crbm crbm(device, initial);
  MinibatchSchedule schedule = minibatches(visible, visible.window_rows(shape.order), learning);
  const auto rule = cd_rule(crbm, schedule.batch(), settings);
  std::optional<HistoryNoise> noise;
  if (settings.history_noise > 0 && shape.order > 0)
    noise.emplace(device, *rule, shape, schedule.batch(), settings.history_noise);
  const std::vector<MatrixF> windows =
      observer ? crbm_health_windows(visible, shape.order) : std::vector<MatrixF>{};
  const DivergenceGuard guard(stage, what_to_lower(shape, settings));
  run_epochs({stage,
              settings.epochs,
              noise ? static_cast<LearningRule&>(*noise) : *rule,
              {{&visible.values, 0}},
              [&] { return crbm_health(crbm.to_host(), windows); },
              [&](TrainingState& state) {
                state.parameters("parameters", crbm.parameters());
                state.matrix("deviation", crbm.visible_deviation);
                if (state.restores()) crbm.refresh_transposed();
              },
              visible.seen.empty() ? nullptr : &visible.seen},
             schedule, guard, key_of(learning, stream, 0, 0), observer, checkpoints);
  return crbm;
}

/// train_cdbn() likewise.
TrainedCdbn learn_cdbn(Device& device, Sequences visible, const std::vector<CrbmShape>& layers,
                       const LearningSettings& learning, std::uint16_t first_stream,
                       const EpochObserver& observer, const std::string& name, const Cdbn* start,
                       Checkpoints* checkpoints) {
  TrainedCdbn trained;
  trained.code = std::move(visible);
  OverallProgress progress(observer, cdbn_cost(layers, learning));
  std::uint16_t stream = first_stream;
  for (const CrbmShape& shape : layers) {
    const CdSettings& settings = settings_for(shape, learning);
    const std::size_t layer = trained.cdbn.layers.size();
    if (shape.visible != trained.code.values.columns())
      throw ShapeError(fmt::format("CDBN: layer {} has {} visible units, what it learns from {}",
                                   layer, shape.visible, trained.code.values.columns()));
    trained.cdbn.layers.push_back(learn_crbm(
        device, trained.code,
        start ? start->layers.at(layer).to_host() : small_weights(shape, learning, stream),
        settings, learning, stream, progress.part(crbm_cost(shape, settings)),
        fmt::format("{}.{}", name, layer), checkpoints));
    ++stream;
    trained.code = up_pass(trained.cdbn.layers.back(), trained.code);
  }
  return trained;
}

/// train_mrbm() likewise.
Mrbm learn_mrbm(Device& device, std::span<const Sequences> codes, const MrbmParameters& initial,
                const LearningSettings& learning, std::uint16_t stream,
                const EpochObserver& observer, Checkpoints* checkpoints) {
  const MrbmSettings& settings = learning.mrbm;
  Mrbm mrbm(device, initial);
  MinibatchSchedule schedule =
      minibatches(codes.front(), paired_rows(codes, learning.look_ahead), learning);
  const std::unique_ptr<LearningRule> rule = make_mrbm_rule(mrbm, schedule.batch(), settings);
  DivergenceGuard guard(
      "mrbm", fmt::format("lower `mrbm.rate` (now {:g}) or `mrbm.initial-deviation` (now {:g})",
                          settings.rate, settings.initial_deviation));
  const std::vector<int> ahead = frames_ahead(codes.size(), learning);
  std::vector<std::pair<const Matrix*, int>> sequences;
  for (std::size_t m = 0; m < codes.size(); ++m) sequences.emplace_back(&codes[m].values, ahead[m]);
  const std::vector<MatrixF> some = some_codes(codes, learning);
  run_epochs({"mrbm", settings.epochs, *rule, std::move(sequences),
              [&] { return mrbm_health(mrbm.to_host(), some); },
              [&](TrainingState& state) {
                state.parameters("parameters", mrbm.parameters());
                if (state.restores()) mrbm.refresh_transposed();
              }},
             schedule, guard, key_of(learning, stream, 0, 0), observer, checkpoints);
  return mrbm;
}

}  // namespace

MrbmParameters initial_mrbm_weights(const MrbmShape& shape, std::span<const Sequences> codes,
                                    const LearningSettings& learning) {
  if (codes.size() != shape.modalities.size())
    throw ShapeError("MRBM: other modalities than sequences");
  MrbmParameters initial = MrbmParameters::random(
      shape, learning.mrbm.initial_deviation,
      key_of(learning, random_streams::kMrbm, 0, random_phases::kFirstWeights));
  // The mean field then starts near the codes' own means rather than at one half.
  for (std::size_t m = 0; m < codes.size(); ++m)
    initial.a[m] = shape.modalities[m].kind == VisibleKind::binary ? logit(mean_of(codes[m]))
                                                                   : mean_of(codes[m]);
  return initial;
}

std::vector<CrbmShape> layer_shapes(std::size_t visible, const LearningSettings& learning,
                                    VisibleKind kind) {
  std::vector<CrbmShape> shapes{{visible, learning.hidden, learning.order, kind}};
  while (shapes.size() < learning.layers)
    shapes.push_back({learning.hidden, learning.hidden, learning.order, VisibleKind::binary});
  return shapes;
}

TrainedCdbn train_cdbn(Device& device, Sequences visible, const std::vector<CrbmShape>& layers,
                       const LearningSettings& learning, std::uint16_t first_stream,
                       const EpochObserver& observer, const std::string& name, const Cdbn* start) {
  if (!layers.empty()) check_unit_values(visible, layers.front().kind, fmt::format("{}.0", name));
  return learn_cdbn(device, std::move(visible), layers, learning, first_stream, observer, name,
                    start, nullptr);
}

Crbm train_crbm(Device& device, const Sequences& visible, CrbmParameters initial,
                const CdSettings& settings, const LearningSettings& learning, std::uint16_t stream,
                const EpochObserver& observer, const std::string& stage) {
  check_unit_values(visible, initial.shape.kind, stage);
  return learn_crbm(device, visible, std::move(initial), settings, learning, stream, observer,
                    stage, nullptr);
}

Mrbm train_mrbm(Device& device, std::span<const Sequences> codes, const MrbmParameters& initial,
                const LearningSettings& learning, std::uint16_t stream,
                const EpochObserver& observer) {
  check_codes(codes, initial.shape.modalities);
  return learn_mrbm(device, codes, initial, learning, stream, observer, nullptr);
}

Mcdbn train_greedy(Device& device, const SequenceSource& source, const LearningSettings& learning,
                   const EpochObserver& observer, const Mcdbn* start) {
  return train_greedy(device, nullptr, source, learning, observer, start);
}

Mcdbn train_greedy(Device& device, Checkpoints* checkpoints, const SequenceSource& source,
                   const LearningSettings& learning, const EpochObserver& observer,
                   const Mcdbn* start) {
  learning.validate();
  const SynchronizedClips clips = source.sequences();
  clips.check();
  const std::size_t modalities = clips.modalities.size();
  if (modalities > random_streams::kMostModalities)
    throw ConfigError(
        fmt::format("{} modalities; {} are the most", modalities, random_streams::kMostModalities));
  MrbmShape shape{{}, learning.mrbm_hidden};
  std::vector<std::vector<CrbmShape>> layers;
  const double last_cost = mrbm_cost(modalities * learning.hidden, learning);
  double total = last_cost;
  for (const ModalityClips& modality : clips.modalities) {
    layers.push_back(layer_shapes(modality.dimension(), learning, modality.kind));
    if (learns_deviation(layers.back().front(), learning.gaussian) && !modality.is_whole())
      throw ConfigError(fmt::format(
          "`gaussian.deviation-rate` (now {:g}): a deviation is learnt from values that were all "
          "seen, and of {} some were not; set it to 0",
          learning.gaussian.deviation_rate, modality.name));
    shape.modalities.push_back({modality.name, layers.back().back().hidden});
    total += cdbn_cost(layers.back(), learning);
  }
  shape.check();
  OverallProgress progress(observer, total);
  std::vector<Cdbn> cdbns(modalities);
  std::vector<Sequences> codes(modalities);
  // Algorithm 1 begins with 3D, the last.
  for (std::size_t i = 0; i < modalities; ++i) {
    const std::size_t m = modalities - 1 - i;
    const ModalityClips& modality = clips.modalities[m];
    TrainedCdbn trained =
        learn_cdbn(device, weighted(device, clips, modality, learning), layers[m], learning,
                   random_streams::layers_of(i), progress.part(cdbn_cost(layers[m], learning)),
                   modality.name, start ? &start->cdbns.at(m) : nullptr, checkpoints);
    cdbns[m] = std::move(trained.cdbn);
    codes[m] = std::move(trained.code);
  }
  Mrbm mrbm = learn_mrbm(
      device, codes, start ? start->mrbm.to_host() : initial_mrbm_weights(shape, codes, learning),
      learning, random_streams::kMrbm, progress.part(last_cost), checkpoints);
  const RegenerationSettings& drawn = learning.regeneration;
  return {std::move(cdbns), std::move(mrbm), learning.look_ahead, learning.mrbm.mean_field_steps,
          SamplingRule{.gibbs_steps = drawn.gibbs_steps,
                       .mrbm_gibbs_steps = drawn.mrbm_gibbs_steps,
                       .sampled = drawn.sampled}};
}

}  // namespace mcdbn
