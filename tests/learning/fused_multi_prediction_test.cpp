#include "learning/multi_prediction.hpp"

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "learning/contrastive_divergence.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/error_bounds.hpp"
#include "reference/mrbm_reference.hpp"
#include "reference/update_reference.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using reference::gamma_n;
using reference::kDivisionError;
using reference::kLogError;
using reference::kRoundoff;
using reference::kSigmoidError;
using reference::kSqrtError;
using reference::misfit;

namespace {

struct Case {
  std::size_t track, pose, hidden, batch, steps;
};

// The second one's stacks are added up in several pieces.
const std::vector<Case> kCases = {{33, 17, 21, 11, 10}, {9, 5, 7, 229, 9}};
const Case kOddCase{17, 33, 19, 29, 3};

MatrixD magnitude(const MatrixD& x) {
  return x.cwiseAbs();
}

struct Problem {
  explicit Problem(const Case& test) : test(test) {
    const std::array<std::size_t, 2> visible{test.track, test.pose};
    for (std::size_t m = 0; m < 2; ++m) {
      const auto seed = static_cast<unsigned>(10 * m);
      frames[m] = (0.5F * (random_matrix(50, visible[m], seed + 1).array() + 1.0F)).matrix();
      start.W[m] = random_matrix(visible[m], test.hidden, seed + 2,
                                 4.0F / (4.0F + static_cast<float>(test.hidden)));
      start.a[m] = random_matrix(1, visible[m], seed + 3, 0.5F);
    }
    start.b = random_matrix(1, test.hidden, 30, 0.5F);
    for (std::size_t i = 0; i < test.batch; ++i)
      index.push_back(static_cast<std::int32_t>((7 * i + 3) % 45));
  }

  /// The track's codes are read `kShift` frames later, as a look-ahead does.
  MatrixD batch(std::size_t modality) const {
    MatrixD codes(test.batch, frames[modality].cols());
    for (Eigen::Index r = 0; r < codes.rows(); ++r)
      codes.row(r) = frames[modality]
                         .row(index[static_cast<std::size_t>(r)] + (modality == 0 ? kShift : 0))
                         .cast<double>();
    return codes;
  }

  reference::Mrbm model() const {
    return {{start.W[0].cast<double>(), start.W[1].cast<double>()},
            {start.a[0].cast<double>(), start.a[1].cast<double>()},
            start.b.cast<double>()};
  }

