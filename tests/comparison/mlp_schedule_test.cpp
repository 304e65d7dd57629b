// The perceptron's whole training, tiny, against double precision: windows, shuffles, rates, masks.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "comparison/adam_reference.hpp"
#include "comparison/clips.hpp"
#include "comparison/mlp_window.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/random.hpp"

namespace mlp_schedule_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::uint16_t kStream = 0x4d4c;
constexpr Eigen::Index kReach = 5, kFrames = 11;

/// Training frames as windows: each clip's ends are repeated, what is unknown is 0.
struct Windows {
  MatrixD inputs, targets;  ///< [all frames x 11·stride], [all frames x pose]
};

Windows windows_of(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  const auto stride = static_cast<Eigen::Index>(padded(static_cast<std::size_t>(tracks[0].cols())));
  Eigen::Index frames = 0;
  for (const MatrixF& track : tracks) frames += track.rows();
  Windows all{MatrixD::Zero(frames, kFrames * stride), MatrixD(frames, poses[0].cols())};
  Eigen::Index row = 0;
  for (std::size_t clip = 0; clip < tracks.size(); ++clip)
    for (Eigen::Index t = 0; t < tracks[clip].rows(); ++t, ++row) {
      for (Eigen::Index k = 0; k < kFrames; ++k) {
        const auto at = std::clamp<Eigen::Index>(t + k - kReach, 0, tracks[clip].rows() - 1);
        for (Eigen::Index c = 0; c < tracks[clip].cols(); ++c)
          if (!std::isnan(tracks[clip](at, c)))
            all.inputs(row, k * stride + c) = tracks[clip](at, c);
      }
      all.targets.row(row) = poses[clip].row(t).cast<double>();
    }
  return all;
}

class Reference {
 public:
  Reference(const Windows& windows, const MlpWindow::Settings& settings, Eigen::Index columns)
      : windows_(windows), settings_(settings) {
    const auto hidden = static_cast<Eigen::Index>(settings.hidden);
    const std::array<Eigen::Index, 4> sizes{windows.inputs.cols(), hidden, hidden,
                                            windows.targets.cols()};
    for (std::uint32_t i = 0; i < 3; ++i) {
      const double inputs =
          i == 0 ? static_cast<double>(kFrames * columns) : static_cast<double>(settings.hidden);
      MatrixD start(sizes[i], sizes[i + 1]);
      for (Eigen::Index r = 0; r < start.rows(); ++r)
        for (Eigen::Index c = 0; c < start.cols(); ++c)
          start(r, c) = static_cast<float>(std::sqrt(1.0 / (3.0 * inputs)) *
                                           random_normal({settings.seed, i + 1, kStream, 1},
                                                         static_cast<std::uint32_t>(r),
                                                         static_cast<std::uint32_t>(c)));
      W.emplace_back(start);
      b.emplace_back(MatrixD::Zero(1, start.cols()));
    }
  }

  void train() {
    std::vector<Eigen::Index> order;
    const auto rows = static_cast<std::size_t>(windows_.inputs.rows());
    const std::size_t batch = std::min(settings_.batch, rows);
    do
      for (std::size_t i = 0; i < rows; ++i) order.push_back(static_cast<Eigen::Index>(i));
    while (order.size() / batch < settings_.least_batches);
    const std::size_t batches = order.size() / batch, all = settings_.epochs * batches;
    for (std::size_t step = 0; step < all; ++step) {
      if (step % batches == 0) shuffle(order, static_cast<std::uint32_t>(step / batches));
      const double progress = static_cast<double>(step) / static_cast<double>(all);
      const auto begin = order.begin() + static_cast<std::ptrdiff_t>(step % batches * batch);
      take_step({begin, begin + static_cast<std::ptrdiff_t>(batch)},
                settings_.rate * std::min(1.0, 2.0 - 1.98 * progress));
    }
  }

  std::vector<AdamReference> W, b;

 private:
  void shuffle(std::vector<Eigen::Index>& order, std::uint32_t epoch) const {
    for (std::size_t i = order.size() - 1; i > 0; --i) {
      const std::uint64_t bits =
          random_bits({settings_.seed, epoch, kStream, 0}, static_cast<std::uint32_t>(i), 0);
      std::swap(order[i], order[bits * (i + 1) >> 32U]);
    }
  }

