#include "machines/gibbs_chain.hpp"

#include "machines/unit_kinds.hpp"

namespace mcdbn {
namespace {

GemmOptions hidden_units(const Matrix& bias) {
  GemmOptions options = mean_of_units(VisibleKind::binary);
  options.bias = &bias;
  return options;
}

GemmOptions visible_units(const Crbm& crbm, const Matrix& bias) {
  GemmOptions options = mean_of_units(crbm.shape().kind);
  options.bias = &bias;
  return options;
}

}  // namespace

GibbsChain::GibbsChain(const Crbm& crbm, std::size_t rows)
    : crbm_(crbm),
      visible_bias_(crbm.device(), rows, crbm.shape().visible),
      hidden_bias_(crbm.device(), rows, crbm.shape().hidden),
      visible_mean_(Matrix::like(visible_bias_)),
      hidden_(Matrix::like(hidden_bias_)),
      mean_(Matrix::like(hidden_bias_)) {}

void GibbsChain::take_history(const Rows& rows) {
  crbm_.dynamic_visible_bias(rows, visible_bias_);
  crbm_.dynamic_hidden_bias(rows, hidden_bias_);
}

void GibbsChain::infer_hidden(const Rows& visible, const Rows& out) const {
  gemm(visible, crbm_.W, out, hidden_units(hidden_bias_));
}

void GibbsChain::draw_hidden(const Rows& visible, const RandomKey& key) {
  GemmOptions options = hidden_units(hidden_bias_);
  const Rows sample(hidden_);
  options.sampling = Sampling::bernoulli;
  options.sample = &sample;
  options.random = key;
  gemm(visible, crbm_.W, mean_, options);
}

void GibbsChain::infer_visible(const Rows& hidden, const Rows& out) const {
  gemm(hidden, crbm_.W_transposed, out, visible_units(crbm_, visible_bias_));
}

void GibbsChain::draw_visible(const Rows& hidden, const RandomKey& key, const Rows& out) const {
  GemmOptions options = visible_units(crbm_, visible_bias_);
  options.sampling = sampling_of(crbm_.shape().kind);
  options.sample = &out;
  options.random = key;
  gemm(hidden, crbm_.W_transposed, visible_mean_, options);
}

}  // namespace mcdbn