  static constexpr int kShift = 4;
  Case test;
  std::array<MatrixF, 2> frames;
  MrbmParameters start;
  std::vector<std::int32_t> index;
};

/// |error| of σ(x) where x carries an error of `input`: σ' ≤ ¼, then the sigmoid's own.
MatrixD sigmoid_bound(const MatrixD& input) {
  return (0.25 * input).array() + kSigmoidError * kRoundoff;
}

/// |error| of x · y(1 − y), y(1 − y) ≤ ¼ being off by the error of y and three roundings.
MatrixD through_sigmoid_bound(const MatrixD& x, const MatrixD& x_error, const MatrixD& y_error) {
  return 0.25 * x_error + (magnitude(x) + x_error).cwiseProduct(y_error) +
         gamma_n(3) * 0.25 * magnitude(x);
}

/// Forward error analysis of one direction, added up over the mini-batch: every product's terms
/// carry what their factors had, plus γ_k of their magnitudes (Higham 3.5).
void add_direction_bound(const reference::Mrbm& model, int present, const MatrixD& codes,
                         const MatrixD& target, int steps, reference::Mrbm& sum, double& loss) {
  const int absent = 1 - present;
  const MatrixD W = magnitude(model.weights[absent]);
  const auto trace = reference::mean_field(model, present, codes, {steps, false});
  const double k_present = static_cast<double>(codes.cols()),
               k_absent = static_cast<double>(W.rows());
  const double k_hidden = static_cast<double>(W.cols());
  const MatrixD drive = (codes * magnitude(model.weights[present])).rowwise() +
                        RowVectorD(model.hidden_bias.cwiseAbs());
  std::vector<MatrixD> hidden_error, value_error{MatrixD::Zero(target.rows(), target.cols())};
  MatrixD logit_error;
  for (int t = 0; t < steps; ++t) {
    const MatrixD& value = trace.missing[static_cast<std::size_t>(t)];
    hidden_error.push_back(sigmoid_bound(gamma_n(k_present + k_absent + 4) * (drive + value * W) +
                                         value_error.back() * W));
    const MatrixD& hidden = trace.hidden[static_cast<std::size_t>(t)];
    const MatrixD terms =
        (hidden * W.transpose()).rowwise() +
        RowVectorD(model.visible_bias[static_cast<std::size_t>(absent)].cwiseAbs());
    logit_error = gamma_n(k_hidden + 4) * terms + hidden_error.back() * W.transpose();
    value_error.push_back(sigmoid_bound(logit_error));
  }
  // d(cross-entropy)/dp = (p − t) / (p(1 − p)); each log is off by its own error too.
  const MatrixD p = trace.missing.back();
  const MatrixD slope =
      (p - target).cwiseQuotient(p.cwiseProduct(MatrixD((1.0 - p.array()).matrix())));
  const MatrixD logs = -(p.array().log() + (1.0 - p.array()).log());
  loss += 2.0 * magnitude(slope).cwiseProduct(value_error.back()).sum() +
          gamma_n(kLogError + k_absent + static_cast<double>(p.rows()) + 8) * logs.sum() +
          2.0 * kRoundoff * (1.0 / p.array() + 1.0 / (1.0 - p.array())).sum();

  MatrixD delta = p - target,
          delta_error = value_error.back() + gamma_n(2) * MatrixD::Ones(p.rows(), p.cols());
  MatrixD drive_delta = MatrixD::Zero(p.rows(), W.cols()), drive_error = drive_delta;
  const double rows = static_cast<double>(p.rows()) * steps * 2.0 + 8.0;
  for (int t = steps - 1; t >= 0; --t) {
    const auto at = static_cast<std::size_t>(t);
    const MatrixD &hidden = trace.hidden[at], &before = trace.missing[at];
    const MatrixD up = delta * model.weights[static_cast<std::size_t>(absent)];
    const MatrixD up_error = gamma_n(k_absent + 2) * magnitude(delta) * W + delta_error * W;
    const MatrixD hidden_delta = up.array() * hidden.array() * (1.0 - hidden.array());
    const MatrixD hidden_delta_error = through_sigmoid_bound(up, up_error, hidden_error[at]);
    auto& weights = sum.weights[static_cast<std::size_t>(absent)];
    weights += gamma_n(rows) * (magnitude(delta).transpose() * hidden +
                                before.transpose() * magnitude(hidden_delta)) +
               delta_error.transpose() * hidden + magnitude(delta).transpose() * hidden_error[at] +
               value_error[at].transpose() * magnitude(hidden_delta) +
               before.transpose() * hidden_delta_error;
    sum.visible_bias[static_cast<std::size_t>(absent)] +=
        (delta_error + gamma_n(rows) * magnitude(delta)).colwise().sum();
    drive_delta += magnitude(hidden_delta);
    drive_error += hidden_delta_error;
    const MatrixD down = hidden_delta * model.weights[static_cast<std::size_t>(absent)].transpose();
    const MatrixD down_error = gamma_n(k_hidden + 2) * magnitude(hidden_delta) * W.transpose() +
                               hidden_delta_error * W.transpose();
    delta_error = through_sigmoid_bound(down, down_error, value_error[at]);
    delta = down.array() * before.array() * (1.0 - before.array());
  }
  drive_error += gamma_n(rows) * drive_delta;
  sum.weights[static_cast<std::size_t>(present)] += codes.transpose() * drive_error;
  sum.hidden_bias += drive_error.colwise().sum();
}

/// Adam's first step from zero moments: nothing cancels, so that relative errors add up.
void check_first_adam(const MatrixF& got, const MatrixF& before, const MatrixF& gradient,
                      const UpdateRule& rule) {
  MatrixD want = before.cast<double>();
  MatrixD mean = MatrixD::Zero(want.rows(), want.cols()), square = mean;
  reference::adam_update(want, mean, square, gradient.cast<double>(), rule, 1);
  const double operations = 3 + 4 + 3 * kDivisionError + kSqrtError + 8;
  const MatrixD step = magnitude(want - before.cast<double>()) +
                       2.0 * rule.rate * rule.weight_decay * magnitude(before.cast<double>());
  const MatrixD bound = gamma_n(operations) * step + kRoundoff * magnitude(want);
  CHECK(misfit(got, want, bound) == "");
}

bool same_bits(const MrbmParameters& x, const MrbmParameters& y) {
  return x.W == y.W && x.a == y.a && x.b == y.b;
}

struct Step {
  MrbmParameters gradients, after;
  std::vector<float> losses;
  std::uint64_t launches = 0;
};

Step run_step(Device& device, const Problem& problem, const std::optional<RowTile>& tile,
              const UpdateRule& rule, int count = 1) {
  const Matrix track = Matrix::from_host(device, problem.frames[0]);
  const Matrix pose = Matrix::from_host(device, problem.frames[1]);
  const IndexBuffer index(device, problem.index);
  Mrbm mrbm(device, problem.start);
  const std::size_t batch = problem.test.batch;
  const MultiPredictionSettings settings{.mean_field_steps = problem.test.steps};
  Mrbm still(device, problem.start);
  MultiPrediction gradient(still, batch, settings, tile, OptimizerKind::none);
  MultiPrediction multi_prediction(mrbm, batch, settings, tile);
  LossAccumulator losses(device, 2, batch);
  const Rows track_rows = Rows::indexed(track, index, 0, batch, Problem::kShift);
  const Rows pose_rows = Rows::indexed(pose, index, 0, batch);
  gradient.step(track_rows, pose_rows, rule, losses);
  CHECK(same_bits(still.to_host(), problem.start));
  losses.read_and_reset();
  const auto before = device.launch_count();
  for (int i = 0; i < count; ++i) multi_prediction.step(track_rows, pose_rows, rule, losses);
  Step step{gradient.gradients(), mrbm.to_host(), losses.read_and_reset(),
            device.launch_count() - before};
  for (std::size_t m = 0; m < 2; ++m) {
    CHECK(mrbm.W_transposed[m].to_host() == step.after.W[m].transpose());
    for (const Matrix* matrix : {&mrbm.W[m], &mrbm.W_transposed[m], &mrbm.a[m]})
      CHECK(padding_is_zero(*matrix));
  }
  return step;
}

std::optional<RowTile> tile_for(Device& device, const Case& test) {
  const CrbmShape shape{std::max(test.track, test.pose), test.hidden, 0, VisibleKind::binary};
  return choose_chain_tile(device, shape, test.batch);
}

void check_against_reference(Device& device, const Case& test, const std::optional<RowTile>& tile) {
  const Problem problem(test);
  const reference::Mrbm model = problem.model();
  const std::array<MatrixD, 2> batch{problem.batch(0), problem.batch(1)};
  const int steps = static_cast<int>(test.steps);
  const auto want = reference::multi_prediction(model, batch, {steps, false});
  const double n = static_cast<double>(test.batch);
  reference::Mrbm bound = model.with_parameters(0.0 * model.flattened());
  std::array<double, 2> loss_bound{};
  add_direction_bound(model, 0, batch[0], batch[1], steps, bound, loss_bound[0]);
  add_direction_bound(model, 1, batch[1], batch[0], steps, bound, loss_bound[1]);
  bound = bound.with_parameters((1.0 + gamma_n(4)) / n * bound.flattened());

  UpdateRule rule = UpdateRule::adam();
  rule.weight_decay = 0.01F;
  UpdateRule bias_rule = UpdateRule::adam();
  const Step got = run_step(device, problem, tile, rule);
  for (std::size_t m = 0; m < 2; ++m) {
    CAPTURE(m);
    CHECK(misfit(got.gradients.W[m], want.gradient.weights[m], bound.weights[m]) == "");
    CHECK(misfit(got.gradients.a[m], want.gradient.visible_bias[m], bound.visible_bias[m]) == "");
    check_first_adam(got.after.W[m], problem.start.W[m], got.gradients.W[m], rule);
    check_first_adam(got.after.a[m], problem.start.a[m], got.gradients.a[m], bias_rule);
  }
  CHECK(misfit(got.gradients.b, want.gradient.hidden_bias, bound.hidden_bias) == "");
  check_first_adam(got.after.b, problem.start.b, got.gradients.b, bias_rule);
  const double units_pose = static_cast<double>(test.pose),
               units_track = static_cast<double>(test.track);
  const double loss = static_cast<double>(got.losses[0]) * units_track +
                      static_cast<double>(got.losses[1]) * units_pose;
  CHECK(std::abs(loss - want.loss) <= (loss_bound[0] + loss_bound[1]) / n);
}

}  // namespace