  MatrixD mask(const MatrixD& units, std::uint16_t layer) const {
    const float kept = 1.0F - static_cast<float>(settings_.dropout);
    const RandomKey key{settings_.seed, static_cast<std::uint32_t>(steps_),
                        static_cast<std::uint16_t>(kStream + 1 + layer), 2};
    MatrixD result(units.rows(), units.cols());
    for (Eigen::Index r = 0; r < units.rows(); ++r)
      for (Eigen::Index c = 0; c < units.cols(); ++c)
        result(r, c) =
            random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c)) < kept
                ? 1.0 / kept
                : 0.0;
    return result;
  }

  void take_step(const std::vector<Eigen::Index>& rows, double rate) {
    ++steps_;
    std::array<MatrixD, 3> input{MatrixD(windows_.inputs(rows, Eigen::all)), {}, {}};
    std::array<MatrixD, 2> slope;
    MatrixD output;
    for (std::size_t i = 0; i < 3; ++i) {
      output = (input[i] * W[i].value).rowwise() + RowVectorD(b[i].value.row(0));
      if (i == 2) break;
      slope[i] = (output.array() > 0).cast<double>();
      if (settings_.dropout > 0)
        slope[i].array() *= mask(output, static_cast<std::uint16_t>(i)).array();
      input[i + 1] = output.cwiseProduct(slope[i]);
    }
    MatrixD error =
        (output - windows_.targets(rows, Eigen::all)) / static_cast<double>(rows.size());
    std::array<MatrixD, 3> errors;
    for (std::size_t i = 3; i-- > 0;) {
      errors[i] = error;
      if (i > 0) error = (error * W[i].value.transpose()).cwiseProduct(slope[i - 1]).eval();
    }
    for (std::size_t i = 0; i < 3; ++i) {
      W[i].update(input[i].transpose() * errors[i], rate, settings_.weight_decay, steps_);
      b[i].update(errors[i].colwise().sum(), rate, 0.0, steps_);
    }
  }

  const Windows& windows_;
  MlpWindow::Settings settings_;
  int steps_ = 0;
};

/// Clips of different lengths, one without frames, one with joints that were not seen.
std::vector<MatrixF> tracks() {
  std::vector<MatrixF> clips{random_clip(9, 3, 1), MatrixF(0, 3), random_clip(4, 3, 2),
                             random_clip(1, 3, 3)};
  clips[0](4, 1) = clips[2](3, 0) = NAN;
  return clips;
}

std::vector<MatrixF> poses() {
  return {random_clip(9, 4, 4), MatrixF(0, 4), random_clip(4, 4, 5), random_clip(1, 4, 6)};
}

}  // namespace

TEST_CASE("mlp_window's training is the reference's, step by step") {
  std::vector<MlpWindow::Settings> cases(3);
  for (MlpWindow::Settings& settings : cases) {
    settings.hidden = 7;
    settings.epochs = 3;
    settings.least_batches = 2;
    settings.batch = 5;
    settings.rate = 0.01;
    settings.seed = 0x900000007ULL;
  }
  cases[1].least_batches = 5;  // more than the 14 frames give: they come again
  cases[1].dropout = 0.0;
  cases[1].weight_decay = 0.0;
  cases[2].batch = 100;  // all frames at once
  on_every_device([&](Device& device) {
    for (const MlpWindow::Settings& settings : cases) {
      INFO("batch ", settings.batch, ", least ", settings.least_batches);
      MlpWindow mlp(device, settings);
      mlp.fit(tracks(), poses());
      const Windows windows = windows_of(tracks(), poses());
      Reference reference(windows, settings, 3);
      reference.train();
      // A step is as long as the rate: rounding is far below a thousandth of one, anything that is
      // done otherwise is not.
      for (std::size_t i = 0; i < 3; ++i) {
        CAPTURE(i);
        const double off_W =
            (mlp.layers()[i].W.cast<double>() - reference.W[i].value).cwiseAbs().maxCoeff();
        const double off_b =
            (mlp.layers()[i].b.cast<double>() - reference.b[i].value).cwiseAbs().maxCoeff();
        CHECK(!(off_W > 0.001 * settings.rate));
        CHECK(!(off_b > 0.001 * settings.rate));
      }
    }
  });
}

TEST_CASE("mlp_window: what its settings are unless they are given, and for many views") {
  const MlpWindow::Settings usual, views = MlpWindow::Settings::for_views();
  CHECK(usual.hidden == 512);
  CHECK(usual.epochs == 40);
  CHECK(usual.least_batches == 40);
  CHECK(usual.batch == 100);
  CHECK(usual.rate == 1e-3);
  CHECK(usual.dropout == 0.3);
  CHECK(usual.weight_decay == 2.0);
  CHECK(usual.seed == 1);
  CHECK(views.hidden == 512);
  CHECK(views.epochs == 6);
  CHECK(views.least_batches == 40);
  CHECK(views.batch == 500);
  CHECK(views.rate == 1e-3);
  CHECK(views.dropout == 0.3);
  CHECK(views.weight_decay == 1.0);
  CHECK(views.seed == 1);
}

}  // namespace mlp_schedule_test
