#include "learning/bench_steps.hpp"

#include <array>
#include <memory>
#include <numeric>

#include "device/gemm.hpp"
#include "learning/bench_work.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/joint_likelihood.hpp"
#include "learning/minibatch.hpp"
#include "learning/multi_prediction.hpp"
#include "learning/persistent_contrastive_divergence.hpp"
#include "machines/mrbm_chain.hpp"
#include "mcdbn/learning/learning_settings.hpp"
#include "mcdbn/machines/generation.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn {
namespace {

constexpr std::size_t kFrames = 4096;
constexpr double kWeightDeviation = 0.01;

/// Standard normal, or what is left of it within 0 … 1 around one half for binary units.
MatrixF random_frames(std::size_t rows, std::size_t columns, VisibleKind kind) {
  const RandomKey key{1, 0, 7, 0};
  MatrixF frames(rows, columns);
  for (Eigen::Index r = 0; r < frames.rows(); ++r)
    for (Eigen::Index c = 0; c < frames.cols(); ++c)
      frames(r, c) = static_cast<float>(
          random_normal(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c)));
  if (kind == VisibleKind::binary)
    frames = (0.5F + 0.2F * frames.array()).max(0.0F).min(1.0F).matrix();
  return frames;
}

/// Rows scattered over the frames, as a shuffled epoch has them.
IndexBuffer scattered_rows(Device& device, std::size_t batch, std::size_t order) {
  std::vector<std::int32_t> rows;
  for (std::size_t i = 0; i < batch; ++i)
    rows.push_back(static_cast<std::int32_t>(order + i * 2654435761U % (kFrames - order)));
  return {device, rows};
}

/// @param Rule ContrastiveDivergence, or the persistent one  @param prefix of the layer's name
template <typename Rule>
BenchStep crbm_step(Device& device, const CrbmShape& shape, std::size_t batch,
                    std::size_t gibbs_steps, const std::string& prefix = "") {
  struct State {
    Matrix frames;
    IndexBuffer index;
    Crbm crbm;
    Rule cd;
    LossAccumulator losses;
    CdRule rule;
    RandomKey key;
    State(Device& device, const CrbmShape& shape, std::size_t batch)
        : frames(Matrix::from_host(device, random_frames(kFrames, shape.visible, shape.kind))),
          index(scattered_rows(device, batch, shape.order)),
          crbm(device, CrbmParameters::random(shape, kWeightDeviation, {})),
          cd(crbm, batch),
          losses(device, 1, batch) {}
  };
  const auto state = std::make_shared<State>(device, shape, batch);
  state->rule.gibbs_steps = gibbs_steps;
  state->rule.W = state->rule.B = {1e-3F, 0.9F, 2e-4F};
  state->rule.A = {1e-5F, 0.9F, 2e-4F};
  const auto work = contrastive_divergence_work(shape, batch, gibbs_steps);
  return {
      {{"layer", prefix + (shape.kind == VisibleKind::gaussian ? "gaussian_crbm" : "binary_crbm")},
       {"visible", shape.visible},
       {"order", shape.order},
       {"hidden", shape.hidden},
       {"batch", batch},
       {"k", gibbs_steps}},
      flops_of(work),
      [state, batch] {
        ++state->key.step;
        state->cd.step(Rows::indexed(state->frames, state->index, 0, batch), state->rule,
                       state->key, state->losses);
      },
      work};
}

