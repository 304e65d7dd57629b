// Reconstructions against the equations in double; what chains draw against enumeration.

#include "mcdbn/machines/sampling.hpp"

#include <doctest/doctest.h>

#include <boost/math/distributions/normal.hpp>
#include <limits>

#include "device/every_device.hpp"
#include "machines/in_double.hpp"
#include "machines/random_crbm.hpp"
#include "machines/tiny_crbm.hpp"
#include "mcdbn/base/errors.hpp"
#include "reference/chi_square.hpp"
#include "reference/crbm_enumeration.hpp"
#include "reference/error_bounds.hpp"
#include "reference/running_error.hpp"
#include "reference/units_reference.hpp"

namespace sampling_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::chi_square_p_value;
using reference::exact;
using reference::misfit;
using reference::state_counts;
using reference::Sum;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
constexpr std::size_t kChains = 20'000;
/// Chance misses that one seed in a million gives; the seeds are fixed.
constexpr double kLeastP = 1e-6;

/// bias + Σ over the history of frame t of one clip.
Sum with_history(const std::vector<Bounded>& frames, std::size_t t, const MatrixF& weights,
                 const MatrixF& bias, const CrbmShape& shape) {
  Sum sum;
  sum.add(exact(bias));
  const auto visible = static_cast<Eigen::Index>(shape.visible);
  for (std::size_t q = 0; q < shape.order; ++q)
    sum.add_product(frames[t - shape.order + q],
                    exact(weights.middleRows(static_cast<Eigen::Index>(q) * visible, visible)));
  return sum;
}

Bounded hidden_of(const CrbmParameters& p, const std::vector<Bounded>& frames, std::size_t t,
                  const Bounded& visible) {
  return sigmoid(
      with_history(frames, t, p.B, p.b, p.shape).add_product(visible, exact(p.W)).result());
}

Bounded visible_of(const CrbmParameters& p, const std::vector<Bounded>& frames, std::size_t t,
                   const Bounded& hidden) {
  const Bounded mean = with_history(frames, t, p.A, p.a, p.shape)
                           .add_product(hidden, exact(p.W).transposed())
                           .result();
  return p.shape.kind == kBinary ? sigmoid(mean) : mean;
}

/// Frame by frame from `first` on, up through all layers and down again.
std::vector<Bounded> reconstructions(const std::vector<CrbmParameters>& layers, const MatrixF& clip,
                                     std::size_t steps, std::size_t first) {
  std::vector<std::vector<Bounded>> codes(layers.size());
  for (Eigen::Index t = 0; t < clip.rows(); ++t) codes[0].push_back(exact(clip.row(t)));
  std::size_t order = 0;
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    order += layers[i].shape.order;
    codes[i + 1].resize(codes[i].size());
    for (std::size_t t = order; t < codes[i].size(); ++t)
      codes[i + 1][t] = hidden_of(layers[i], codes[i], t, codes[i][t]);
  }
  std::vector<Bounded> result;
  for (std::size_t t = first; t < codes[0].size(); ++t) {
    const std::size_t top = layers.size() - 1;
    Bounded units = codes[top][t];
    for (std::size_t step = 0; step < steps; ++step)
      units = visible_of(layers[top], codes[top], t, hidden_of(layers[top], codes[top], t, units));
    for (std::size_t i = top; i-- > 0;) units = visible_of(layers[i], codes[i], t, units);
    result.push_back(units);
  }
  return result;
}

Cdbn on_device(Device& device, const std::vector<CrbmParameters>& layers) {
  Cdbn cdbn;
  for (const CrbmParameters& layer : layers) cdbn.layers.emplace_back(device, layer);
  return cdbn;
}

Matrix mean_start(const Crbm& rbm, std::size_t chains = kChains) {
  return Matrix::filled_with_row(rbm.visible_mean, chains);
}

