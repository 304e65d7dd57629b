#include "machines/regeneration_reference.hpp"

#include <algorithm>

#include "mcdbn/base/random.hpp"

namespace mcdbn::reference {
namespace {

enum class Draw { bernoulli, gaussian, concrete };

constexpr std::uint16_t kDecoderStream = 200, kMrbmStream = 201;

template <typename Number>
MatrixD numbers(const RandomKey& key, const MatrixD& shape, Number&& number) {
  MatrixD values(shape.rows(), shape.cols());
  for (Eigen::Index r = 0; r < values.rows(); ++r)
    for (Eigen::Index c = 0; c < values.cols(); ++c)
      values(r, c) = number(key, static_cast<std::uint32_t>(r), static_cast<std::uint32_t>(c));
  return values;
}

/// mean + share · (draw − mean)
Bounded drawn(const Bounded& mean, Draw kind, double share, const RandomKey& key) {
  if (share == 0.0) return mean;
  if (kind == Draw::gaussian)
    return tempered(mean, gaussian(mean, numbers(key, mean.value, random_normal)), share);
  const MatrixD uniform = numbers(key, mean.value, random_uniform);
  return tempered(
      mean, kind == Draw::bernoulli ? bernoulli(mean, uniform) : concrete(mean, uniform), share);
}

/// bias + Σ over the order of the frames before frame t, weighted (eq 16, 17). One sum with what
/// the other layer adds: the device may store it and go on from there.
Sum dynamic_bias(const Frames& frames, std::size_t t, const MatrixF& weights, const MatrixF& bias,
                 const CrbmShape& shape) {
  const auto units = static_cast<Eigen::Index>(shape.visible);
  Sum sum;
  sum.add(exact(bias.replicate(frames[t].value.rows(), 1)));
  for (std::size_t q = 0; q < shape.order; ++q)
    sum.add_product(frames[t - shape.order + q],
                    exact(weights.middleRows(static_cast<Eigen::Index>(q) * units, units)));
  return sum;
}

Bounded activated(const Bounded& input, VisibleKind kind) {
  return kind == VisibleKind::binary ? sigmoid(input) : input;
}

/// eq 10 (eq 6 for binary units) with eq 16.
Bounded visible_means(const CrbmParameters& p, Sum visible_bias, const Bounded& above) {
  return activated(visible_bias.add_product(above, exact(p.W).transposed()).result(), p.shape.kind);
}

/// k times the units below and the top ones, drawn; then the means below.
Bounded sampled_frame(const CrbmParameters& p, const Frames& below, const Bounded& code,
                      std::size_t t, const DrawRule& rule) {
  const Sum visible_bias = dynamic_bias(below, t, p.A, p.a, p.shape);
  const Sum hidden_bias = dynamic_bias(below, t, p.B, p.b, p.shape);
  const Draw kind = p.shape.kind == VisibleKind::binary ? Draw::bernoulli : Draw::gaussian;
  Bounded top = code;
  RandomKey key{rule.seed, static_cast<std::uint32_t>(t), kDecoderStream, 0};
  for (std::size_t k = 0; k < rule.gibbs_steps; ++k) {
    const Bounded visible = drawn(visible_means(p, visible_bias, top), kind, rule.share, key);
    ++key.phase;
    top = drawn(sigmoid(Sum(hidden_bias).add_product(visible, exact(p.W)).result()),
                Draw::bernoulli, rule.share, key);
    ++key.phase;
  }
  return visible_means(p, visible_bias, top);
}

/// The frame-by-frame codes of one sequence, through every layer (eq 11 with eq 17).
Frames codes(const std::vector<CrbmParameters>& layers, Frames frames) {
  std::size_t first = 0;
  for (const CrbmParameters& p : layers) {
    first += p.shape.order;
    Frames code(frames.size());
    for (std::size_t t = first; t < frames.size(); ++t)
      code[t] = sigmoid(
          dynamic_bias(frames, t, p.B, p.b, p.shape).add_product(frames[t], exact(p.W)).result());
    frames = std::move(code);
  }
  return frames;
}

/// The 3D code from the 2D code (eq 32 and 33, or eq 21 to 23), all sequences a row each.
Bounded pose_code(const Network& network, const Bounded& track_code, const DrawRule& rule,
                  std::uint32_t step) {
  const bool draws = rule.share > 0.0 && rule.mrbm_gibbs_steps > 0;
  const std::size_t steps =
      draws ? rule.mrbm_gibbs_steps : std::max<std::size_t>(network.mean_field_steps, 1);
  const Draw kind = rule.steady ? Draw::concrete : Draw::bernoulli;
  const double share = draws ? rule.share : 0.0;
  RandomKey key{rule.seed, rule.steady ? 0U : step, kMrbmStream, 0};
  const MrbmParameters& p = network.mrbm;
  const Bounded W = exact(p.W[1]);
  const Sum present_input = Sum().add_product(track_code, exact(p.W[0])).add_row(exact(p.b));
  Bounded units = Bounded::exact(MatrixD::Zero(track_code.value.rows(), p.W[1].rows())), means;
  for (std::size_t k = 0; k < steps; ++k) {
    const Bounded hidden =
        drawn(sigmoid(Sum(present_input).add_product(units, W).result()), kind, share, key);
    ++key.phase;
    means = sigmoid(Sum().add_product(hidden, W.transposed()).add_row(exact(p.a[1])).result());
    units = drawn(means, kind, share, key);
    ++key.phase;
  }
  return means;
}

/// The first frame repeated, the track, and its end turned about its last frame.
Frames extended(const MatrixF& track, std::size_t lead, std::size_t frames) {
  Frames result;
  const Eigen::Index last = track.rows() - 1;
  for (std::size_t t = 0; t < frames; ++t) {
    const Eigen::Index at = static_cast<Eigen::Index>(t) - static_cast<Eigen::Index>(lead);
    if (at <= last) {
      result.push_back(exact(track.row(std::max<Eigen::Index>(at, 0))));
      continue;
    }
    const MatrixF mirrored = track.row(std::max<Eigen::Index>(2 * last - at, 0));
    result.push_back(exact(MatrixF(2.0F * track.row(last) - mirrored)));
  }
  return result;
}

std::size_t sum_of_orders(const std::vector<CrbmParameters>& layers) {
  std::size_t sum = 0;
  for (const CrbmParameters& p : layers) sum += p.shape.order;
  return sum;
}

std::size_t largest_order(const std::vector<CrbmParameters>& layers) {
  std::size_t largest = 0;
  for (const CrbmParameters& p : layers) largest = std::max(largest, p.shape.order);
  return largest;
}

/// Frame t of every sequence, each so many times, one below another.
Bounded rows_at(const std::vector<Frames>& sequences, std::size_t t, std::size_t copies) {
  const auto rows = static_cast<Eigen::Index>(sequences.size() * copies);
  Bounded all{MatrixD(rows, sequences[0][t].value.cols()),
              MatrixD(rows, sequences[0][t].value.cols())};
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Bounded& one = sequences[static_cast<std::size_t>(row) / copies][t];
    all.value.row(row) = one.value;
    all.bound.row(row) = one.bound;
  }
  return all;
}

}  // namespace