/// A whole epoch as `train` runs it, over `frames` windows: shuffle, upload the order, all
/// mini-batches.
BenchStep epoch_step(Device& device, std::size_t frames) {
  struct State {
    Matrix frames;
    MinibatchSchedule schedule;
    Crbm crbm;
    ContrastiveDivergence cd;
    LossAccumulator losses;
    RandomKey key;
    State(Device& device, const CrbmShape& shape, std::size_t count, std::size_t batch,
          const CdSettings& settings)
        : frames(Matrix::from_host(device,
                                   random_frames(shape.order + count, shape.visible, shape.kind))),
          schedule(device, rows_after(shape.order, count), batch),
          crbm(device, CrbmParameters::random(shape, kWeightDeviation, {})),
          cd(crbm, batch, settings),
          losses(device, 1, batch) {}
    static std::vector<std::int32_t> rows_after(std::size_t order, std::size_t count) {
      std::vector<std::int32_t> rows(count);
      std::iota(rows.begin(), rows.end(), static_cast<std::int32_t>(order));
      return rows;
    }
  };
  const CrbmShape shape{96, 300, 5, VisibleKind::gaussian};
  constexpr std::size_t kBatch = 100;
  const CdSettings settings = LearningSettings{}.gaussian;
  const CdRule rule = cd_rule_for(settings, 1);
  const auto state = std::make_shared<State>(device, shape, frames, kBatch, settings);
  return {{{"layer", "epoch"}, {"frames", frames}, {"batch", kBatch}, {"k", rule.gibbs_steps}},
          0.0,
          [state, rule] {
            MinibatchSchedule& schedule = state->schedule;
            schedule.shuffle(state->key);
            for (std::size_t i = 0; i < schedule.batch_count(); ++i) {
              ++state->key.step;
              state->cd.step(Rows::indexed(state->frames, schedule.index(), schedule.first_of(i),
                                           schedule.batch()),
                             rule, state->key, state->losses);
            }
          }};
}

/// An MRBM of as many binary units in each modality, and codes of them.
struct MrbmState {
  std::vector<Matrix> codes;
  IndexBuffer index;
  Mrbm mrbm;

  MrbmState(Device& device, std::size_t modalities, std::size_t visible, std::size_t hidden,
            std::size_t batch)
      : index(scattered_rows(device, batch, 0)),
        mrbm(device,
             MrbmParameters::random(shape(modalities, visible, hidden), kWeightDeviation, {})) {
    for (std::size_t m = 0; m < modalities; ++m)
      codes.push_back(
          Matrix::from_host(device, random_frames(kFrames, visible, VisibleKind::binary)));
  }

  static MrbmShape shape(std::size_t modalities, std::size_t visible, std::size_t hidden) {
    MrbmShape shape{{}, hidden};
    for (std::size_t m = 0; m < modalities; ++m)
      shape.modalities.push_back({std::to_string(m), visible});
    return shape;
  }
  std::vector<Rows> rows(std::size_t batch) const {
    std::vector<Rows> rows;
    for (const Matrix& code : codes) rows.push_back(Rows::indexed(code, index, 0, batch));
    return rows;
  }
};

BenchStep mrbm_step(Device& device, std::size_t modalities, std::size_t visible, std::size_t hidden,
                    std::size_t batch, std::size_t mean_field_steps) {
  struct State : MrbmState {
    MultiPrediction multi_prediction;
    LossAccumulator losses;
    State(Device& device, std::size_t modalities, std::size_t visible, std::size_t hidden,
          std::size_t batch, std::size_t steps)
        : MrbmState(device, modalities, visible, hidden, batch),
          multi_prediction(mrbm, batch, {.mean_field_steps = steps}),
          losses(device, modalities, batch) {}
  };
  const auto state =
      std::make_shared<State>(device, modalities, visible, hidden, batch, mean_field_steps);
  const auto work = multi_prediction_work(modalities, visible, hidden, batch, mean_field_steps);
  return {{{"layer", "mrbm"},
           {"modalities", modalities},
           {"visible", modalities * visible},
           {"hidden", hidden},
           {"batch", batch},
           {"steps", mean_field_steps}},
          flops_of(work),
          [state, batch] {
            state->multi_prediction.step(state->rows(batch), UpdateRule::adam(), state->losses);
          },
          work};
}

/// Contrastive divergence over both modalities at once.
BenchStep joint_likelihood_step(Device& device, std::size_t visible, std::size_t hidden,
                                std::size_t batch, std::size_t gibbs_steps) {
  struct State : MrbmState {
    JointLikelihood rule;
    LossAccumulator losses;
    LearningStep step;
    State(Device& device, std::size_t visible, std::size_t hidden, std::size_t batch,
          std::size_t gibbs_steps)
        : MrbmState(device, 2, visible, hidden, batch),
          rule(mrbm, batch, {.gibbs_steps = gibbs_steps}),
          losses(device, 2, batch) {}
  };
  const auto state = std::make_shared<State>(device, visible, hidden, batch, gibbs_steps);
  const auto work = joint_likelihood_work(2, visible, hidden, batch, gibbs_steps);
  return {{{"layer", "joint_likelihood"},
           {"visible", 2 * visible},
           {"hidden", hidden},
           {"batch", batch},
           {"k", gibbs_steps}},
          flops_of(work),
          [state, batch] {
            ++state->step.random.step;
            state->rule.learn(state->rows(batch), state->step, state->losses);
          },
          work};
}