/// So many clips of one frame each, all alike, or of several.
Sequences copies(Device& device, const MatrixF& clip, std::size_t count = kChains) {
  return Sequences::from_host(device, std::vector<MatrixF>(count, clip));
}

/// Frame t of every clip. @return [clips x visible]
MatrixD frames_at(const Sequences& sequences, std::size_t t) {
  const MatrixF all = sequences.values.to_host();
  MatrixD rows(sequences.clips.size(), all.cols());
  for (std::size_t i = 0; i < sequences.clips.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) =
        all.row(static_cast<Eigen::Index>(sequences.clips[i].first + t)).cast<double>();
  return rows;
}

/// Chi-square of each unit against its own mixture of Gaussians under the hidden states' p(h).
void check_gaussian_marginals(const MatrixD& rows, const CrbmParameters& p,
                              const MatrixD& history) {
  const reference::Crbm model = in_double(p);
  const MatrixD states = reference::all_states(static_cast<Eigen::Index>(p.shape.hidden));
  const Eigen::VectorXd probability = reference::hidden_distribution(model, history);
  const MatrixD means = reference::visible_mean(
      model, states, reference::dynamic_visible_bias(model, history).replicate(states.rows(), 1));
  const boost::math::normal normal;
  constexpr int kBins = 24;
  constexpr double kFrom = -6.0, kWidth = 0.5;  // the first and last bin have no end
  for (Eigen::Index i = 0; i < rows.cols(); ++i) {
    Eigen::VectorXd counts = Eigen::VectorXd::Zero(kBins), below(kBins + 1);
    for (int bin = 0; bin <= kBins; ++bin) {
      double share = bin == kBins ? 1.0 : 0.0;
      if (bin > 0 && bin < kBins)
        for (Eigen::Index s = 0; s < states.rows(); ++s)
          share += probability(s) * boost::math::cdf(normal, kFrom + kWidth * bin - means(s, i));
      below(bin) = share;
    }
    for (const double x : rows.col(i))
      counts(std::clamp(static_cast<int>(std::floor((x - kFrom) / kWidth)), 0, kBins - 1)) += 1.0;
    CAPTURE(i);
    CHECK(chi_square_p_value(counts, below.tail(kBins) - below.head(kBins)) > kLeastP);
  }
}

}  // namespace

TEST_CASE("small: reconstructions are mean field, up and down through all layers") {
  const std::vector<std::vector<CrbmParameters>> machines = {
      {random_crbm({5, 3, 0, kBinary}, 1, 4.0F)},
      {random_crbm({17, 5, 2, kGaussian}, 2, 4.0F)},
      {random_crbm({3, 17, 1, kBinary}, 3, 4.0F)},
      {random_crbm({5, 7, 2, kGaussian}, 4, 4.0F), random_crbm({7, 16, 1, kBinary}, 5, 4.0F),
       random_crbm({16, 4, 0, kBinary}, 6, 4.0F)}};
  on_every_device([&](Device& device) {
    for (const auto& layers : machines)
      for (const std::size_t steps : {1, 3}) {
        INFO(layers.size(), " layers, ", layers.front().shape.visible, " visible, ", steps);
        const std::size_t visible = layers.front().shape.visible;
        const std::vector<MatrixF> clips = {random_matrix(7, visible, 1),
                                            random_matrix(2, visible, 2),
                                            random_matrix(5, visible, 3)};
        const Cdbn cdbn = on_device(device, layers);
        const Sequences data = Sequences::from_host(device, clips);
        const Sequences got = reconstruct(cdbn, data, steps);
        CHECK(got.valid_from == cdbn.total_order());
        CHECK(padding_is_zero(got.values));
        if (layers.size() == 1)
          CHECK(reconstruct(cdbn.layers.front(), data, steps).values.to_host() ==
                got.values.to_host());
        const std::vector<MatrixF> rows = got.to_host();
        for (std::size_t c = 0; c < clips.size(); ++c) {
          const auto want = reconstructions(layers, clips[c], steps, got.valid_from);
          const auto first = std::min(static_cast<Eigen::Index>(got.valid_from), clips[c].rows());
          CHECK((rows[c].topRows(first).array() == 0.0F).all());
          for (std::size_t t = 0; t < want.size(); ++t) {
            CAPTURE(c);
            CAPTURE(t);
            CHECK(misfit(rows[c].row(first + static_cast<Eigen::Index>(t)), want[t].value,
                         want[t].bound) == "");
          }
        }
      }
  });
}

