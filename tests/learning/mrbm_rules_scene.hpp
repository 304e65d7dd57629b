#pragma once

#include <doctest/doctest.h>

#include <numeric>

#include "learning/learning_rule.hpp"
#include "learning/within_bounds.hpp"
#include "mcdbn/learning/mrbm_settings.hpp"
#include "reference/loss_error_bound.hpp"
#include "reference/units_reference.hpp"
#include "reference/update_error_bound.hpp"

// Small MRBMs with data, and the chains of their rules in double precision with their own draws
// and bounds on what single precision makes of them.
namespace mcdbn::test {

constexpr VisibleKind kBinary = VisibleKind::binary, kGaussian = VisibleKind::gaussian;
constexpr RandomKey kKey{5, 9, 40, 0};

struct Scene {
  Scene(const std::vector<std::pair<std::size_t, VisibleKind>>& modalities, std::size_t hidden,
        std::size_t rows, float scale = 0.7F) {
    MrbmShape shape{{}, hidden};
    for (const auto& [visible, kind] : modalities)
      shape.modalities.push_back({std::to_string(shape.modalities.size()), visible, kind});
    start = MrbmParameters::zeros(shape);
    unsigned seed = 11;
    for (std::size_t m = 0; m < modalities.size(); ++m) {
      const auto& [visible, kind] = modalities[m];
      start.W[m] = random_matrix(visible, hidden, ++seed, scale);
      start.a[m] = random_matrix(1, visible, ++seed, 0.5F);
      const MatrixF drawn = random_matrix(rows, visible, ++seed);
      codes.push_back(kind == kGaussian ? drawn
                                        : MatrixF((0.5F * (drawn.array() + 1.0F)).matrix()));
    }
    start.b = random_matrix(1, hidden, ++seed, 0.5F);
    model = in_double(start);
  }
  std::size_t rows() const { return static_cast<std::size_t>(codes[0].rows()); }

  MrbmParameters start;
  std::vector<MatrixF> codes;
  reference::Mrbm model;
};

/// Sums of a gradient's terms over chains, of which the mean is taken.
struct GradientSums {
  std::vector<reference::Sum> W, a;
  reference::Sum b;

  explicit GradientSums(std::size_t modalities) : W(modalities), a(modalities) {}
  reference::BoundedMrbm mean(std::size_t rows) {
    const auto count = static_cast<double>(rows);
    reference::BoundedMrbm result;
    for (std::size_t m = 0; m < W.size(); ++m) {
      result.weights.push_back(W[m].divide(count).result());
      result.visible_bias.push_back(a[m].divide(count).result());
    }
    result.hidden_bias = b.divide(count).result();
    return result;
  }
};

/// Chains in double precision beside bounds on the device's error. Rounding must decide no draw:
/// its chain would be left without a useful bound.
struct ReferenceChain {
  using Bounded = reference::Bounded;
  using Sum = reference::Sum;

  MrbmSettings settings;
  reference::BoundedMrbm model;
  Bounded hidden_data, hidden, sample;
  std::vector<Bounded> data, end;

  ReferenceChain(const Scene& of, const MrbmSettings& with)
      : ReferenceChain(of, with, reference::BoundedMrbm::exact(of.model)) {}
  /// @param start what a training has made of the scene's model
  ReferenceChain(const Scene& of, const MrbmSettings& with, reference::BoundedMrbm start)
      : settings(with), model(std::move(start)) {
    for (const MatrixF& code : of.codes) data.push_back(Bounded::exact(code.cast<double>()));
  }

  static Bounded drawn(const Bounded& p, const RandomKey& key) {
    const Bounded draws = reference::bernoulli(p, numbers(p.value, key, random_uniform));
    REQUIRE(draws.bound.maxCoeff() == 0.0);
    return draws;
  }
  Bounded hidden_input(const std::vector<Bounded>& units) const {
    Sum input;
    for (std::size_t m = 0; m < units.size(); ++m) input.add_product(units[m], model.weights[m]);
    return input.add_row(model.hidden_bias).result();
  }
  Bounded visible_of(std::size_t m, const RandomKey& key) const {
    const Bounded input = Sum()
                              .add_product(sample, model.weights[m].transposed())
                              .add_row(model.visible_bias[m])
                              .result();
    const Bounded mean = model.gaussian[m] ? input : reference::sigmoid(input);
    if (!settings.sample_visible) return mean;
    if (!model.gaussian[m]) return drawn(mean, key);
    return reference::gaussian(mean, numbers(mean.value, key, random_normal));
  }