/// Inference of one modality from the other, mean field or sampled.
BenchStep mrbm_chain_step(Device& device, std::size_t visible, std::size_t hidden,
                          std::size_t batch, std::size_t steps, double temperature) {
  struct State : MrbmState {
    Matrix inferred;
    MrbmChain chain;
    State(Device& device, std::size_t visible, std::size_t hidden, std::size_t batch)
        : MrbmState(device, 2, visible, hidden, batch),
          inferred(device, batch, visible),
          chain(mrbm, {true, false}, batch) {}
  };
  const auto state = std::make_shared<State>(device, visible, hidden, batch);
  MrbmChainOptions options;
  options.steps = steps;
  options.temperature = static_cast<float>(temperature);
  // The first pass up has the present modalities' input alone.
  const double multiply_adds = 2.0 * static_cast<double>(steps * visible * hidden);
  return {{{"layer", "mrbm_chain"},
           {"visible", 2 * visible},
           {"hidden", hidden},
           {"batch", batch},
           {"steps", steps},
           {"temperature", temperature}},
          2.0 * multiply_adds * static_cast<double>(batch),
          [=] {
            state->chain.run({Rows(state->codes[0], 0, batch), state->inferred}, options);
          }};
}

BenchStep gemm_step(Device& device, std::size_t m, std::size_t n, std::size_t k,
                    GemmBackend backend) {
  const auto matrix = [&](std::size_t rows, std::size_t columns) {
    return std::make_shared<Matrix>(
        Matrix::from_host(device, random_frames(rows, columns, VisibleKind::gaussian)));
  };
  const auto a = matrix(m, k), b = matrix(k, n), c = matrix(m, n);
  GemmOptions options;
  options.backend = backend;
  return {{{"layer", "gemm"},
           {"m", m},
           {"n", n},
           {"k", k},
           {"backend", backend == GemmBackend::own ? "own" : "clblast"}},
          2.0 * static_cast<double>(m * n * k),
          [=] { gemm(*a, *b, *c, options); }};
}

Cdbn random_cdbn(Device& device, std::size_t visible, std::size_t hidden, std::size_t order) {
  Cdbn cdbn;
  for (const CrbmShape& shape : {CrbmShape{visible, hidden, order, VisibleKind::gaussian},
                                 CrbmShape{hidden, hidden, order, VisibleKind::binary}})
    cdbn.layers.emplace_back(device, CrbmParameters::random(shape, kWeightDeviation, {}));
  return cdbn;
}

BenchStep regeneration_step(Device& device, double temperature) {
  constexpr std::size_t kTrack = 43, kPose = 96, kHidden = 300, kOrder = 5, kClipFrames = 1000;
  const auto network = std::make_shared<Mcdbn>(Mcdbn{
      {random_cdbn(device, kTrack, kHidden, kOrder), random_cdbn(device, kPose, kHidden, kOrder)},
      MrbmState(device, 2, kHidden, kHidden, 1).mrbm,
      5,
      5});
  RegenerationOptions options;
  options.samples = 10;
  options.temperature = temperature;
  const std::vector<MatrixF> tracks{random_frames(kClipFrames, kTrack, VisibleKind::gaussian)};
  return {{{"layer", "regeneration"},
           {"frames", kClipFrames},
           {"samples", options.samples},
           {"temperature", temperature},
           {"k", temperature > 0.0 ? options.sampling.gibbs_steps : 0}},
          0.0,
          [=] { regenerate(*network, tracks, options); }};
}