TEST_CASE("an RBM's free chains come to its states as often as enumeration gives") {
  const CrbmParameters p = tiny_crbm({4, 5, 0, kBinary}, 31);
  const Eigen::VectorXd want = reference::visible_distribution(in_double(p), MatrixD(1, 0));
  on_every_device([&](Device& device) {
    const Crbm rbm(device, p);
    const auto p_value = [&](std::size_t steps, std::uint64_t seed) {
      const Matrix drawn = sample(rbm, mean_start(rbm), {.steps = steps, .seed = seed});
      return chi_square_p_value(state_counts(drawn.to_host().cast<double>()), want);
    };
    for (const std::uint64_t seed : {1, 2, 3}) CHECK(p_value(40, seed) > kLeastP);
    CHECK(p_value(1, 1) < 1e-9);  // else the number of steps would not matter
    // One chain more draws the same of the others; another seed does not.
    const MatrixF one = sample(rbm, mean_start(rbm, 64), {.steps = 3}).to_host();
    CHECK(sample(rbm, mean_start(rbm, 65), {.steps = 3}).to_host().topRows(64) == one);
    CHECK(sample(rbm, mean_start(rbm, 64), {.steps = 3, .seed = 2}).to_host() != one);
  });
}

TEST_CASE("a Gaussian RBM's free chains have the marginals that enumeration gives") {
  const CrbmParameters p = tiny_crbm({3, 4, 0, kGaussian}, 41);
  on_every_device([&](Device& device) {
    const Crbm rbm(device, p);
    const Matrix drawn = sample(rbm, mean_start(rbm), {.steps = 60, .seed = 4});
    check_gaussian_marginals(drawn.to_host().cast<double>(), p, MatrixD(1, 0));
  });
}

TEST_CASE("expectations of a long run are those of enumeration") {
  for (const VisibleKind kind : {kBinary, kGaussian}) {
    const CrbmParameters p = tiny_crbm({4, 3, 0, kind}, 51);
    const reference::Crbm model = in_double(p);
    const reference::Crbm want = reference::expected_statistics(model, MatrixD(1, 0));
    on_every_device([&](Device& device) {
      const Crbm rbm(device, p);
      const Matrix drawn = sample(rbm, mean_start(rbm), {.steps = 60, .seed = 5});
      const Sequences chains{drawn, {{0, kChains}}, 0};
      const MatrixD v = drawn.to_host().cast<double>(),
                    h = up_pass(rbm, chains).values.to_host().cast<double>();
      const auto check = [&](const Eigen::ArrayXd& x, double expected) {
        const double mean = x.mean();
        const double error = std::sqrt((x - mean).square().mean() / static_cast<double>(kChains));
        CHECK(std::abs(mean - expected) < 5.0 * error);
      };
      for (Eigen::Index i = 0; i < v.cols(); ++i) {
        check(v.col(i), want.visible_bias(i));
        for (Eigen::Index j = 0; j < h.cols(); ++j)
          check(v.col(i).cwiseProduct(h.col(j)), want.weights(i, j));
      }
      for (Eigen::Index j = 0; j < h.cols(); ++j) check(h.col(j), want.hidden_bias(j));
    });
  }
}