TEST_CASE("multi-prediction's gradients, fused and composed, are the double reference's") {
  on_every_device([](Device& device) {
    for (const Case& test : kCases) {
      CAPTURE(test.track);
      CAPTURE(test.hidden);
      const auto tile = tile_for(device, test);
      REQUIRE(tile);
      check_against_reference(device, test, tile);
      check_against_reference(device, test, std::nullopt);
    }
  });
}

TEST_CASE("every tile of fused multi-prediction gives the same bits, and so does another run") {
  on_every_device([](Device& device) {
    const Problem problem(kOddCase);
    const Step want = run_step(device, problem, tile_for(device, kOddCase), UpdateRule::adam(), 3);
    for (const RowTile& tile : {RowTile{4, 4, 1, 32, 4}, RowTile{1, 3, 1, 64, 16}}) {
      CAPTURE(tile.vector_width);
      CAPTURE(tile.rows);
      check_against_reference(device, kOddCase, tile);
      const Step got = run_step(device, problem, tile, UpdateRule::adam(), 3);
      CHECK(same_bits(got.after, want.after));
      CHECK(got.launches == 3 * 5);  // three mini-batches: two modalities gathered, three kernels
    }
  });
}

TEST_CASE("multi-prediction refuses what it cannot do") {
  on_every_device([](Device& device) {
    const Problem problem(kOddCase);
    const Matrix track = Matrix::from_host(device, problem.frames[0]);
    const Matrix pose = Matrix::from_host(device, problem.frames[1]);
    const IndexBuffer index(device, problem.index);
    Mrbm mrbm(device, problem.start);
    CHECK_THROWS_AS(MultiPrediction(mrbm, 5, {.mean_field_steps = 0}), ConfigError);
    MultiPrediction multi_prediction(mrbm, 5, {.mean_field_steps = 2});
    LossAccumulator losses(device, 2, 8);
    const auto step = [&](const Rows& x, const Rows& y) {
      multi_prediction.step(x, y, UpdateRule::adam(), losses);
    };
    const Rows five = Rows::indexed(track, index, 0, 5), six = Rows::indexed(pose, index, 0, 6);
    CHECK_THROWS_AS(step(five, six), ShapeError);
    CHECK_THROWS_AS(step(Rows::indexed(track, index, 0, 6), six), ShapeError);
    CHECK_THROWS_AS(step(Rows(track, 0, 5), Rows(pose, 0, 5)), ShapeError);
  });
}
