// Layer health against a double-precision computation of the same, and which windows it is of.

#include <doctest/doctest.h>

#include "device/every_device.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "mcdbn/learning/layer_health.hpp"

namespace layer_health_reference_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

CrbmParameters random_crbm(const CrbmShape& shape) {
  CrbmParameters p = CrbmParameters::zeros(shape);
  p.W = random_matrix(shape.visible, shape.hidden, 1, 0.8F);
  p.A = random_matrix(shape.order_A() * shape.visible, shape.visible, 2, 0.3F);
  p.B = random_matrix(shape.order_B() * shape.visible, shape.hidden, 3, 0.9F);
  p.a = random_matrix(1, shape.visible, 4, 0.5F);
  p.b = random_matrix(1, shape.hidden, 5, 7.0F);
  return p;
}

/// The last frames of `frames`, side by side, the oldest first. @return [1 x order·visible]
MatrixD history_of(const std::vector<RowVectorD>& frames, std::size_t order) {
  const Eigen::Index visible = frames.front().cols();
  MatrixD history(1, static_cast<Eigen::Index>(order) * visible);
  for (std::size_t q = 0; q < order; ++q)
    history.middleCols(static_cast<Eigen::Index>(q) * visible, visible) =
        frames[frames.size() - order + q];
  return history;
}

/// Three mean-field steps a frame, from the frame before (from zeros where there is no history).
double free_run_error(const reference::Crbm& model, std::size_t order,
                      const std::vector<MatrixD>& windows) {
  double sum = 0;
  for (const MatrixD& window : windows) {
    std::vector<RowVectorD> frames;
    for (std::size_t t = 0; t < order; ++t)
      frames.emplace_back(window.row(static_cast<Eigen::Index>(t)));
    for (std::size_t t = order; t < order + kFreeRunFrames; ++t) {
      const MatrixD history = order > 0 ? history_of(frames, order) : MatrixD(1, 0);
      MatrixD visible = order > 0 ? MatrixD(frames.back()) : MatrixD::Zero(1, window.cols());
      for (int step = 0; step < 3; ++step)
        visible = reference::visible_mean(
            model,
            reference::hidden_probability(model, visible,
                                          reference::dynamic_hidden_bias(model, history)),
            reference::dynamic_visible_bias(model, history));
      sum += (visible - window.row(static_cast<Eigen::Index>(t))).squaredNorm();
      frames.emplace_back(visible);
    }
  }
  return sum / static_cast<double>(windows.size() * kFreeRunFrames) /
         static_cast<double>(windows.front().cols());
}

/// Hidden probabilities of each window's first frame that has a history. @return [windows x hidden]
MatrixD hidden_of(const reference::Crbm& model, std::size_t order,
                  const std::vector<MatrixD>& windows) {
  MatrixD hidden(windows.size(), model.hidden_bias.cols());
  for (std::size_t i = 0; i < windows.size(); ++i) {
    std::vector<RowVectorD> frames;
    for (std::size_t t = 0; t < order; ++t)
      frames.emplace_back(windows[i].row(static_cast<Eigen::Index>(t)));
    const MatrixD history = order > 0 ? history_of(frames, order) : MatrixD(1, 0);
    hidden.row(static_cast<Eigen::Index>(i)) =
        reference::hidden_probability(model, windows[i].row(static_cast<Eigen::Index>(order)),
                                      reference::dynamic_hidden_bias(model, history));
  }
  return hidden;
}

void check_against_reference(const CrbmShape& shape) {
  const CrbmParameters parameters = random_crbm(shape);
  const reference::Crbm model = in_double(parameters);
  std::vector<MatrixF> windows;
  std::vector<MatrixD> exact;
  for (unsigned i = 0; i < 5; ++i) {
    windows.push_back(random_matrix(shape.order + kFreeRunFrames, shape.visible, 10 + i, 2.0F));
    exact.push_back(windows.back().cast<double>());
  }
  const LayerHealth health = crbm_health(parameters, windows);
  const MatrixD hidden = hidden_of(model, shape.order, exact);
  CHECK(health.hidden_activity == doctest::Approx(hidden.mean()).epsilon(1e-5));
  const double saturated = static_cast<double>((hidden.array() < 0.01).count()) +
                           static_cast<double>((hidden.array() > 0.99).count());
  CHECK(saturated > 0);
  CHECK(health.saturation ==
        doctest::Approx(saturated / static_cast<double>(hidden.size())).epsilon(1e-12));
  CHECK(health.weight_norm == doctest::Approx(model.weights.norm()).epsilon(1e-5));
  CHECK(health.weight_norm_A.value() ==
        doctest::Approx(model.visible_history.norm()).epsilon(1e-5));
  CHECK(health.weight_norm_B.value() == doctest::Approx(model.hidden_history.norm()).epsilon(1e-5));
  REQUIRE(health.free_run_error.has_value());
  CHECK(*health.free_run_error ==
        doctest::Approx(free_run_error(model, shape.order, exact)).epsilon(1e-4));
}

