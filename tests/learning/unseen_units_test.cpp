// What was not seen: no part of the lowest machine, and of no loss.

#include <doctest/doctest.h>

#include "base/capture_bound.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/history_noise.hpp"
#include "learning/small_network.hpp"
#include "learning/squared_loss.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/fine_tuning.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"

namespace unseen_units_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Shows one number in some of the frames, hides it in the others, and one frame as a whole.
MatrixF some_seen(Eigen::Index frames, Eigen::Index dimension) {
  MatrixF seen = MatrixF::Ones(frames, dimension);
  for (Eigen::Index t = 0; t < frames; ++t)
    for (Eigen::Index i = 0; i < dimension; ++i)
      if ((5 * t + 3 * i) % 7 < 2 || t == 6) seen(t, i) = 0;
  return seen;
}

struct Case {
  CrbmShape shape;
  std::size_t batch, gibbs_steps;
};

/// The frames of a mini-batch, some units of each unseen.
struct Problem {
  explicit Problem(const Case& test)
      : test(test), start(random_layer(test.shape, 3)), key{.seed = 5, .step = 2, .stream = 4} {
    const auto order = static_cast<Eigen::Index>(test.shape.order),
               count = static_cast<Eigen::Index>(test.batch);
    frames = random_matrix(test.shape.order + test.batch + 3, test.shape.visible, 6, 1.5F);
    if (test.shape.kind == VisibleKind::binary)
      frames = ((frames.array() / 1.5F + 1.0F) / 2.0F).matrix();
    seen = some_seen(frames.rows(), frames.cols());
    frames = frames.cwiseProduct(seen);
    for (Eigen::Index r = 0; r < count; ++r)
      rows.push_back(static_cast<std::int32_t>(order + (3 * r + 1) % (count + 3)));
  }

  /// The columns of frame t that were seen.
  std::vector<Eigen::Index> seen_at(Eigen::Index t) const {
    std::vector<Eigen::Index> units;
    for (Eigen::Index i = 0; i < seen.cols(); ++i)
      if (seen(t, i) != 0) units.push_back(i);
    return units;
  }

  /// Row r of the batch alone, in a machine that has just the units that this row and the frames of
  /// its history saw. Its gradient is put where those units stand in the whole machine's.
  void add_row(std::size_t r, reference::Crbm& gradient, double& loss) const {
    const reference::Crbm whole = in_double(start);
    const Eigen::Index t = rows[r], d = frames.cols();
    const auto lags = static_cast<Eigen::Index>(test.shape.order),
               lags_A = static_cast<Eigen::Index>(test.shape.order_A()),
               lags_B = static_cast<Eigen::Index>(test.shape.order_B());
    const auto units = seen_at(t);
    // Numbers of the history that were seen, as columns of the longest history.
    std::vector<Eigen::Index> past_A, past_B, past;
    std::vector<double> values;
    for (Eigen::Index q = 0; q < lags; ++q)
      for (const Eigen::Index i : seen_at(t - lags + q)) {
        past.push_back(q * d + i);
        values.push_back(frames(t - lags + q, i));
      }
    for (const Eigen::Index at : past) {
      if (at >= (lags - lags_A) * d) past_A.push_back(at - (lags - lags_A) * d);
      if (at >= (lags - lags_B) * d) past_B.push_back(at - (lags - lags_B) * d);
    }
    reference::Crbm part = whole;
    part.weights = whole.weights(units, Eigen::all);
    part.visible_history = whole.visible_history(past_A, units);
    part.hidden_history = whole.hidden_history(past_B, Eigen::all);
    part.visible_bias = whole.visible_bias(units);
    reference::CrbmBatch batch;
    const RowVectorD frame = frames.row(t).cast<double>();
    batch.visible = frame(units);
    batch.history = RowVectorD::Map(values.data(), static_cast<Eigen::Index>(values.size()));
    const auto draws = [&](int gibbs_step) {
      RandomKey own = key;
      own.phase = static_cast<std::uint16_t>(gibbs_step);
      MatrixD uniform(1, whole.hidden_bias.size());
      for (Eigen::Index j = 0; j < uniform.cols(); ++j)
        uniform(0, j) =
            random_uniform(own, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(j));
      return uniform;
    };
    const reference::CdResult result =
        reference::contrastive_divergence(part, batch, static_cast<int>(test.gibbs_steps), draws);
    REQUIRE(result.closest_draw > 5e-5);
    const double share = 1.0 / static_cast<double>(rows.size());
    const reference::Crbm& g = result.gradient;
    for (std::size_t i = 0; i < units.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      gradient.weights.row(units[i]) += share * g.weights.row(at);
      gradient.visible_bias[units[i]] += share * g.visible_bias[at];
      for (std::size_t q = 0; q < past_A.size(); ++q)
        gradient.visible_history(past_A[q], units[i]) +=
            share * g.visible_history(static_cast<Eigen::Index>(q), at);
    }
    for (std::size_t q = 0; q < past_B.size(); ++q)
      gradient.hidden_history.row(past_B[q]) +=
          share * g.hidden_history.row(static_cast<Eigen::Index>(q));
    gradient.hidden_bias += share * g.hidden_bias;
    loss += (batch.visible - result.reconstruction).squaredNorm() * share / static_cast<double>(d);
  }