TEST_CASE("units that are given stay, and the others follow p(unknown | given)") {
  const CrbmParameters p = tiny_crbm({5, 4, 0, kBinary}, 61);
  MatrixF frame(1, 5);
  frame << 1, kUnknown, 0, kUnknown, kUnknown;
  const Eigen::VectorXd all = reference::visible_distribution(in_double(p), MatrixD(1, 0));
  Eigen::VectorXd want(8);
  for (int s = 0; s < 8; ++s) want(s) = all(1 | (s & 1) << 1 | (s & 2) << 2 | (s & 4) << 2);
  want /= want.sum();
  on_every_device([&](Device& device) {
    const Sequences drawn =
        sample_given(Crbm(device, p), copies(device, frame), {.steps = 40, .seed = 6});
    const MatrixD rows = frames_at(drawn, 0);
    CHECK((rows.col(0).array() == 1.0).all());
    CHECK((rows.col(2).array() == 0.0).all());
    MatrixD unknown(rows.rows(), 3);
    unknown << rows.col(1), rows.col(3), rows.col(4);
    CHECK(chi_square_p_value(state_counts(unknown), want) > kLeastP);
  });
}

TEST_CASE("frames of a CRBM are drawn one after another under what came before") {
  const CrbmParameters p = tiny_crbm({2, 4, 2, kBinary}, 71, 1.5F);
  const reference::Crbm model = in_double(p);
  MatrixF clip(4, 2);
  clip << 1, 0, 0, 1, kUnknown, kUnknown, kUnknown, 1;
  // p(v3 | v1, v2) · p(v4's first unit | v2, v3, its second is 1)
  Eigen::VectorXd want(8);
  MatrixD history(1, 4);
  history << 1, 0, 0, 1;
  const Eigen::VectorXd third = reference::visible_distribution(model, history);
  for (int s = 0; s < 4; ++s) {
    history << 0, 1, s & 1, s >> 1;
    const Eigen::VectorXd fourth = reference::visible_distribution(model, history);
    for (const int first : {0, 1})
      want(s | first << 2) = third(s) * fourth(first | 2) / (fourth(2) + fourth(3));
  }
  on_every_device([&](Device& device) {
    const Sequences drawn =
        sample_given(Crbm(device, p), copies(device, clip), {.steps = 40, .seed = 7});
    const MatrixD last = frames_at(drawn, 3);
    MatrixD unknown(last.rows(), 3);
    unknown << frames_at(drawn, 2), last.col(0);
    CHECK((last.col(1).array() == 1.0).all());
    CHECK(chi_square_p_value(state_counts(unknown), want) > kLeastP);
  });
}

TEST_CASE("a Gaussian CRBM draws under its history; before a clip stands the training mean") {
  CrbmParameters p = tiny_crbm({3, 3, 2, kGaussian}, 81);
  p.visible_mean = random_matrix(1, 3, 82);
  MatrixF clip = MatrixF::Constant(2, 3, kUnknown);
  clip.row(0) = random_matrix(1, 3, 83);
  MatrixD history(1, 6);
  history << p.visible_mean.cast<double>(), clip.row(0).cast<double>();
  on_every_device([&](Device& device) {
    const Sequences drawn =
        sample_given(Crbm(device, p), copies(device, clip), {.steps = 60, .seed = 8});
    check_gaussian_marginals(frames_at(drawn, 1), p, history);
  });
}

