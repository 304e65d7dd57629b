// Fine-tuning of networks whose Gaussian units have deviations of their own: the prediction is that
// of the same network without them, from the data over them, in the data's units.

#include <doctest/doctest.h>

#include <numeric>

#include "learning/small_network.hpp"
#include "learning/unrolled_pass.hpp"
#include "mcdbn/machines/regeneration.hpp"

namespace unrolled_deviation_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr SequenceWindows kWindows{.count = 2, .frames = 8, .first = 4, .judged_from = 5};
constexpr std::size_t kMeanFieldSteps = 3;
constexpr std::array<std::size_t, 2> kVisible{3, 5};

/// Powers of two, so that scaling rounds nothing.
RowVectorF deviations(std::size_t modality) {
  RowVectorF row(5);
  row << 2.0F, 0.5F, 4.0F, 1.0F, 0.25F;
  return row.head(static_cast<Eigen::Index>(kVisible[modality]));
}

MatrixF over(const MatrixF& x, std::size_t modality) {
  return (x.array().rowwise() / deviations(modality).array()).matrix();
}
MatrixF times(const MatrixF& x, std::size_t modality) {
  return (x.array().rowwise() * deviations(modality).array()).matrix();
}

/// A network with deviations, and the same one without.
struct Pair {
  NetworkParameters with, without;

  Pair() {
    without = random_network(kVisible, {{{{4, 2}, {3, 1}}, {{2, 1}, {6, 3}}}}, 4, 100);
    for (std::size_t m = 0; m < 2; ++m)
      without.stacks[m][0].visible_mean =
          random_matrix(1, kVisible[m], 7 + static_cast<unsigned>(m));
    with = without;
    for (std::size_t m = 0; m < 2; ++m) {
      CrbmParameters& lowest = with.stacks[m][0];
      lowest.visible_mean = times(lowest.visible_mean, m);
      lowest.visible_deviation = deviations(m);
    }
  }
};

/// A pass forward on these windows, and back from this error of the prediction.
struct Run {
  MatrixF prediction;
  std::vector<MatrixF> gradients;

  Run(Device& device, const NetworkParameters& parameters, std::size_t absent,
      const std::array<MatrixF, 2>& windows, const MatrixF& error) {
    UnrolledNetwork network(device, on_device(device, parameters, 0, kMeanFieldSteps),
                            kMeanFieldSteps);
    UnrolledPass pass(network, absent, kWindows);
    std::vector<std::int32_t> all(kWindows.rows());
    std::iota(all.begin(), all.end(), 0);
    const IndexBuffer index(device, all);
    const std::array<Matrix, 2> on_device{Matrix::from_host(device, windows[0]),
                                          Matrix::from_host(device, windows[1])};
    std::vector<Rows> rows;
    for (const Matrix& matrix : on_device)
      rows.push_back(Rows::indexed(matrix, index, 0, kWindows.rows()));
    network.clear_gradients();
    pass.forward(rows, 1.0F, {});
    prediction = pass.prediction().to_host();
    MatrixF with_room =
        MatrixF::Zero(static_cast<Eigen::Index>(pass.prediction_error().rows()), error.cols());
    with_room.topRows(error.rows()) = error;
    pass.prediction_error().upload(with_room);
    pass.backward();
    for (std::size_t m = 0; m < 2; ++m)
      for (const auto& layer : network.layers(m))
        for (const Matrix* matrix : {&layer.gradient.W, &layer.gradient.A, &layer.gradient.B,
                                     &layer.gradient.a, &layer.gradient.b})
          gradients.push_back(matrix->to_host());
    for (const Matrix& matrix : network.mrbm_gradient().W) gradients.push_back(matrix.to_host());
  }

  /// Frames from kWindows.first on of each window.
  MatrixF predicted() const {
    const auto first = static_cast<Eigen::Index>(kWindows.first),
               frames = static_cast<Eigen::Index>(kWindows.frames);
    MatrixF result(2 * (frames - first), prediction.cols());
    result << prediction.middleRows(first, frames - first),
        prediction.middleRows(frames + first, frames - first);
    return result;
  }
};

}  // namespace

TEST_CASE("small: fine-tuning sees data over the units' deviations and predicts times them") {
  const Pair networks;
  std::array<MatrixF, 2> windows, own;
  for (std::size_t m = 0; m < 2; ++m) {
    windows[m] = random_matrix(kWindows.rows(), kVisible[m], 20 + static_cast<unsigned>(m));
    own[m] = over(windows[m], m);
  }
  for (const std::size_t absent : {0U, 1U}) {
    CAPTURE(absent);
    MatrixF error = MatrixF::Zero(static_cast<Eigen::Index>(kWindows.rows()),
                                  static_cast<Eigen::Index>(kVisible[absent]));
    for (std::size_t i = 0; i < kWindows.count; ++i) {
      const std::size_t judged = kWindows.frames - kWindows.judged_from;
      error.middleRows(static_cast<Eigen::Index>(i * kWindows.frames + kWindows.judged_from),
                       static_cast<Eigen::Index>(judged)) =
          random_matrix(judged, kVisible[absent], 30 + static_cast<unsigned>(i));
    }
    on_every_device([&](Device& device) {
      const Run with(device, networks.with, absent, windows, error),
          without(device, networks.without, absent, own, times(error, absent));
      CHECK(with.predicted() == times(without.predicted(), absent));
      REQUIRE(with.gradients.size() == without.gradients.size());
      for (std::size_t i = 0; i < with.gradients.size(); ++i)
        CHECK(with.gradients[i] == without.gradients[i]);
      CHECK(with.gradients.back().cwiseAbs().maxCoeff() > 0);
    });
  }
}

TEST_CASE("fine-tuning begins with the network that it was given, deviations and all") {
  const Pair networks;
  const MatrixF track = random_matrix(12, kVisible[0], 40);
  on_every_device([&](Device& device) {
    const Mcdbn start = on_device(device, networks.with, 1, kMeanFieldSteps);
    UnrolledNetwork network(device, start, kMeanFieldSteps);
    const Mcdbn result = network.with_parameters(network.averages());
    for (std::size_t m = 0; m < 2; ++m)
      CHECK(result.cdbns[m].layers[0].to_host().visible_deviation == MatrixF(deviations(m)));
    const MatrixF want = regenerate(start, {track}).front(),
                  got = regenerate(result, {track}).front();
    // Units about zero have other biases, which round otherwise.
    CHECK((got - want).cwiseAbs().maxCoeff() < 1e-4F * (1.0F + want.cwiseAbs().maxCoeff()));
  });
}

}  // namespace unrolled_deviation_test
