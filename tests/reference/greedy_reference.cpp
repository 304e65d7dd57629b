#include "reference/greedy_reference.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mcdbn/base/random.hpp"
#include "reference/units_reference.hpp"
#include "reference/update_reference.hpp"

namespace mcdbn::reference {
namespace {

constexpr int kPoseStream = 0, kTrackStream = 64, kMrbmStream = 128;
constexpr int kShufflePhase = 0x7000, kNoisePhase = 0x7200;
constexpr int kWeightsW = 0x7101, kWeightsA = 0x7102, kWeightsB = 0x7103;

RandomKey random_key(const GreedyPlan& plan, int stream, int step, int phase) {
  return {plan.seed, static_cast<std::uint32_t>(step), static_cast<std::uint16_t>(stream),
          static_cast<std::uint16_t>(phase)};
}

/// One frame of one clip; its history is what comes before.
struct Window {
  std::size_t clip;
  Eigen::Index frame;
};

/// Frames of every clip from `first` on that have `ahead` frames behind them.
std::vector<Window> windows_of(const GreedyCode& code, int first, int ahead) {
  std::vector<Window> windows;
  for (std::size_t clip = 0; clip < code.clips.size(); ++clip)
    for (Eigen::Index t = first; t + ahead < code.clips[clip].rows(); ++t)
      windows.push_back({clip, t});
  return windows;
}

/// How often each window is drawn, but for a common factor.
std::vector<double> weights_of(const GreedyPlan& plan, const GreedyCode& code,
                               const std::vector<Window>& windows) {
  std::vector<double> weights;
  for (const Window& window : windows) {
    double frames = 0;
    for (std::size_t clip = 0; clip < code.clips.size(); ++clip)
      if (plan.groups.at(clip) == plan.groups.at(window.clip))
        frames += static_cast<double>(code.clips[clip].rows());
    weights.push_back(std::pow(frames, plan.people_power) / frames);
  }
  return weights;
}

/// The windows of all epochs, mini-batch after mini-batch.
class Batches {
 public:
  Batches(const GreedyPlan& plan, const GreedyCode& code, const std::vector<Window>& windows,
          int stream)
      : plan_(plan),
        stream_(stream),
        choices_(windows),
        batch_(std::min(static_cast<std::size_t>(plan.batch), windows.size())) {
    do {
      order_.insert(order_.end(), windows.begin(), windows.end());
    } while (static_cast<int>(order_.size() / batch_) < plan.least_batches);
    if (plan.people_power != 1) weights_ = weights_of(plan, code, windows);
  }

  int count() const { return static_cast<int>(order_.size() / batch_); }

  /// Exchanges each place, from the last on, with one at or before it; goes on from the order of
  /// the epoch before. With weights, windows are laid out as long as they weigh, and those come
  /// that lie at equal steps from one drawn place.
  void shuffle(int epoch) {
    const RandomKey key = random_key(plan_, stream_, epoch, kShufflePhase);
    if (!weights_.empty()) {
      const double place = random_uniform(key, 0, 1);
      const double total = std::accumulate(weights_.begin(), weights_.end(), 0.0);
      for (std::size_t i = 0; i < order_.size(); ++i) {
        double left = (static_cast<double>(i) + place) / static_cast<double>(order_.size()) * total;
        std::size_t chosen = 0;
        while (left >= weights_[chosen]) left -= weights_[chosen++];
        order_[i] = choices_[chosen];
      }
    }
    for (std::size_t i = order_.size(); i-- > 1;) {
      const double share = random_bits(key, static_cast<std::uint32_t>(i), 0) * 0x1p-32;
      const auto other = static_cast<std::size_t>(share * static_cast<double>(i + 1));
      std::swap(order_[i], order_[other]);
    }
  }

  std::vector<Window> batch(int number) const {
    const auto first = order_.begin() + number * static_cast<std::ptrdiff_t>(batch_);
    return {first, first + static_cast<std::ptrdiff_t>(batch_)};
  }