Frames decoded(const std::vector<CrbmParameters>& layers, const Frames& code, std::size_t first,
               std::size_t last, const DrawRule& rule) {
  const Eigen::Index sequences = code[first].value.rows();
  Frames above = code;
  for (std::size_t i = layers.size(); i-- > 0;) {
    const CrbmParameters& p = layers[i];
    const bool samples = i + 1 == layers.size() && rule.share > 0.0 && rule.gibbs_steps > 0;
    Frames below(code.size(), exact(p.visible_mean.replicate(sequences, 1)));
    for (std::size_t t = first; t < last; ++t)
      below[t] = samples ? sampled_frame(p, below, above[t], t, rule)
                         : visible_means(p, dynamic_bias(below, t, p.A, p.a, p.shape), above[t]);
    above = std::move(below);
  }
  return above;
}

std::vector<Bounded> regenerated(const Network& network, const std::vector<MatrixF>& tracks,
                                 std::size_t samples, std::size_t run_in, const DrawRule& rule) {
  std::size_t longest = 0;
  for (const MatrixF& track : tracks)
    longest = std::max(longest, static_cast<std::size_t>(track.rows()));
  const std::size_t start = std::max(sum_of_orders(network.track), largest_order(network.pose));
  const std::size_t lead = start + run_in, end = lead + longest;
  std::vector<Frames> track_codes;
  for (const MatrixF& track : tracks)
    track_codes.push_back(codes(network.track, extended(track, lead, end + network.look_ahead)));
  Frames code(end);
  for (std::size_t t = start; t < end; ++t)
    code[t] = pose_code(network, rows_at(track_codes, t + network.look_ahead, samples), rule,
                        static_cast<std::uint32_t>(t));
  const Frames visible = decoded(network.pose, code, start, end, rule);
  std::vector<Bounded> result;
  for (std::size_t i = 0; i < tracks.size() * samples; ++i) {
    const Eigen::Index frames = tracks[i / samples].rows(), columns = visible[lead].value.cols();
    Bounded one{MatrixD(frames, columns), MatrixD(frames, columns)};
    for (Eigen::Index t = 0; t < frames; ++t) {
      const Bounded& at = visible[lead + static_cast<std::size_t>(t)];
      one.value.row(t) = at.value.row(static_cast<Eigen::Index>(i));
      one.bound.row(t) = at.bound.row(static_cast<Eigen::Index>(i));
    }
    result.push_back(std::move(one));
  }
  return result;
}

}  // namespace mcdbn::reference
