#include "learning/unrolled_pass.hpp"
#include "learning/squared_loss.hpp"

#include <doctest/doctest.h>

#include "base/capture_bound.hpp"
#include "device/every_device.hpp"
#include "device/pointwise.hpp"
#include "features/small_figure.hpp"
#include "learning/small_network.hpp"
#include "mcdbn/machines/regeneration.hpp"
#include "motion_model/pose_loss.hpp"
#include "reference/error_bounds.hpp"
#include "reference/finite_difference.hpp"
#include "reference/unrolled_reference.hpp"

namespace unrolled_pass_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::size_t kTrack = 5, kOrder = 2, kSteps = 3;
constexpr SequenceWindows kWindows{3, 11, 4, 6};
/// About half of what the targets' foot does: random poses are quick.
constexpr double kPlantedBelow_m_s = 2.5;

CrbmParameters layer(std::size_t visible, std::size_t hidden, VisibleKind kind, unsigned seed) {
  CrbmParameters parameters = CrbmParameters::zeros({visible, hidden, kOrder, kind});
  parameters.W = random_matrix(visible, hidden, seed, 0.7F);
  parameters.A = random_matrix(kOrder * visible, visible, seed + 1, 0.15F);
  parameters.B = random_matrix(kOrder * visible, hidden, seed + 2, 0.4F);
  parameters.a = random_matrix(1, visible, seed + 3, 0.5F);
  parameters.b = random_matrix(1, hidden, seed + 4, 0.5F);
  if (kind == VisibleKind::binary)
    parameters.visible_mean = (0.5F + 0.2F * random_matrix(1, visible, seed + 5).array()).matrix();
  return parameters;
}

/// A small network of two layers a modality; hidden sizes all differ.
struct SmallNetwork {
  explicit SmallNetwork(std::size_t pose) {
    parameters[0] = {layer(kTrack, 6, VisibleKind::gaussian, 10),
                     layer(6, 7, VisibleKind::binary, 20)};
    parameters[1] = {layer(pose, 5, VisibleKind::gaussian, 30),
                     layer(5, 4, VisibleKind::binary, 40)};
    mrbm = mrbm_of({random_matrix(7, 3, 50, 0.8F), random_matrix(4, 3, 51, 0.8F)},
                   {random_matrix(1, 7, 52, 0.5F), random_matrix(1, 4, 53, 0.5F)},
                   random_matrix(1, 3, 54, 0.5F));
  }

  Mcdbn on(Device& device) const { return on_device(device, {parameters, mrbm}, 0, kSteps); }

  reference::UnrolledModel in_double() const { return test::in_double({parameters, mrbm}); }

  std::array<std::vector<CrbmParameters>, 2> parameters;
  MrbmParameters mrbm;
};

/// By how much the foot's steps through the camera's axes differ where the target's foot is
/// planted, 0 where it is not. @return [judged frames − 1 x 3], metres
MatrixD planted_steps(const SmallFigure& figure, double planted_below_m_s,
                      const MatrixD& prediction, const MatrixD& target) {
  const auto steps = static_cast<Eigen::Index>(kWindows.frames - kWindows.judged_from) - 1;
  const double fps = figure.modalities().fps;
  const auto taken = [&](const MatrixD& pose) {
    const MatrixD foot = figure.foot_m(pose).bottomRows(steps + 1);
    return MatrixD(foot.bottomRows(steps) - foot.topRows(steps) +
                   figure.root_velocity_m_s(pose).bottomRows(steps) / fps);
  };
  const MatrixD true_steps = taken(target);
  MatrixD difference = taken(prediction) - true_steps;
  for (Eigen::Index t = 0; t < steps; ++t)
    if (true_steps.row(t).norm() * fps > planted_below_m_s) difference.row(t).setZero();
  return difference;
}

/// What the loss is on the host, in double: features, and for 3D positions and steps by the motion
/// layer's own decoding and forward kinematics.
double loss_in_double(const SmallFigure& figure, const PoseLossWeights& weights, int absent,
                      const MatrixD& prediction, const MatrixD& target) {
  const auto judged = static_cast<Eigen::Index>(kWindows.frames - kWindows.judged_from);
  const MatrixD difference = (prediction - target).bottomRows(judged);
  double loss = weights.features * difference.array().square().mean();
  if (absent == 0) return loss;
  const MatrixD positions =
      (figure.positions_m(prediction) - figure.positions_m(target)).bottomRows(judged);
  const MatrixD steps = positions.bottomRows(judged - 1) - positions.topRows(judged - 1);
  loss += weights.positions * positions.array().square().mean() /
          (PoseLoss::kPosition_m * PoseLoss::kPosition_m);
  const MatrixD planted = planted_steps(figure, weights.planted_below_m_s, prediction, target);
  return loss + (weights.velocities * steps.array().square().mean() +
                 weights.contacts * planted.array().square().mean()) /
                    (PoseLoss::kStep_m * PoseLoss::kStep_m);
}