/// Ten samples that run freely, each frame with that many Gibbs steps.
BenchStep generation_step(Device& device, std::size_t gibbs_steps) {
  constexpr std::size_t kVisible = 96, kHidden = 300, kOrder = 5;
  const auto cdbn = std::make_shared<Cdbn>();
  cdbn->layers.emplace_back(
      device, CrbmParameters::random({kVisible, kHidden, kOrder, VisibleKind::gaussian},
                                     kWeightDeviation, {}));
  GenerationOptions options;
  options.frames = 1000;
  options.samples = 10;
  options.gibbs_steps = gibbs_steps;
  const std::vector<MatrixF> seeds{random_frames(kOrder, kVisible, VisibleKind::gaussian)};
  // Both dynamic biases; up and down in each drawn step and in the last.
  const double multiply_adds = static_cast<double>(kOrder * kVisible * (kVisible + kHidden) +
                                                   2 * (gibbs_steps + 1) * kVisible * kHidden);
  return {{{"layer", "generation"},
           {"frames", options.frames},
           {"samples", options.samples},
           {"k", gibbs_steps}},
          2.0 * multiply_adds * static_cast<double>(options.frames * options.samples),
          [=] { generate(*cdbn, seeds, options); }};
}

}  // namespace

std::vector<BenchStepMaker> crbm_minibatch_steps(std::size_t batch) {
  return {{"gaussian_crbm",
           [=](Device& device) {
             return crbm_step<ContrastiveDivergence>(device, {96, 300, 5, VisibleKind::gaussian},
                                                     batch, 5);
           }},
          {"binary_crbm", [=](Device& device) {
             return crbm_step<ContrastiveDivergence>(device, {300, 300, 5, VisibleKind::binary},
                                                     batch, 1);
           }}};
}

std::vector<BenchStepMaker> bench_steps() {
  std::vector<BenchStepMaker> makers;
  const auto add = [&](const char* layer, std::function<BenchStep(Device&)> make) {
    makers.push_back({layer, std::move(make)});
  };
  for (const std::size_t batch : {100U, 1024U}) {
    for (BenchStepMaker& maker : crbm_minibatch_steps(batch)) makers.push_back(std::move(maker));
    add("persistent_gaussian_crbm", [=](Device& device) {
      return crbm_step<PersistentContrastiveDivergence>(device, {96, 300, 5, VisibleKind::gaussian},
                                                        batch, 5, "persistent_");
    });
    add("persistent_binary_crbm", [=](Device& device) {
      return crbm_step<PersistentContrastiveDivergence>(device, {300, 300, 5, VisibleKind::binary},
                                                        batch, 1, "persistent_");
    });
    for (const std::size_t modalities : {2U, 3U})
      add("mrbm",
          [=](Device& device) { return mrbm_step(device, modalities, 300, 150, batch, 10); });
    add("joint_likelihood",
        [=](Device& device) { return joint_likelihood_step(device, 300, 150, batch, 1); });
    for (const double temperature : {0.0, 1.0})
      add("mrbm_chain", [=](Device& device) {
        return mrbm_chain_step(device, 300, 150, batch, 10, temperature);
      });
  }
  for (const auto backend : {GemmBackend::own, GemmBackend::clblast})
    for (const auto& [m, n, k] : {std::array<std::size_t, 3>{100, 300, 96},
                                  {100, 300, 480},
                                  {100, 300, 1500},
                                  {1024, 300, 1500}})
      add("gemm",
          [=, m = m, n = n, k = k](Device& device) { return gemm_step(device, m, n, k, backend); });
  for (BenchStepMaker& maker : fine_tuning_steps()) makers.push_back(std::move(maker));
  for (const double temperature : {0.0, 1.0})
    add("regeneration", [=](Device& device) { return regeneration_step(device, temperature); });
  for (const std::size_t gibbs_steps : {1U, 30U})
    add("generation", [=](Device& device) { return generation_step(device, gibbs_steps); });
  return makers;
}

std::vector<BenchStepMaker> epoch_steps() {
  std::vector<BenchStepMaker> makers;
  for (const std::size_t frames : {1'000U, 10'000U, 100'000U, 1'000'000U})
    makers.push_back({"epoch", [=](Device& device) { return epoch_step(device, frames); }});
  return makers;
}

}  // namespace mcdbn
