#include "machines/generation_reference.hpp"

#include "mcdbn/base/random.hpp"

namespace mcdbn::reference {
namespace {

/// bias + Σ over the moments before moment t that the weights see, weighted (eq 16, 17).
Sum dynamic_bias(const Moments& visible, std::size_t t, const CrbmParameters& p,
                 const MatrixF& weights, const MatrixF& bias) {
  const auto units = static_cast<Eigen::Index>(p.shape.visible);
  Sum sum;
  sum.add(exact(bias.replicate(visible.back().value.rows(), 1)));
  const Eigen::Index order = weights.rows() / units;
  for (Eigen::Index q = 0; q < order; ++q)
    sum.add_product(visible[t - static_cast<std::size_t>(order - q)],
                    exact(weights.middleRows(q * units, units)));
  return sum;
}

/// eq 11
Bounded hidden_means(const CrbmParameters& p, Sum bias, const Bounded& visible) {
  return sigmoid(bias.add_product(visible, exact(p.W)).result());
}

/// eq 10, or eq 6
Bounded visible_means(const CrbmParameters& p, Sum bias, const Bounded& hidden) {
  const Bounded input = bias.add_product(hidden, exact(p.W).transposed()).result();
  return p.shape.kind == VisibleKind::binary ? sigmoid(input) : input;
}

Bounded drawn(const Bounded& mean, double temperature, const RandomKey& key) {
  if (temperature == 0.0) return mean;
  MatrixD uniform(mean.value.rows(), mean.value.cols());
  for (Eigen::Index r = 0; r < uniform.rows(); ++r)
    for (Eigen::Index c = 0; c < uniform.cols(); ++c)
      uniform(r, c) =
          random_uniform(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
  return tempered(mean, bernoulli(mean, uniform), temperature);
}

/// σ of the lowest layer's units, a row for each sequence.
Bounded deviations(const CrbmParameters& p, std::size_t sequences) {
  return exact(p.visible_deviation.replicate(static_cast<Eigen::Index>(sequences), 1));
}

/// The last frames of each seed, each seed so many times, over σ.
Moments moments_of(const CrbmParameters& p, const std::vector<MatrixF>& seeds, std::size_t frames,
                   std::size_t samples) {
  Moments moments;
  for (std::size_t t = 0; t < frames; ++t) {
    MatrixF rows(seeds.size() * samples, seeds[0].cols());
    for (Eigen::Index row = 0; row < rows.rows(); ++row) {
      const MatrixF& seed = seeds[static_cast<std::size_t>(row) / samples];
      rows.row(row) = seed.row(seed.rows() - static_cast<Eigen::Index>(frames - t));
    }
    moments.push_back(quotient(exact(rows), deviations(p, seeds.size() * samples)));
  }
  return moments;
}

}  // namespace

void run_freely(const CrbmParameters& p, Moments& visible, const GenerationOptions& options) {
  for (std::size_t i = 0; i < options.frames; ++i) {
    const std::size_t t = visible.size();
    const Sum visible_bias = dynamic_bias(visible, t, p, p.A, p.a);
    const Sum hidden_bias = dynamic_bias(visible, t, p, p.B, p.b);
    Bounded now = visible.back();
    for (std::size_t k = 0; k <= options.gibbs_steps; ++k) {
      const RandomKey key{options.seed, static_cast<std::uint32_t>(i), 206,
                          static_cast<std::uint16_t>(k)};
      Bounded hidden = hidden_means(p, hidden_bias, now);
      if (k < options.gibbs_steps) hidden = drawn(hidden, options.temperature, key);
      now = visible_means(p, visible_bias, hidden);
    }
    visible.push_back(now);
  }
}

std::vector<Bounded> generated(const std::vector<CrbmParameters>& layers,
                               const std::vector<MatrixF>& seeds,
                               const GenerationOptions& options) {
  std::size_t orders = 0;
  for (const CrbmParameters& p : layers) orders += p.shape.order;
  // A top layer without history still starts from a frame.
  const std::size_t given = orders + (layers.back().shape.order == 0 ? 1 : 0);
  std::vector<Moments> visible{moments_of(layers[0], seeds, given, options.samples)};
  std::size_t first = 0;  // that has a code
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) {
    const CrbmParameters& p = layers[i];
    first += p.shape.order;
    Moments code(given);
    for (std::size_t t = first; t < given; ++t)
      code[t] = hidden_means(p, dynamic_bias(visible[i], t, p, p.B, p.b), visible[i][t]);
    visible.push_back(std::move(code));
  }
  run_freely(layers.back(), visible.back(), options);
  for (std::size_t i = layers.size() - 1; i-- > 0;)
    for (std::size_t t = given; t < given + options.frames; ++t)
      visible[i].push_back(
          visible_means(layers[i], dynamic_bias(visible[i], t, layers[i], layers[i].A, layers[i].a),
                        visible[i + 1][t]));
  for (Bounded& moment : visible[0])
    moment = times(moment, deviations(layers[0], seeds.size() * options.samples));
  std::vector<Bounded> result;
  for (std::size_t row = 0; row < seeds.size() * options.samples; ++row) {
    const auto frames = static_cast<Eigen::Index>(options.frames);
    Bounded one{MatrixD(frames, seeds[0].cols()), MatrixD(frames, seeds[0].cols())};
    for (Eigen::Index t = 0; t < frames; ++t) {
      const Bounded& at = visible[0][given + static_cast<std::size_t>(t)];
      one.value.row(t) = at.value.row(static_cast<Eigen::Index>(row));
      one.bound.row(t) = at.bound.row(static_cast<Eigen::Index>(row));
    }
    result.push_back(std::move(one));
  }
  return result;
}

}  // namespace mcdbn::reference