 private:
  const GreedyPlan& plan_;
  int stream_;
  std::vector<Window> choices_;
  std::vector<double> weights_;
  std::size_t batch_;
  std::vector<Window> order_;
};

MatrixD rows_of(const GreedyCode& code, const std::vector<Window>& windows, int shift) {
  MatrixD rows(windows.size(), code.clips.front().cols());
  for (std::size_t r = 0; r < windows.size(); ++r)
    rows.row(static_cast<Eigen::Index>(r)) =
        code.clips[windows[r].clip].row(windows[r].frame + shift);
  return rows;
}

CrbmBatch batch_of(const GreedyCode& code, const std::vector<Window>& windows, int order) {
  const Eigen::Index visible = code.clips.front().cols();
  CrbmBatch batch{rows_of(code, windows, 0), MatrixD(windows.size(), order * visible)};
  for (int q = 0; q < order; ++q)
    batch.history.middleCols(q * visible, visible) = rows_of(code, windows, q - order);
  return batch;
}

/// Adds normal draws to the histories, a row for each frame of each window, the current one too.
void add_noise(MatrixD& history, Eigen::Index visible, double deviation, const RandomKey& key) {
  const Eigen::Index order = history.cols() / visible;
  for (Eigen::Index window = 0; window < history.rows(); ++window)
    for (Eigen::Index i = 0; i < history.cols(); ++i)
      history(window, i) +=
          deviation * random_normal(key,
                                    static_cast<std::uint32_t>(window * (order + 1) + i / visible),
                                    static_cast<std::uint32_t>(i % visible));
}

int order_of(const Crbm& crbm) {
  const auto rows = std::max(crbm.visible_history.rows(), crbm.hidden_history.rows());
  return static_cast<int>(rows / crbm.weights.rows());
}

/// Normal draws, rounded as the device holds them.
MatrixD normal_draws(Eigen::Index rows, Eigen::Index columns, double deviation,
                     const RandomKey& key) {
  MatrixD draws(rows, columns);
  for (Eigen::Index r = 0; r < rows; ++r)
    for (Eigen::Index c = 0; c < columns; ++c)
      draws(r, c) = static_cast<float>(deviation * random_normal(key, static_cast<std::uint32_t>(r),
                                                                 static_cast<std::uint32_t>(c)));
  return draws;
}

Crbm small_weights(const GreedyPlan& plan, Eigen::Index visible, bool gaussian, int stream) {
  const double deviation = (gaussian ? plan.gaussian : plan.binary).initial_deviation;
  const auto draw = [&](Eigen::Index rows, Eigen::Index columns, int phase) {
    return normal_draws(rows, columns, deviation, random_key(plan, stream, 0, phase));
  };
  return {gaussian ? VisibleUnits::gaussian : VisibleUnits::binary,
          draw(visible, plan.hidden, kWeightsW),
          draw(plan.order * visible, visible, kWeightsA),
          draw(plan.order * visible, plan.hidden, kWeightsB),
          RowVectorD::Zero(visible),
          RowVectorD::Zero(plan.hidden)};
}

RowVectorD mean_of(const GreedyCode& code) {
  const auto windows = windows_of(code, code.valid_from, 0);
  return rows_of(code, windows, 0).colwise().mean();
}

/// log(p / (1 − p)), p kept off 0 and 1.
RowVectorD logit(const RowVectorD& p) {
  const Eigen::ArrayXXd safe = p.array().max(1e-4).min(1.0 - 1e-4);
  return (safe / (1.0 - safe)).log().matrix();
}

Mrbm small_weights(const GreedyPlan& plan, const GreedyCode& track, const GreedyCode& pose) {
  Mrbm mrbm;
  for (int m = 0; m < 2; ++m) {
    mrbm.weights.push_back(normal_draws(plan.hidden, plan.mrbm_hidden, plan.mrbm.initial_deviation,
                                        random_key(plan, kMrbmStream, m, kWeightsW)));
    mrbm.visible_bias.push_back(logit(mean_of(m == 0 ? track : pose)));
  }
  mrbm.hidden_bias = RowVectorD::Zero(plan.mrbm_hidden);
  return mrbm;
}

GreedyStage train_mrbm(const GreedyPlan& plan, const GreedyCode& track, const GreedyCode& pose,
                       Mrbm& mrbm) {
  const int steps = plan.mrbm.mean_field_steps;
  const auto losses_of = [&](const std::vector<MatrixD>& batch) {
    double sum = 0;
    for (int present = 0; present < 2; ++present) {
      const MatrixD& target = batch[1 - present];
      const MeanFieldTrace trace =
          mean_field(mrbm, static_cast<std::size_t>(1 - present), batch, steps);
      sum += cross_entropy_of_sigmoid(target, trace.missing_input) /
             static_cast<double>(target.size());
    }
    return sum / 2;
  };
  Batches batches(plan, pose, windows_of(pose, pose.valid_from, plan.look_ahead), kMrbmStream);
  const Mrbm zero = mrbm.with_parameters(Eigen::VectorXd::Zero(mrbm.flattened().size()));
  // Weights and biases are updated alike but for the decay, so they go through flat vectors.
  Mrbm unit_weights = zero;
  for (MatrixD& weights : unit_weights.weights) weights.setOnes();
  const Eigen::VectorXd decays = unit_weights.flattened();
  MatrixD mean = MatrixD::Zero(1, decays.size()), square = mean;
  GreedyStage stage{"mrbm", {}};
  int step = 0;
  for (int epoch = 1; epoch <= plan.mrbm.epochs; ++epoch) {
    batches.shuffle(epoch);
    double loss = 0;
    for (int number = 0; number < batches.count(); ++number, ++step) {
      const auto windows = batches.batch(number);
      const std::vector<MatrixD> batch{rows_of(track, windows, plan.look_ahead),
                                       rows_of(pose, windows, 0)};
      loss += losses_of(batch) / batches.count();
      const Eigen::VectorXd gradient = multi_prediction(mrbm, batch, steps).gradient.flattened();
      // Flat in the first half, then in a line to a fiftieth.
      const double progress = static_cast<double>(step) / (plan.mrbm.epochs * batches.count());
      UpdateRule rule{.momentum = 0.9F, .weight_decay = 0, .beta2 = 0.999F, .epsilon = 1e-8F};
      rule.rate = static_cast<float>(plan.mrbm.rate *
                                     (progress < 0.5 ? 1.0 : 1.0 - 0.98 * (2.0 * progress - 1.0)));
      MatrixD updated = mrbm.flattened().transpose();
      const MatrixD shrunk = double{rule.rate} *
                             double{static_cast<float>(plan.mrbm.weight_decay)} *
                             updated.cwiseProduct(decays.transpose());
      adam_update(updated, mean, square, gradient.transpose(), rule, step + 1);
      mrbm = mrbm.with_parameters((updated - shrunk).transpose());
    }
    stage.losses.push_back(loss);
  }
  return stage;
}

void train_modality(const GreedyPlan& plan, const std::string& name, int first_stream,
                    const std::vector<GreedyLayer>* start, GreedyCode& code,
                    std::vector<GreedyLayer>& layers, GreedyRun& run) {
  for (int layer = 0; layer < plan.layers; ++layer) {
    const bool gaussian = layer == 0;
    const int stream = first_stream + layer;
    const Crbm initial = start ? start->at(static_cast<std::size_t>(layer)).crbm
                               : small_weights(plan, code.clips.front().cols(), gaussian, stream);
    GreedyRun trained =
        train_layer(plan, gaussian ? plan.gaussian : plan.binary, code, initial, stream);
    layers.push_back(trained.machine.pose.front());
    run.closest_draw = std::min(run.closest_draw, trained.closest_draw);
    run.stages.push_back({name + "." + std::to_string(layer), trained.stages.front().losses});
    code = up_pass(layers.back().crbm, code);
  }
}

}  // namespace

GreedyCode up_pass(const Crbm& layer, const GreedyCode& visible) {
  const int order = order_of(layer);
  GreedyCode code;
  code.valid_from = visible.valid_from + order;
  for (std::size_t clip = 0; clip < visible.clips.size(); ++clip) {
    MatrixD rows = MatrixD::Zero(visible.clips[clip].rows(), layer.weights.cols());
    for (Eigen::Index t = code.valid_from; t < rows.rows(); ++t) {
      const CrbmBatch one = batch_of(visible, {{clip, t}}, order);
      rows.row(t) = hidden_probability(layer, one.visible, dynamic_hidden_bias(layer, one.history));
    }
    code.clips.push_back(rows);
  }
  return code;
}

GreedyRun train_layer(const GreedyPlan& plan, const CdPlan& rule, const GreedyCode& visible,
                      const Crbm& initial, int stream) {
  const int order = order_of(initial);
  Crbm crbm = initial;
  Crbm velocity = crbm.with_parameters(Eigen::VectorXd::Zero(crbm.flattened().size()));
  Batches batches(plan, visible, windows_of(visible, visible.valid_from + order, 0), stream);
  GreedyRun run;
  run.stages.push_back({"crbm", {}});
  int step = 0;
  for (int epoch = 1; epoch <= rule.epochs; ++epoch) {
    batches.shuffle(epoch);
    const double momentum = epoch > rule.momentum_from_epoch ? rule.momentum : 0.0;
    const auto rule_of = [&](double rate) {
      return UpdateRule{static_cast<float>(rate), static_cast<float>(momentum),
                        static_cast<float>(rule.weight_decay)};
    };
    double loss = 0;
    for (int number = 0; number < batches.count(); ++number, ++step) {
      CrbmBatch batch = batch_of(visible, batches.batch(number), order);
      if (rule.history_noise > 0)
        add_noise(batch.history, batch.visible.cols(), rule.history_noise,
                  random_key(plan, stream, step, kNoisePhase));
      const HiddenDraws draws = [&](int gibbs_step) {
        MatrixD uniform(batch.visible.rows(), crbm.weights.cols());
        for (Eigen::Index r = 0; r < uniform.rows(); ++r)
          for (Eigen::Index c = 0; c < uniform.cols(); ++c)
            uniform(r, c) =
                random_uniform(random_key(plan, stream, step, gibbs_step),
                               static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
        return uniform;
      };
      const CdResult cd = contrastive_divergence(crbm, batch, rule.gibbs_steps, draws);
      run.closest_draw = std::min(run.closest_draw, cd.closest_draw);
      loss += (batch.visible - cd.reconstruction).squaredNorm() /
              static_cast<double>(batch.visible.size() * batches.count());
      update(crbm, velocity, cd.gradient, rule_of(rule.rate), rule_of(rule.rate_A),
             rule_of(rule.rate_B));
    }
    run.stages.front().losses.push_back(loss);
  }
  run.machine.pose.push_back({crbm, mean_of(visible)});
  return run;
}

GreedyRun train_greedy(const GreedyPlan& plan, const std::vector<MatrixD>& tracks,
                       const std::vector<MatrixD>& poses, const GreedyMachine* start) {
  GreedyRun run;
  GreedyCode pose{poses, 0}, track{tracks, 0};
  train_modality(plan, "pose", kPoseStream, start ? &start->pose : nullptr, pose, run.machine.pose,
                 run);
  train_modality(plan, "track", kTrackStream, start ? &start->track : nullptr, track,
                 run.machine.track, run);
  run.machine.mrbm = start ? start->mrbm : small_weights(plan, track, pose);
  run.stages.push_back(train_mrbm(plan, track, pose, run.machine.mrbm));
  return run;
}

}  // namespace mcdbn::reference