  Case test;
  CrbmParameters start;
  RandomKey key;
  MatrixF frames, seen;
  std::vector<std::int32_t> rows;
};

const std::vector<Case> kCases = {{{5, 6, 2, VisibleKind::gaussian}, 7, 2},
                                  {{7, 4, 1, VisibleKind::binary}, 5, 1},
                                  {{11, 19, 4, VisibleKind::gaussian, 4, 2}, 9, 2},
                                  {{17, 5, 3, VisibleKind::gaussian, 0, 3}, 3, 3}};

/// Sums of at most some two hundred products of numbers below 4, each rounded: 2^-24 times that.
constexpr double kTolerance = 5e-5;

void check_near(const char* name, const MatrixF& got, const MatrixD& want) {
  INFO("parameter ", std::string(name));
  CHECK(reference::misfit(got, want, MatrixD::Constant(want.rows(), want.cols(), kTolerance)) ==
        "");
}

}  // namespace

TEST_CASE("small: CD learns what a machine does that has only the units that were seen") {
  for (const Case& test : kCases) {
    const Problem problem(test);
    INFO("visible ", test.shape.visible, ", hidden ", test.shape.hidden);
    reference::Crbm want = in_double(CrbmParameters::zeros(test.shape));
    double loss = 0;
    for (std::size_t r = 0; r < problem.rows.size(); ++r) problem.add_row(r, want, loss);
    on_every_device([&](Device& device) {
      const Matrix frames = Matrix::from_host(device, problem.frames),
                   seen = Matrix::from_host(device, problem.seen);
      const IndexBuffer index(device, problem.rows);
      const auto tile = choose_chain_tile(device, test.shape, test.batch);
      REQUIRE(tile);
      for (const bool fused : {true, false}) {
        CAPTURE(fused);
        Crbm crbm(device, problem.start);
        ContrastiveDivergence cd(crbm, test.batch, fused ? tile : std::nullopt, {},
                                 OptimizerKind::none);
        LossAccumulator losses(device, 1, test.batch);
        CdRule rule;
        rule.gibbs_steps = test.gibbs_steps;
        const auto rows = Rows::indexed(frames, index, 0, test.batch);
        cd.step(rows, rule, problem.key, losses, &seen);
        const CrbmParameters got = cd.gradients();  // downhill
        check_near("W", got.W, -want.weights);
        check_near("A", got.A, -want.visible_history);
        check_near("B", got.B, -want.hidden_history);
        check_near("a", got.a, -want.visible_bias);
        check_near("b", got.b, -want.hidden_bias);
        CHECK(std::abs(losses.read_and_reset().at(0) - loss) < 10 * kTolerance);

        // Where everything was seen the bits are those of a step without a mask.
        const Matrix all =
            Matrix::from_host(device, MatrixF::Ones(problem.seen.rows(), problem.seen.cols()));
        cd.step(rows, rule, problem.key, losses, &all);
        const CrbmParameters masked = cd.gradients();
        cd.step(rows, rule, problem.key, losses);
        const CrbmParameters plain = cd.gradients();
        CHECK(masked.W == plain.W);
        CHECK(masked.A == plain.A);
        CHECK(masked.b == plain.b);
        CHECK(plain.W != got.W);
        CHECK_THROWS_AS(cd.step(rows, rule, problem.key, losses, &crbm.W), ShapeError);
      }
    });
  }
}