/// Every frame carries its own number in all columns.
std::vector<MatrixF> numbered_clips(const std::vector<Eigen::Index>& lengths) {
  std::vector<MatrixF> clips;
  float number = 0;
  for (const Eigen::Index length : lengths) {
    MatrixF clip(length, 2);
    for (Eigen::Index t = 0; t < length; ++t) clip.row(t).setConstant(number++);
    clips.push_back(clip);
  }
  return clips;
}

}  // namespace

TEST_CASE("crbm_health is the double reference's: Gaussian and binary, with and without history") {
  check_against_reference({5, 7, 3, VisibleKind::gaussian});
  check_against_reference({6, 6, 2, VisibleKind::binary});
  check_against_reference({5, 8, 0, VisibleKind::gaussian});
  check_against_reference({5, 7, 4, VisibleKind::gaussian, 1, 4});
  check_against_reference({5, 7, 4, VisibleKind::binary, 4, 2});
}

TEST_CASE("layer health is of sixteen windows and ten free frames") {
  CHECK(kHealthWindows == 16);
  CHECK(kFreeRunFrames == 10);
}

TEST_CASE("saturation counts probabilities below 0.01 and above 0.99, no others") {
  MrbmParameters p = MrbmParameters::zeros(two_modalities(1, 1, 6));
  // σ: 0.0089, 0.0110, 0.5, 0.9890, 0.9911, 0.9999
  p.b << -4.7F, -4.5F, 0, 4.5F, 4.7F, 9.2F;
  const LayerHealth health = mrbm_health(p, {MatrixF::Zero(2, 1), MatrixF::Zero(2, 1)});
  CHECK(health.saturation == doctest::Approx(3.0 / 6));
  CHECK(!health.weight_norm_A);
  CHECK(!health.weight_norm_B);
}

TEST_CASE("health windows: a few are evenly over all frames of the clips that are long enough") {
  on_every_device([](Device& device) {
    // Of 4 frames: the first clip has windows that end at frames 5 to 8 (two have no code), the
    // second none, the third those that end at 19 to 114.
    Sequences sequences = Sequences::from_host(device, numbered_clips({9, 5, 101}));
    sequences.valid_from = 2;
    const auto windows = health_windows(sequences, 4);
    REQUIRE(windows.size() == kHealthWindows);
    std::vector<int> last_frames;
    for (int t = 5; t <= 8; ++t) last_frames.push_back(t);
    for (int t = 14 + 5; t <= 114; ++t) last_frames.push_back(t);
    for (std::size_t i = 0; i < windows.size(); ++i) {
      REQUIRE(windows[i].rows() == 4);
      REQUIRE(windows[i].cols() == 2);
      const int last = last_frames[i * last_frames.size() / kHealthWindows];
      for (int t = 0; t < 4; ++t)
        CHECK((windows[i].row(t).array() == static_cast<float>(last - 3 + t)).all());
    }
  });
}

TEST_CASE("health windows: all there are where there are few, none where no clip is long enough") {
  on_every_device([](Device& device) {
    const Sequences sequences = Sequences::from_host(device, numbered_clips({6, 3, 4}));
    const auto windows = health_windows(sequences, 4);
    REQUIRE(windows.size() == 4);  // ending at 3, 4, 5 and 12
    CHECK(windows[0](0, 0) == 0);
    CHECK(windows[2](3, 1) == 5);
    CHECK(windows[3](0, 0) == 9);
    CHECK(windows[3](3, 0) == 12);
    CHECK(health_windows(sequences, 7).empty());
  });
}

TEST_CASE("health windows of a CRBM are as short as they have to be where clips are short") {
  on_every_device([](Device& device) {
    const std::size_t order = 3;
    const Sequences long_enough = Sequences::from_host(device, numbered_clips({6, 13}));
    const auto whole = crbm_health_windows(long_enough, order);
    REQUIRE(whole.size() == 1);
    CHECK(whole[0].rows() == 13);
    const Sequences brief = Sequences::from_host(device, numbered_clips({6, 12}));
    const auto windows = crbm_health_windows(brief, order);
    CHECK(windows.size() == 3 + 9);
    for (const MatrixF& window : windows) CHECK(window.rows() == 4);
    CHECK(crbm_health_windows(Sequences::from_host(device, numbered_clips({3})), order).empty());
  });
}

TEST_CASE("a training on short clips reports the hidden units' health") {
  on_every_device([](Device& device) {
    const Sequences brief =
        Sequences::from_host(device, {random_matrix(7, 3, 1), random_matrix(8, 3, 2)});
    LearningSettings settings;
    settings.batch = 5;
    settings.least_batches = 2;
    settings.gaussian.epochs = 1;
    std::vector<EpochReport> reports;
    train_crbm(device, brief, CrbmParameters::zeros({3, 4, 2, VisibleKind::gaussian}),
               settings.gaussian, settings, 0,
               [&](const EpochReport& report) { reports.push_back(report); });
    REQUIRE(reports.size() == 1);
    REQUIRE(reports[0].health);
    // From zeros one epoch moves a probability of one half a little.
    CHECK(reports[0].health->hidden_activity == doctest::Approx(0.5).epsilon(0.1));
    CHECK(!reports[0].health->free_run_error);
  });
}

}  // namespace layer_health_reference_test