/// Gradients by the centered parameters from those by the ordinary ones, whose biases b = b' − ½ΣW
/// … hang on the weights.
void move_to_center(reference::Crbm& gradient) {
  const double visible = gradient.visible_units == reference::VisibleUnits::binary ? 0.5 : 0.0;
  gradient.weights.rowwise() -= visible * gradient.hidden_bias;
  gradient.weights.colwise() -= 0.5 * gradient.visible_bias.transpose();
  gradient.hidden_history.rowwise() -= visible * gradient.hidden_bias;
  gradient.visible_history.rowwise() -= visible * gradient.visible_bias;
}

void move_to_center(reference::Mrbm& gradient) {
  for (std::size_t m = 0; m < 2; ++m) {
    gradient.weights[m].rowwise() -= 0.5 * gradient.hidden_bias;
    gradient.weights[m].colwise() -= 0.5 * gradient.visible_bias[m].transpose();
  }
}

/// Rounding of a gradient that went through `frames` frames of two layers, the mean field and sums
/// over all rows: every number on the way is a sum of at most so many terms.
double rounding_steps() {
  const double widths = 2.0 * (kOrder * 30.0 + 10.0);
  return widths * static_cast<double>(kWindows.frames + 2 * kSteps) +
         static_cast<double>(kWindows.rows());
}

void check_near(const Matrix& got, const MatrixD& want, const char* what) {
  INFO(what);
  MatrixD values = got.to_host().cast<double>();
  if (values.rows() != want.rows()) {
    // Histories on the device have their padding between the frames.
    const auto lags = static_cast<Eigen::Index>(kOrder);
    const Eigen::Index frame = want.rows() / lags, padded_frame = values.rows() / lags;
    MatrixD packed(want.rows(), want.cols());
    for (Eigen::Index q = 0; q < lags; ++q)
      packed.middleRows(q * frame, frame) = values.middleRows(q * padded_frame, frame);
    values = packed;
  }
  const double scale = std::max(want.cwiseAbs().maxCoeff(), 1e-3);
  const double error = (values - want).cwiseAbs().maxCoeff();
  CHECK(error <= rounding_steps() * 0x1p-24 * scale);
}

struct Windows {
  MatrixF track = random_matrix(40, kTrack, 61, 1.2F);
  MatrixF pose;
  std::vector<std::int32_t> rows;
  explicit Windows(std::size_t pose_dimension) : pose(random_matrix(40, pose_dimension, 62, 0.8F)) {
    for (const int start : {0, 9, 26})
      for (int frame = 0; frame < static_cast<int>(kWindows.frames); ++frame)
        rows.push_back(start + frame);
  }
  MatrixD window(const MatrixF& frames, std::size_t i) const {
    return frames.middleRows(rows[i * kWindows.frames], kWindows.frames).cast<double>();
  }
};

struct Variant {
  std::size_t present;
  float kept_share;
  bool fused;  ///< the down-pass in one launch a layer
};
constexpr Variant kVariants[] = {{modality::track, 1.0F, true},   {modality::pose, 1.0F, true},
                                 {modality::track, 0.75F, true},  {modality::pose, 0.75F, true},
                                 {modality::track, 1.0F, false},  {modality::pose, 1.0F, false},
                                 {modality::track, 0.75F, false}, {modality::pose, 0.75F, false}};
constexpr RandomKey kKey{77, 3, 9, 0};

/// What the pass draws for window `i`, from the host's own Philox: layers in the order of the pass,
/// one phase each.
reference::DropOut drawn_for(const SmallNetwork& small, std::size_t present, std::size_t i,
                             float kept_share) {
  if (kept_share == 1.0F) return {};
  RandomKey key = kKey;
  const auto draw = [&](std::size_t units) {
    ++key.phase;
    RowVectorD factors(static_cast<Eigen::Index>(units));
    for (Eigen::Index c = 0; c < factors.size(); ++c) {
      const float u =
          random_uniform(key, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(c));
      factors[c] = u < kept_share ? 1.0 / double{kept_share} : 0.0;
    }
    return factors;
  };
  const auto& up = small.parameters[present];
  const auto& down = small.parameters[other(present)];
  reference::DropOut factors;
  for (const CrbmParameters& layer : up) factors.up.push_back(draw(layer.shape.hidden));
  factors.shared = draw(static_cast<std::size_t>(small.mrbm.b.cols()));
  factors.down.resize(down.size());
  for (std::size_t k = down.size(); k-- > 0;) {
    factors.down[k] = draw(down[k].shape.visible);
    if (down[k].shape.kind == VisibleKind::gaussian) factors.down[k].resize(0);
  }
  return factors;
}

}  // namespace