TEST_CASE("small: the squared loss is the mean over what was seen of the frames that are judged") {
  for (const auto& [windows, dimension] :
       {std::pair{SequenceWindows{.count = 3, .frames = 7, .first = 1, .judged_from = 2}, 5},
        std::pair{SequenceWindows{.count = 1, .frames = 9, .first = 3, .judged_from = 4}, 17},
        std::pair{SequenceWindows{.count = 5, .frames = 3, .first = 0, .judged_from = 0}, 1}}) {
    CAPTURE_BOUND(dimension);
    const auto columns = static_cast<std::size_t>(dimension);
    const MatrixF prediction = random_matrix(windows.rows(), columns, 1),
                  target = random_matrix(windows.rows(), columns, 2);
    const MatrixF seen = some_seen(prediction.rows(), prediction.cols());
    MatrixD counts = seen.cast<double>();
    for (std::size_t row = 0; row < windows.rows(); ++row)
      if (row % windows.frames < windows.judged_from)
        counts.row(static_cast<Eigen::Index>(row)).setZero();
    const MatrixD difference =
        counts.cwiseProduct(prediction.cast<double>() - target.cast<double>());
    const double weight = 1.75, loss = weight * difference.squaredNorm() / counts.sum();
    const MatrixD gradient = 2.0 * weight / counts.sum() * difference;
    on_every_device([&, &windows = windows](Device& device) {
      const Matrix shown = Matrix::from_host(device, seen);
      SquaredLoss masked(device, windows, weight, &shown);
      Matrix error(device, windows.rows(), columns);
      for (int round = 0; round < 2; ++round)  // the second shows that nothing is left behind
        masked.differentiate(Matrix::from_host(device, prediction),
                             Matrix::from_host(device, target), error);
      // Three roundings of numbers below 1; the loss adds up a few dozen of them.
      CHECK((error.to_host().cast<double>() - gradient).cwiseAbs().maxCoeff() < 1e-6);
      CHECK((error.to_host().array() == 0 || counts.array() != 0).all());
      CHECK(weight * masked.read_and_reset() == doctest::Approx(loss).epsilon(1e-5));
      const Matrix nothing(device, windows.rows(), columns);
      SquaredLoss blind(device, windows, weight, &nothing);
      blind.differentiate(Matrix::from_host(device, prediction), Matrix::from_host(device, target),
                          error);
      CHECK(error.to_host().isZero(0));
      CHECK(blind.read_and_reset() == 0.0);
    });
  }
}

namespace {

/// Keeps what another rule would have seen.
struct Recorded : LearningRule {
  std::size_t loss_count() const override { return 1; }
  void learn(std::span<const Rows> visible, const LearningStep& step, LossAccumulator&) override {
    frames = visible.front().matrix->to_host();
    seen = step.seen ? step.seen->to_host() : MatrixF();
  }
  void visit_state(TrainingState&) override {}
  MatrixF frames, seen;
};

}  // namespace

TEST_CASE("small: histories get no noise where nothing was seen") {
  constexpr std::size_t kOrder = 3, kBatch = 4;
  const MatrixF seen = some_seen(12, 5);
  const MatrixF frames = random_matrix(12, 5, 3).cwiseProduct(seen);
  const std::vector<std::int32_t> rows{4, 11, 7, 3};
  on_every_device([&](Device& device) {
    Recorded rule;
    HistoryNoise noise(device, rule, {5, 6, kOrder, VisibleKind::gaussian}, kBatch, 0.5);
    const Matrix values = Matrix::from_host(device, frames), mask = Matrix::from_host(device, seen);
    const IndexBuffer index(device, rows);
    const Rows batch = Rows::indexed(values, index, 0, kBatch);
    LossAccumulator losses(device, 1, kBatch);
    LearningStep step;
    step.seen = &mask;
    noise.learn({&batch, 1}, step, losses);
    REQUIRE(rule.seen.rows() == rule.frames.rows());
    for (std::size_t r = 0; r < kBatch; ++r)
      for (std::size_t q = 0; q <= kOrder; ++q) {
        const auto at = static_cast<Eigen::Index>(r * (kOrder + 1) + q);
        const Eigen::Index t = rows[r] - static_cast<std::int32_t>(kOrder - q);
        CHECK(rule.seen.row(at) == seen.row(t));
        CHECK((rule.frames.row(at).array() == 0 || seen.row(t).array() != 0).all());
        CHECK((rule.frames.row(at) == frames.row(t)) == (q == kOrder || seen.row(t).isZero(0)));
      }
  });
}

