// Free energies and what is made of them, against the equations in double and against enumeration.

#include "mcdbn/machines/energy.hpp"

#include <doctest/doctest.h>

#include "base/random_streams.hpp"
#include "device/every_device.hpp"
#include "machines/in_double.hpp"
#include "machines/random_crbm.hpp"
#include "machines/sequence_blocks.hpp"
#include "machines/tiny_crbm.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/random.hpp"
#include "reference/crbm_enumeration.hpp"
#include "reference/error_bounds.hpp"
#include "reference/running_error.hpp"
#include "reference/units_reference.hpp"

namespace energy_test {

using namespace mcdbn;
using namespace mcdbn::test;
using reference::Bounded;
using reference::exact;
using reference::misfit;
using reference::Sum;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;

const std::vector<CrbmShape> kShapes = {
    {1, 1, 0, kBinary},  {1, 1, 1, kGaussian},   {3, 17, 2, kBinary},  {17, 3, 1, kGaussian},
    {16, 5, 0, kBinary}, {31, 33, 3, kGaussian}, {5, 16, 0, kGaussian}};

/// 0 and 1 for binary units, else about 0.
MatrixF frames_of(const CrbmShape& shape, std::size_t frames, unsigned seed) {
  const MatrixF values = random_matrix(frames, shape.visible, seed, 2.0F);
  if (shape.kind == kGaussian) return values;
  return (values.array() > 0.0F).cast<float>();
}

/// The `order` frames before each frame from `order` on, oldest first (eq 15).
MatrixF histories(const MatrixF& frames, std::size_t order) {
  const auto n = static_cast<Eigen::Index>(order);
  MatrixF result(frames.rows() - n, n * frames.cols());
  for (Eigen::Index q = 0; q < n; ++q)
    result.middleCols(q * frames.cols(), frames.cols()) = frames.middleRows(q, result.rows());
  return result;
}

/// [frames − order x 1]. @param visible takes the place of the frames that have a history
Bounded energies(const CrbmParameters& p, const MatrixF& history, const MatrixF& visible) {
  const Bounded v = exact(visible), past = exact(history);
  const Bounded visible_bias = Sum().add_product(past, exact(p.A)).add_row(exact(p.a)).result();
  const Bounded hidden_bias = Sum().add_product(past, exact(p.B)).add_row(exact(p.b)).result();
  const Bounded hidden = softplus(Sum().add(hidden_bias).add_product(v, exact(p.W)).result());
  const auto row_sums = [](const Bounded& x) { return column_sum(x.transposed()).transposed(); };
  if (p.shape.kind == kBinary) return -row_sums(times(v, visible_bias)) - row_sums(hidden);
  const Bounded difference = v - visible_bias;
  return row_sums(times(0.5 * difference, difference)) - row_sums(hidden);
}

std::vector<MatrixF> clips_of(const CrbmShape& shape) {
  return {frames_of(shape, 9, 1), frames_of(shape, 2, 2), frames_of(shape, 5, 3)};
}

/// Checks every clip's column of numbers: zero before `order`, then what `want` gives for the clip.
template <typename Want>
void check_clips(const Sequences& got, const std::vector<MatrixF>& clips, std::size_t order,
                 Want&& want) {
  CHECK(got.valid_from == order);
  CHECK(padding_is_zero(got.values));
  const std::vector<MatrixF> columns = got.to_host();
  REQUIRE(columns.size() == clips.size());
  for (std::size_t i = 0; i < clips.size(); ++i) {
    CAPTURE(i);
    const auto first = std::min<Eigen::Index>(static_cast<Eigen::Index>(order), clips[i].rows());
    REQUIRE(columns[i].rows() == clips[i].rows());
    CHECK((columns[i].topRows(first).array() == 0.0F).all());
    if (first == clips[i].rows()) continue;
    const Bounded rows = want(i);
    CHECK(misfit(columns[i].bottomRows(clips[i].rows() - first), rows.value, rows.bound) == "");
  }
}

std::string name_of(const CrbmShape& shape) {
  return fmt::format("{} visible, {} hidden, order {}, {}", shape.visible, shape.hidden,
                     shape.order, shape.kind == kGaussian ? "Gaussian" : "binary");
}

}  // namespace