TEST_CASE("centered parameters come back as they were") {
  const CrbmParameters own = layer(6, 7, VisibleKind::binary, 3);
  const CrbmParameters back = uncentered(centered(own, InputKind::code), InputKind::code);
  CHECK((back.a - own.a).cwiseAbs().maxCoeff() < 1e-5F);
  CHECK((back.b - own.b).cwiseAbs().maxCoeff() < 1e-5F);
  CHECK((back.visible_mean - own.visible_mean).cwiseAbs().maxCoeff() < 1e-6F);
}

TEST_CASE("the unrolled pass predicts what the reference does, frame by frame") {
  const SmallFigure figure;
  const SmallNetwork small(figure.dimension());
  const Windows windows(figure.dimension());
  const reference::UnrolledModel model = small.in_double();
  on_every_device([&](Device& device) {
    UnrolledNetwork network(device, small.on(device), kSteps);
    const IndexBuffer index(device, windows.rows);
    for (const auto& [present, kept, fused] : kVariants) {
      CAPTURE_BOUND(fused);
      const MatrixF& frames = present == modality::track ? windows.track : windows.pose;
      const Matrix values = Matrix::from_host(device, frames);
      UnrolledPass pass(network, other(present), kWindows, fused);
      const Rows rows = Rows::indexed(values, index, 0, kWindows.rows());
      pass.forward(std::vector<Rows>{rows, rows}, kept, kKey);
      const MatrixD got = pass.prediction().to_host().cast<double>();
      for (std::size_t i = 0; i < kWindows.count; ++i) {
        const MatrixD want = reference::joint_prediction(
            model, static_cast<int>(present), windows.window(frames, i),
            static_cast<int>(kWindows.first), kSteps, drawn_for(small, present, i, kept));
        const MatrixD part = got.middleRows(static_cast<Eigen::Index>(i * kWindows.frames),
                                            static_cast<Eigen::Index>(kWindows.frames));
        CHECK((part - want).cwiseAbs().maxCoeff() <=
              rounding_steps() * 0x1p-24 * want.cwiseAbs().maxCoeff());
      }
    }
  });
}

TEST_CASE(
    "small: the derivative of the loss on poses is the finite differences', of every feature") {
  const SmallFigure figure;
  const Windows windows(figure.dimension());
  const PoseLossWeights weights{1.0, 0.02, 0.004, 0.004};
  const MatrixF predicted = random_matrix(kWindows.rows(), figure.dimension(), 63, 0.8F);
  const auto frames = static_cast<Eigen::Index>(kWindows.frames);
  MatrixD want(predicted.rows(), predicted.cols());
  MatrixF target(predicted.rows(), predicted.cols());
  for (std::size_t i = 0; i < kWindows.count; ++i) {
    const auto first = static_cast<Eigen::Index>(i) * frames;
    target.middleRows(first, frames) = windows.window(windows.pose, i).cast<float>();
    const MatrixD here = predicted.middleRows(first, frames).cast<double>();
    const auto loss = [&](const Eigen::VectorXd& flat) {
      return loss_in_double(figure, weights, 1,
                            Eigen::Map<const MatrixD>(flat.data(), here.rows(), here.cols()),
                            windows.window(windows.pose, i)) /
             static_cast<double>(kWindows.count);
    };
    const Eigen::VectorXd slope = reference::finite_difference(
        loss, Eigen::Map<const Eigen::VectorXd>(here.data(), here.size()));
    want.middleRows(first, frames) =
        Eigen::Map<const MatrixD>(slope.data(), here.rows(), here.cols());
  }
  on_every_device([&](Device& device) {
    PoseLoss loss(device, figure.modalities(), kWindows, weights);
    Matrix error = Matrix::from_host(device, predicted);
    loss.differentiate(Matrix::from_host(device, predicted), Matrix::from_host(device, target),
                       error);
    check_near(error, want, "error");
  });
}