namespace {

constexpr Eigen::Index kHidden = 2;  ///< the unit of the first modality that was never seen

/// Two modalities of which the first may have a unit that was never seen.
std::vector<ModalityMatrices> two_modalities_of(bool hides) {
  std::vector<ModalityMatrices> modalities{{"track", {}}, {"pose", {}}};
  for (unsigned clip = 0; clip < 2; ++clip) {
    MatrixF track = random_matrix(40, 4, 10 + clip), seen = MatrixF::Ones(40, 4);
    seen.col(kHidden).setZero();
    track.col(kHidden).setZero();
    modalities[0].clips.push_back(track);
    if (hides) modalities[0].seen.push_back(seen);
    modalities[1].clips.push_back(random_matrix(40, 3, 20 + clip));
  }
  return modalities;
}

LearningSettings few_epochs() {
  LearningSettings settings;
  settings.hidden = 6;
  settings.mrbm_hidden = 5;
  settings.order = 2;
  settings.layers = 1;
  settings.batch = 8;
  settings.least_batches = 2;
  settings.gaussian.epochs = 2;
  settings.gaussian.weight_decay = 0;
  settings.mrbm.epochs = 1;
  settings.fine_tuning.steps = 6;
  settings.fine_tuning.windows = 4;
  settings.fine_tuning.window_frames = 6;
  settings.fine_tuning.settle_frames = 2;
  settings.fine_tuning.reverse = 1.0;
  settings.fine_tuning.weight_decay = 0;
  return settings;
}

}  // namespace

TEST_CASE("a unit that was never seen is not learnt greedily") {
  const LearningSettings settings = few_epochs();
  on_every_device([&](Device& device) {
    for (const bool hides : {true, false}) {
      CAPTURE(hides);
      const MatrixSource source(two_modalities_of(hides));
      LearningSettings none = settings;
      none.gaussian.rate = none.gaussian.rate_A = none.gaussian.rate_B = 1e-30;
      const auto lowest = [](const Mcdbn& network) { return network.cdbns[0].layers[0].to_host(); };
      const CrbmParameters start = lowest(train_greedy(device, source, none));
      const Mcdbn greedy = train_greedy(device, source, settings);
      const CrbmParameters learnt = lowest(greedy);
      CHECK((learnt.W.row(kHidden) == start.W.row(kHidden)) == hides);
      CHECK((learnt.A.col(kHidden) == start.A.col(kHidden)) == hides);
      CHECK((learnt.a(kHidden) == start.a(kHidden)) == hides);
      CHECK(learnt.W.row(0) != start.W.row(0));
    }
  });
}

TEST_CASE("fine-tuning's other directions learn nothing where nothing was seen") {
  const SequenceLossMaker squares = [](Device& device, const SequenceWindows& windows) {
    return std::make_unique<SquaredLoss>(device, windows, 1.0);
  };
  on_every_device([&](Device& device) {
    for (const bool hides : {true, false}) {
      CAPTURE(hides);
      auto modalities = two_modalities_of(true);
      for (MatrixF& clip : modalities[0].clips) clip.setZero();
      for (MatrixF& seen : modalities[0].seen) seen.setZero();
      if (!hides) modalities[0].seen.clear();
      const MatrixSource source(std::move(modalities));
      LearningSettings settings = few_epochs();
      const Mcdbn greedy = train_greedy(device, source, settings);
      const auto tuned = [&](double reverse) {
        settings.fine_tuning.reverse = reverse;
        return fine_tune(device, greedy, source, nullptr, settings, squares).network.mrbm.to_host();
      };
      const MrbmParameters both = tuned(1.0), one = tuned(0.0);
      CHECK((both.W[0] == one.W[0]) == hides);
      CHECK((both.W[1] == one.W[1]) == hides);
      CHECK((both.b == one.b) == hides);
    }
  });
}

TEST_CASE("what was seen has the clips' shape, and clips are zero elsewhere") {
  const auto check = [](const std::vector<ModalityMatrices>& modalities) {
    MatrixSource(modalities).sequences().check();
  };
  auto modalities = two_modalities_of(true);
  CHECK_NOTHROW(check(modalities));
  modalities[0].clips[1](5, kHidden) = 0.5F;
  CHECK_THROWS_AS(check(modalities), ShapeError);
  modalities = two_modalities_of(true);
  modalities[0].seen.pop_back();
  CHECK_THROWS_AS(check(modalities), ShapeError);
  modalities = two_modalities_of(true);
  modalities[0].seen[0] = MatrixF::Ones(40, 3);
  CHECK_THROWS_AS(check(modalities), ShapeError);
}

}  // namespace unseen_units_test