  /// The codes, 0 or 1 as their probabilities have it.
  void draw_data(RandomKey key) {
    for (std::size_t m = 0; m < data.size(); ++m) {
      key.phase = static_cast<std::uint16_t>(0x1000 + m);
      if (!model.gaussian[m]) data[m] = drawn(data[m], key);
    }
  }
  void start(const RandomKey& key) {
    hidden_data = reference::sigmoid(hidden_input(data));
    sample = drawn(hidden_data, key);
  }
  void run(const std::vector<std::size_t>& free, const RandomKey& key, bool draw_last = false) {
    end = data;
    for (std::size_t k = 1; k <= settings.gibbs_steps; ++k) {
      for (const std::size_t m : free) {
        RandomKey own = key;
        own.phase = static_cast<std::uint16_t>(0x1000 + k * data.size() + m);
        end[m] = visible_of(m, own);
      }
      hidden = reference::sigmoid(hidden_input(end));
      RandomKey own = key;
      own.phase = static_cast<std::uint16_t>(k);
      if (k < settings.gibbs_steps || draw_last) sample = drawn(hidden, own);
    }
  }
  /// Every modality is free.
  void run_all(const RandomKey& key, bool draw_last = false) {
    std::vector<std::size_t> all(data.size());
    std::iota(all.begin(), all.end(), 0);
    run(all, key, draw_last);
  }
  /// Adds what these rows give. @param rows 1 for each that counts, else 0; none: all
  void add_to(GradientSums& sums, const Eigen::VectorXd& rows = {}) const {
    const auto of_rows = [&](const Bounded& x) {
      if (rows.size() == 0) return x;
      return Bounded{rows.asDiagonal() * x.value, rows.asDiagonal() * x.bound};
    };
    const Bounded h_end = of_rows(hidden), h_data = of_rows(hidden_data);
    for (std::size_t m = 0; m < data.size(); ++m) {
      sums.W[m].add_product(end[m].transposed(), h_end);
      sums.W[m].add_product(-data[m].transposed(), h_data);
      sums.a[m].add_column_sum(of_rows(end[m])).add_column_sum(-of_rows(data[m]));
    }
    sums.b.add_column_sum(h_end).add_column_sum(-h_data);
  }
  /// The gradient of all rows of this chain alone.
  reference::BoundedMrbm gradient() const {
    GradientSums sums(data.size());
    add_to(sums);
    return sums.mean(static_cast<std::size_t>(hidden.value.rows()));
  }
  /// Mean squared error of modality m's reconstruction. [1 x 1]
  Bounded loss(std::size_t m) const {
    return divided(reference::squared_error(end[m], data[m]),
                   static_cast<double>(data[m].value.size()));
  }
  /// What of the free energy changes with modality m.
  Eigen::VectorXd energy(std::size_t m, const std::vector<Bounded>& units) const {
    const Eigen::VectorXd hidden_part =
        -reference::softplus(hidden_input(units).value).rowwise().sum();
    const RowVectorD bias = model.visible_bias[m].value;
    if (!model.gaussian[m]) return hidden_part - units[m].value * bias.transpose();
    return hidden_part + 0.5 * (units[m].value.rowwise() - bias).rowwise().squaredNorm();
  }

 private:
  /// Random numbers in the shape of `like`.
  template <typename Draw>
  static MatrixD numbers(const MatrixD& like, const RandomKey& key, const Draw& draw) {
    return MatrixD::NullaryExpr(like.rows(), like.cols(), [&](auto r, auto c) -> double {
      return draw(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
    });
  }
};

/// Runs `rule` on all rows, `steps` times, each with the next key. @return its last losses
inline std::vector<float> run(Device& device, const Scene& scene, LearningRule& rule,
                              int steps = 1) {
  std::vector<Matrix> codes;
  for (const MatrixF& code : scene.codes) codes.push_back(Matrix::from_host(device, code));
  std::vector<std::int32_t> all(scene.rows());
  std::iota(all.begin(), all.end(), 0);
  const IndexBuffer index(device, all);
  std::vector<Rows> rows;
  for (const Matrix& code : codes) rows.push_back(Rows::indexed(code, index, 0, scene.rows()));
  LossAccumulator losses(device, rule.loss_count(), scene.rows());
  LearningStep step{1, 0.0, kKey};
  for (int i = 0; i < steps; ++i, ++step.random.step) {
    losses.read_and_reset();
    rule.learn(rows, step, losses);
  }
  return losses.read_and_reset();
}

inline const Scene& two() {
  static const Scene scene({{4, kBinary}, {3, kBinary}}, 5, 7);
  return scene;
}
inline const Scene& three() {
  static const Scene scene({{3, kBinary}, {4, kGaussian}, {2, kBinary}}, 4, 9);
  return scene;
}

}  // namespace mcdbn::test