TEST_CASE("gradients of fine-tuning are the finite differences of its loss") {
  const SmallFigure figure;
  const SmallNetwork small(figure.dimension());
  const Windows windows(figure.dimension());
  const reference::UnrolledModel model = small.in_double();
  // Weights that let every part of the loss matter about as much.
  const PoseLossWeights weights{1.0, 0.02, 0.004, 0.004};
  const MatrixD none = MatrixD::Zero(static_cast<Eigen::Index>(kWindows.frames),
                                     static_cast<Eigen::Index>(figure.dimension()));
  const auto planted =
      (planted_steps(figure, kPlantedBelow_m_s, none, windows.window(windows.pose, 0))
           .rowwise()
           .squaredNorm()
           .array() > 0)
          .count();
  REQUIRE((planted > 0 && planted + 1 < static_cast<int>(kWindows.frames - kWindows.judged_from)));
  for (const auto& [present, kept, fused] : kVariants) {
    CAPTURE_BOUND(kept);
    CAPTURE_BOUND(fused);
    const auto p = static_cast<int>(present);
    CAPTURE(p);
    const MatrixF& inputs = present == modality::track ? windows.track : windows.pose;
    const MatrixF& targets = present == modality::track ? windows.pose : windows.track;
    const auto loss = [&, modality = present, share = kept](const Eigen::VectorXd& flat) {
      const reference::UnrolledModel moved = model.with_parameters(flat);
      double sum = 0;
      for (std::size_t i = 0; i < kWindows.count; ++i)
        sum += loss_in_double(figure, weights, 1 - p,
                              reference::joint_prediction(moved, p, windows.window(inputs, i),
                                                          static_cast<int>(kWindows.first), kSteps,
                                                          drawn_for(small, modality, i, share)),
                              windows.window(targets, i));
      return sum / static_cast<double>(kWindows.count);
    };
    reference::UnrolledModel want =
        model.with_parameters(reference::finite_difference(loss, model.flattened()));
    for (auto& stack : want.stacks)
      for (reference::Crbm& own : stack) move_to_center(own);
    move_to_center(want.mrbm);

    on_every_device([&, &present = present, &kept = kept, &fused = fused](Device& device) {
      UnrolledNetwork network(device, small.on(device), kSteps);
      const IndexBuffer index(device, windows.rows);
      const Matrix input = Matrix::from_host(device, inputs),
                   all = Matrix::from_host(device, targets);
      Matrix target(device, kWindows.rows(), all.columns());
      gather(Rows::indexed(all, index, 0, kWindows.rows()), target);
      UnrolledPass pass(network, other(present), kWindows, fused);
      PoseLoss pose_loss(device, figure.modalities(), kWindows, weights);
      SquaredLoss track_loss(device, kWindows, weights.features);
      for (int round = 0; round < 2; ++round) {  // the second shows that nothing is left behind
        network.clear_gradients();
        const Rows rows = Rows::indexed(input, index, 0, kWindows.rows());
        pass.forward(std::vector<Rows>{rows, rows}, kept, kKey);
        if (present == modality::track)
          pose_loss.differentiate(pass.prediction(), target, pass.prediction_error());
        else
          track_loss.differentiate(pass.prediction(), target, pass.prediction_error());
        pass.backward();
      }
      for (std::size_t m = 0; m < network.modality_count(); ++m) {
        for (std::size_t i = 0; i < network.layers(m).size(); ++i) {
          CAPTURE(m);
          CAPTURE(i);
          UnrolledNetwork::Layer& got = network.layers(m)[i];
          check_near(got.gradient.W, want.stacks[m][i].weights, "W");
          check_near(got.gradient.A, want.stacks[m][i].visible_history, "A");
          check_near(got.gradient.B, want.stacks[m][i].hidden_history, "B");
          check_near(got.gradient.a, want.stacks[m][i].visible_bias, "a");
          check_near(got.gradient.b, want.stacks[m][i].hidden_bias, "b");
        }
        check_near(network.mrbm_gradient().W[m], want.mrbm.weights[m], "MRBM W");
        check_near(network.mrbm_gradient().a[m], want.mrbm.visible_bias[m], "MRBM a");
      }
      check_near(network.mrbm_gradient().b, want.mrbm.hidden_bias, "MRBM b");
      const double reported = present == modality::track
                                  ? pose_loss.read_and_reset()
                                  : weights.features * track_loss.read_and_reset();
      CHECK(reported == doctest::Approx(loss(model.flattened())).epsilon(1e-5));
    });
  }
}

}  // namespace unrolled_pass_test