TEST_CASE("a DBN's free samples are its top chains' states, drawn down") {
  const std::vector<CrbmParameters> layers = {tiny_crbm({4, 3, 0, kBinary}, 91, 2.0F),
                                              tiny_crbm({3, 4, 0, kBinary}, 92)};
  const Eigen::VectorXd top = reference::visible_distribution(in_double(layers[1]), MatrixD(1, 0));
  const MatrixD means = reference::visible_mean(in_double(layers[0]), reference::all_states(3),
                                                layers[0].a.cast<double>().replicate(8, 1));
  const MatrixD states = reference::all_states(4);
  Eigen::VectorXd want = Eigen::VectorXd::Zero(16);
  for (Eigen::Index s = 0; s < 16; ++s)
    for (Eigen::Index h = 0; h < 8; ++h) {
      double p = top(h);
      for (Eigen::Index i = 0; i < 4; ++i)
        p *= states(s, i) == 1.0 ? means(h, i) : 1.0 - means(h, i);
      want(s) += p;
    }
  on_every_device([&](Device& device) {
    const Cdbn dbn = on_device(device, layers);
    const Matrix start = mean_start(dbn.layers.front());
    const MatrixF drawn = sample(dbn, start, {.steps = 40, .seed = 9}).to_host();
    CHECK(chi_square_p_value(state_counts(drawn.cast<double>()), want) > kLeastP);
    // Means of the last step: of each of the eight codes one row.
    const MatrixD mean =
        sample(dbn, start, {.steps = 40, .seed = 9, .means = true}).to_host().cast<double>();
    CHECK((mean.colwise().mean() - top.transpose() * means).cwiseAbs().maxCoeff() < 0.02);
    for (Eigen::Index r = 0; r < 50; ++r)
      CHECK((means.rowwise() - mean.row(r)).cwiseAbs().rowwise().maxCoeff().minCoeff() < 1e-6);
  });
}

TEST_CASE("small: a stack keeps what it is given, whatever its layers' orders") {
  on_every_device([](Device& device) {
    const Cdbn cdbn = on_device(device, {random_crbm({5, 7, 2, kGaussian}, 1, 4.0F),
                                         random_crbm({7, 3, 1, kBinary}, 2, 4.0F)});
    MatrixF clip = random_matrix(6, 5, 3);
    MatrixF other = random_matrix(3, 5, 4);
    MatrixF partly = clip;
    partly.col(1).setConstant(kUnknown);
    partly(4, 3) = kUnknown;
    const ChainSettings settings{.steps = 3, .seed = 3};
    const auto drawn =
        sample_given(cdbn, Sequences::from_host(device, {partly, other}), settings).to_host();
    CHECK(drawn[1] == other);
    CHECK(drawn[0].allFinite());
    int changed = 0;
    for (Eigen::Index r = 0; r < 6; ++r)
      for (Eigen::Index c = 0; c < 5; ++c) {
        if (partly(r, c) == clip(r, c)) CHECK(drawn[0](r, c) == clip(r, c));
        changed += drawn[0](r, c) != clip(r, c) ? 1 : 0;
      }
    CHECK(changed == 7);
    // A clip more changes nothing of the others' means, and later frames nothing of earlier ones.
    const auto alone =
        sample_given(cdbn, Sequences::from_host(device, {MatrixF(partly.topRows(3))}), settings)
            .to_host();
    CHECK(alone[0] == drawn[0].topRows(3));
  });
}

TEST_CASE("small: sampling refuses what does not fit") {
  on_every_device([](Device& device) {
    const Crbm crbm(device, random_crbm({3, 2, 1, kBinary}, 1, 4.0F)),
        rbm(device, random_crbm({3, 2, 0, kBinary}, 1, 4.0F));
    CHECK_THROWS_AS(sample(crbm, Matrix(device, 2, 3), {}), ShapeError);
    CHECK_THROWS_AS(sample(rbm, Matrix(device, 2, 4), {}), ShapeError);
    CHECK_THROWS_AS(sample(Cdbn{}, Matrix(device, 2, 4), {}), ShapeError);
    CHECK_THROWS_AS(sample(rbm, Matrix(device, 2, 3), {.steps = 0}), ShapeError);
    const Sequences wide = Sequences::from_host(device, {MatrixF::Zero(2, 4)});
    CHECK_THROWS_AS(sample_given(rbm, wide, {}), ShapeError);
    CHECK_THROWS_AS(reconstruct(rbm, wide), ShapeError);
    CHECK_THROWS_AS(reconstruct(Cdbn{}, wide), ShapeError);
  });
}

}  // namespace sampling_test
