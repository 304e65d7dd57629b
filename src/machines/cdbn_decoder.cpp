#include "machines/cdbn_decoder.hpp"

#include <algorithm>

#include "base/random_streams.hpp"
#include "device/pointwise.hpp"
#include "machines/own_units.hpp"
#include "machines/unit_kinds.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::vector<Matrix> at_training_mean(const Cdbn& cdbn, std::size_t rows) {
  std::vector<Matrix> states;
  for (const Crbm& layer : cdbn.layers)
    states.push_back(Matrix::filled_with_row(in_own_units(layer, layer.visible_mean), rows));
  return states;
}

}  // namespace

CdbnDecoder::CdbnDecoder(const Cdbn& cdbn, const Matrix& code, std::size_t sequences)
    : CdbnDecoder(cdbn, code, sequences, at_training_mean(cdbn, code.rows())) {}

CdbnDecoder::CdbnDecoder(const Cdbn& cdbn, const Matrix& code, std::size_t sequences,
                         std::vector<Matrix> states)
    : cdbn_(cdbn),
      code_(code),
      sequences_(sequences),
      frames_(sequences ? code.rows() / sequences : 0),
      states_(std::move(states)) {
  if (sequences == 0 || code.rows() % sequences != 0 || code.columns() != cdbn.code_dimension())
    throw ShapeError("decoder: the code does not fit the CDBN");
  if (states_.size() != cdbn.layers.size()) throw ShapeError("decoder: rows for other layers");
  for (std::size_t i = 0; i < states_.size(); ++i)
    if (states_[i].rows() != code.rows() || states_[i].columns() != cdbn.layers[i].shape().visible)
      throw ShapeError("decoder: the visible rows do not fit the CDBN");
}

void CdbnDecoder::decode(std::size_t first, std::size_t last, const RegenerationOptions& options,
                         bool fused) {
  for (const Crbm& layer : cdbn_.layers)
    if (first < layer.shape().order) throw ShapeError("decoder: the first frame has no history");
  const bool sampled = options.samples_decoder();
  last = std::min(last, frames_);
  if (first >= last) return;
  const auto tiles = fused ? fused_tiles(sampled) : std::nullopt;
  if (tiles)
    fused_decode(first, last, options, *tiles);
  else
    decode_frames(first, last, options, sampled);
  const Crbm& lowest = cdbn_.layers.front();
  if (!lowest.has_deviation) return;
  for (std::size_t i = 0; i < sequences_; ++i)
    scale_columns(Rows(states_.front(), i * frames_ + first, last - first),
                  lowest.visible_deviation);
}

void CdbnDecoder::decode_frames(std::size_t first, std::size_t last,
                                const RegenerationOptions& options, bool sampled) {
  if (!sampled) set_input_from_above(states_.size() - 1, first, last);
  for (std::size_t frame = first; frame < last; ++frame) {
    if (sampled) sample_top_layer(frame, options);
    down_pass(frame, !sampled);
  }
}

void CdbnDecoder::set_input_from_above(std::size_t layer, std::size_t first, std::size_t last) {
  const Crbm& crbm = cdbn_.layers[layer];
  const bool is_top = layer + 1 == cdbn_.layers.size();
  GemmOptions from_above;
  from_above.bias = &crbm.a;
  for (std::size_t i = 0; i < sequences_; ++i) {
    const std::size_t begin = i * frames_ + first;
    gemm(Rows(is_top ? code_ : states_[layer + 1], begin, last - first), crbm.W_transposed,
         Rows(states_[layer], begin, last - first), from_above);
  }
}

void CdbnDecoder::down_pass(std::size_t frame, bool top_has_input) {
  for (std::size_t i = cdbn_.layers.size(); i-- > 0;) {
    const Crbm& layer = cdbn_.layers[i];
    const Rows state = at(states_[i], frame);
    const bool is_top = i + 1 == cdbn_.layers.size();
    if (is_top && !top_has_input) continue;  // sampled already
    GemmOptions options;
    if (is_top) {
      // The state holds a + code·Wᵀ: what is left is the history's part.
      options.beta = 1.0F;
      options.activation = activation_of(layer.shape().kind);
      gemm(layer.history_for_A(state), layer.A, state, options);
      continue;
    }
    options.bias = &layer.a;
    gemm(layer.history_for_A(state), layer.A, state, options);
    GemmOptions from_above;
    from_above.beta = 1.0F;
    from_above.activation = activation_of(layer.shape().kind);
    gemm(at(states_[i + 1], frame), layer.W_transposed, state, from_above);
  }
}

void CdbnDecoder::sample_top_layer(std::size_t frame, const RegenerationOptions& options) {
  const Crbm& top = cdbn_.layers.back();
  if (top_.empty()) {
    for (Matrix* matrix : {&top_, &top_sample_, &top_bias_})
      *matrix = Matrix(top.device(), sequences_, top.shape().hidden);
    for (Matrix* matrix : {&below_sample_, &below_bias_})
      *matrix = Matrix(top.device(), sequences_, top.shape().visible);
  }
  const Rows state = at(states_.back(), frame);
  const Rows below_sample(below_sample_), top_sample(top_sample_);
  top.dynamic_visible_bias(state, below_bias_);
  top.dynamic_hidden_bias(state, top_bias_);
  RandomKey key{options.seed, static_cast<std::uint32_t>(frame), random_streams::kDecoder, 0};
  GemmOptions down = mean_of_units(top.shape().kind), up = mean_of_units(VisibleKind::binary);
  down.bias = &below_bias_;
  down.sampling = sampling_of(top.shape().kind);
  down.sample = &below_sample;
  up.bias = &top_bias_;
  up.sampling = Sampling::bernoulli;
  up.sample = &top_sample;
  down.temperature = up.temperature = static_cast<float>(options.drawn_share());
  for (std::size_t k = 0; k < options.sampling.gibbs_steps; ++k) {
    key.phase = static_cast<std::uint16_t>(2 * k);
    down.random = key;
    gemm(k == 0 ? at(code_, frame) : top_sample, top.W_transposed, state, down);
    key.phase = static_cast<std::uint16_t>(2 * k + 1);
    up.random = key;
    gemm(below_sample, top.W, top_, up);
  }
  // The state keeps the last means: the down-pass below is mean field (Algorithm 5, line 7).
  GemmOptions last = down;
  last.sampling = Sampling::none;
  last.sample = nullptr;
  gemm(top_sample, top.W_transposed, state, last);
}

}  // namespace mcdbn
