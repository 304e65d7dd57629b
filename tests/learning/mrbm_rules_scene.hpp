#pragma once

#include <doctest/doctest.h>

#include <numeric>

#include "learning/learning_rule.hpp"
#include "learning/within_bounds.hpp"
#include "reference/units_reference.hpp"

// Small MRBMs with data, and the chains of their rules in double precision with their own draws.
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

/// Chains in double precision. The smallest distance of a probability from its uniform number says
/// whether rounding could decide a draw.
struct ReferenceChain {
  const Scene& scene;
  const MrbmSettings& settings;
  double closest = 1.0;
  MatrixD hidden_data, hidden, sample;
  std::vector<MatrixD> data, end;

  ReferenceChain(const Scene& of, const MrbmSettings& with) : scene(of), settings(with) {
    for (const MatrixF& code : of.codes) data.push_back(code.cast<double>());
  }

  MatrixD drawn(const MatrixD& p, RandomKey key) {
    MatrixD result(p.rows(), p.cols());
    for (Eigen::Index r = 0; r < p.rows(); ++r)
      for (Eigen::Index c = 0; c < p.cols(); ++c) {
        const double u =
            random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
        closest = std::min(closest, std::abs(u - p(r, c)));
        result(r, c) = u < p(r, c) ? 1.0 : 0.0;
      }
    return result;
  }
  MatrixD hidden_of(const std::vector<MatrixD>& units) const {
    MatrixD input = scene.model.hidden_bias.replicate(units[0].rows(), 1);
    for (std::size_t m = 0; m < units.size(); ++m) input += units[m] * scene.model.weights[m];
    return reference::sigmoid(input);
  }
  MatrixD visible_of(std::size_t m, RandomKey key) {
    const MatrixD input = reference::plus_row(sample * scene.model.weights[m].transpose(),
                                              scene.model.visible_bias[m]);
    const MatrixD mean = scene.model.is_gaussian(m) ? input : reference::sigmoid(input);
    if (!settings.sample_visible) return mean;
    if (!scene.model.is_gaussian(m)) return drawn(mean, key);
    return mean + MatrixD::NullaryExpr(mean.rows(), mean.cols(), [&](auto r, auto c) {
             return random_normal(key, static_cast<std::uint32_t>(r),
                                  static_cast<std::uint32_t>(c));
           });
  }

  /// The codes, 0 or 1 as their probabilities have it.
  void draw_data(RandomKey key) {
    for (std::size_t m = 0; m < data.size(); ++m) {
      key.phase = static_cast<std::uint16_t>(0x1000 + m);
      if (!scene.model.is_gaussian(m)) data[m] = drawn(data[m], key);
    }
  }
  void start(const RandomKey& key) {
    hidden_data = hidden_of(data);
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
      hidden = hidden_of(end);
      RandomKey own = key;
      own.phase = static_cast<std::uint16_t>(k);
      if (k < settings.gibbs_steps || draw_last) sample = drawn(hidden, own);
    }
  }
  /// Adds what rows of these weights give.
  void add(const Eigen::VectorXd& weights, reference::Mrbm& gradient) const {
    const MatrixD h_end = weights.asDiagonal() * hidden,
                  h_data = weights.asDiagonal() * hidden_data;
    for (std::size_t m = 0; m < data.size(); ++m) {
      gradient.weights[m] += end[m].transpose() * h_end - data[m].transpose() * h_data;
      gradient.visible_bias[m] += weights.transpose() * (end[m] - data[m]);
    }
    gradient.hidden_bias += (h_end - h_data).colwise().sum();
  }
  /// What of the free energy changes with modality m.
  Eigen::VectorXd energy(std::size_t m, const std::vector<MatrixD>& units) const {
    MatrixD input = scene.model.hidden_bias.replicate(units[0].rows(), 1);
    for (std::size_t i = 0; i < units.size(); ++i) input += units[i] * scene.model.weights[i];
    const Eigen::VectorXd hidden_part = -(1.0 + input.array().exp()).log().matrix().rowwise().sum();
    if (!scene.model.is_gaussian(m))
      return hidden_part - units[m] * scene.model.visible_bias[m].transpose();
    return hidden_part +
           0.5 * (units[m].rowwise() - scene.model.visible_bias[m]).rowwise().squaredNorm();
  }
};

inline reference::Mrbm zeros_like(const reference::Mrbm& model) {
  return model.with_parameters(Eigen::VectorXd::Zero(model.flattened().size()));
}

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

inline void check_close(const MrbmParameters& got, const reference::Mrbm& want) {
  for (std::size_t m = 0; m < got.W.size(); ++m) {
    CAPTURE(m);
    CHECK((got.W[m].cast<double>() - want.weights[m]).cwiseAbs().maxCoeff() < 2e-6);
    CHECK((got.a[m].cast<double>() - want.visible_bias[m]).cwiseAbs().maxCoeff() < 2e-6);
  }
  CHECK((got.b.cast<double>() - want.hidden_bias).cwiseAbs().maxCoeff() < 2e-6);
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