TEST_CASE("small: free energies of every frame that has a history") {
  on_every_device([](Device& device) {
    for (const CrbmShape& shape : kShapes) {
      INFO(name_of(shape));
      const CrbmParameters p = random_crbm(shape, 7, 4.0F);
      const auto clips = clips_of(shape);
      const Sequences got = free_energy(Crbm(device, p), Sequences::from_host(device, clips));
      check_clips(got, clips, shape.order, [&](std::size_t i) {
        const MatrixF history = histories(clips[i], shape.order);
        return energies(p, history, clips[i].bottomRows(history.rows()));
      });
    }
  });
}

TEST_CASE("energies of a clip that is longer than what is taken at once") {
  const CrbmShape shape{3, 2, 1, kBinary};
  const std::vector<MatrixF> clips = {frames_of(shape, 2 * kRowsAtOnce + 4, 1),
                                      frames_of(shape, kRowsAtOnce, 2)};
  on_every_device([&](Device& device) {
    const CrbmParameters p = random_crbm(shape, 7, 4.0F);
    const Crbm crbm(device, p);
    const Sequences visible = Sequences::from_host(device, clips);
    check_clips(free_energy(crbm, visible), clips, shape.order, [&](std::size_t i) {
      const MatrixF history = histories(clips[i], shape.order);
      return energies(p, history, clips[i].bottomRows(history.rows()));
    });
    const MatrixF drawn = pseudo_log_likelihood(crbm, visible, 9).values.to_host();
    CHECK((drawn.topRows(1).array() == 0.0F).all());
    CHECK((drawn.middleRows(1, clips[0].rows() - 1).array() < 0.0F).all());
    CHECK((drawn.bottomRows(clips[1].rows() - 1).array() < 0.0F).all());
  });
}

TEST_CASE("a free energy's bits are the same whatever the vectors' width") {
  on_every_device([](Device& device) {
    const Tuning usual = device.tuning();
    const CrbmShape shape{13, 37, 1, kGaussian};
    const CrbmParameters p = random_crbm(shape, 3, 4.0F);
    const auto clips = clips_of(shape);
    const auto energies_at = [&](int width) {
      Tuning tuning = usual;
      tuning.vector_width = width;
      device.set_tuning(tuning);
      return free_energy(Crbm(device, p), Sequences::from_host(device, clips)).values.to_host();
    };
    const MatrixF wide = energies_at(16);
    for (const int width : {1, 4, 8}) CHECK(energies_at(width) == wide);
    device.set_tuning(usual);
  });
}

TEST_CASE("free energies differ as enumerated log-probabilities do") {
  on_every_device([](Device& device) {
    for (const CrbmShape& shape : {CrbmShape{4, 5, 0, kBinary}, CrbmShape{3, 6, 2, kBinary}}) {
      INFO(name_of(shape));
      const CrbmParameters p = tiny_crbm(shape, 11);
      const MatrixF past = frames_of(shape, shape.order, 5);
      const RowVectorD history = past.cast<double>().reshaped<Eigen::RowMajor>().transpose();
      const MatrixF states =
          reference::all_states(static_cast<Eigen::Index>(shape.visible)).cast<float>();
      // A clip for each state, behind the same history.
      std::vector<MatrixF> clips;
      for (Eigen::Index s = 0; s < states.rows(); ++s) {
        clips.emplace_back(past.rows() + 1, states.cols());
        clips.back() << past, states.row(s);
      }
      const MatrixF energy =
          free_energy(Crbm(device, p), Sequences::from_host(device, clips)).values.to_host();
      const Eigen::VectorXd want =
          reference::visible_distribution(in_double(p), history).array().log();
      CHECK(std::abs(want.array().exp().sum() - 1.0) < 1e-12);
      const auto step = static_cast<Eigen::Index>(shape.order + 1);
      const float zero = energy(step - 1, 0);
      for (Eigen::Index s = 0; s < states.rows(); ++s)
        CHECK(std::abs(zero - energy(s * step + step - 1, 0) - (want(s) - want(0))) < 2e-5);
    }
  });
}

TEST_CASE("small: a stack's free energy is that of its top machine on its code") {
  on_every_device([](Device& device) {
    Cdbn cdbn;
    cdbn.layers.emplace_back(device, random_crbm({5, 7, 2, kGaussian}, 1, 4.0F));
    const CrbmParameters top = random_crbm({7, 3, 1, kBinary}, 2, 4.0F);
    cdbn.layers.emplace_back(device, top);
    const auto clips = clips_of({5, 7, 2, kGaussian});
    const Sequences visible = Sequences::from_host(device, clips);
    const auto codes = up_pass(cdbn.layers.front(), visible).to_host();
    check_clips(free_energy(cdbn, visible), clips, 3, [&](std::size_t i) {
      const MatrixF code = codes[i].bottomRows(codes[i].rows() - 2);
      return energies(top, histories(code, 1), code.bottomRows(code.rows() - 1));
    });
    CHECK_THROWS_AS(free_energy(Cdbn{}, visible), ShapeError);
  });
}

TEST_CASE("small: the pseudo-likelihood flips one drawn unit of each frame") {
  on_every_device([](Device& device) {
    for (const CrbmShape& shape : kShapes) {
      if (shape.kind == kGaussian) continue;
      INFO(name_of(shape));
      constexpr std::uint64_t kSeed = 9;
      const CrbmParameters p = random_crbm(shape, 7, 4.0F);
      const Crbm crbm(device, p);
      const auto clips = clips_of(shape);
      const Sequences visible = Sequences::from_host(device, clips);
      const Sequences got = pseudo_log_likelihood(crbm, visible, kSeed);
      check_clips(got, clips, shape.order, [&](std::size_t i) {
        const MatrixF history = histories(clips[i], shape.order);
        const MatrixF own = clips[i].bottomRows(history.rows());
        MatrixF flipped = own;
        const RandomKey key{kSeed, 0, random_streams::kFlippedUnits, 0};
        for (Eigen::Index r = 0; r < own.rows(); ++r) {
          const std::size_t row =
              visible.clips[i].first + shape.order + static_cast<std::size_t>(r);
          const auto unit = random_bits(key, static_cast<std::uint32_t>(row), 0) % shape.visible;
          flipped(r, unit) = 1.0F - flipped(r, unit);
        }
        const Bounded against = energies(p, history, own) - energies(p, history, flipped);
        return -static_cast<double>(shape.visible) * softplus(against);
      });
      CHECK((got.values.to_host().array() <= 0.0F).all());
    }
    const CrbmShape gaussian{3, 2, 0, kGaussian};
    CHECK_THROWS_AS(pseudo_log_likelihood(Crbm(device, random_crbm(gaussian, 1, 4.0F)),
                                          Sequences::from_host(device, clips_of(gaussian)), 1),
                    ShapeError);
  });
}

TEST_CASE("the pseudo-likelihood's mean over draws is that of enumeration") {
  on_every_device([](Device& device) {
    const CrbmShape shape{5, 4, 0, kBinary};
    const CrbmParameters p = tiny_crbm(shape, 21);
    const MatrixF states = reference::all_states(5).cast<float>();
    const Eigen::VectorXd logs =
        reference::visible_distribution(in_double(p), MatrixD(1, 0)).array().log();
    double want = 0;  // Σ_i log p(v_i | the others), a mean over the states
    for (Eigen::Index s = 0; s < states.rows(); ++s)
      for (int i = 0; i < 5; ++i) want += -reference::softplus(logs(s ^ (1 << i)) - logs(s)) / 32.0;
    constexpr std::size_t kCopies = 500;
    const Sequences data = Sequences::from_host(device, {MatrixF(states.replicate(kCopies, 1))});
    const Eigen::ArrayXd got =
        pseudo_log_likelihood(Crbm(device, p), data, 4).values.to_host().col(0).cast<double>();
    const double mean = got.mean(), count = static_cast<double>(got.size());
    const double error = std::sqrt((got - mean).square().sum() / count / count);
    CHECK(std::abs(mean - want) < 4.0 * error);
    CHECK(error < 0.01 * std::abs(want));
  });
}

TEST_CASE("free energy: frames that do not fit are refused") {
  on_every_device([](Device& device) {
    const Crbm crbm(device, random_crbm({5, 3, 0, kBinary}, 1, 4.0F));
    CHECK_THROWS_AS(free_energy(crbm, Sequences::from_host(device, {MatrixF::Zero(2, 4)})),
                    ShapeError);
  });
}

}  // namespace energy_test
