#pragma once

#include "mcdbn/base/random.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// The two halves of a Gibbs step of a CRBM, means or draws, for many rows at once, under dynamic
/// biases that stay until other histories are taken. Everything enqueues and returns.
class GibbsChain {
 public:
  GibbsChain(const Crbm& crbm, std::size_t rows);

  /// Takes â and b̂ of these rows' histories (eq 16, 17). @param rows as many as the chain has
  void take_history(const Rows& rows);

  /// p(h = 1 | v, H) into hidden(), or elsewhere.
  void infer_hidden(const Rows& visible) { infer_hidden(visible, hidden_); }
  void infer_hidden(const Rows& visible, const Rows& out) const;
  /// A draw from it into hidden().
  void draw_hidden(const Rows& visible, const RandomKey& key);
  /// The visible units' means given hidden(), or given other hidden units.
  void infer_visible(const Rows& out) const { infer_visible(hidden_, out); }
  void infer_visible(const Rows& hidden, const Rows& out) const;
  /// A draw given hidden(), or given other hidden units.
  void draw_visible(const RandomKey& key, const Rows& out) const {
    draw_visible(hidden_, key, out);
  }
  void draw_visible(const Rows& hidden, const RandomKey& key, const Rows& out) const;

  const Matrix& hidden() const { return hidden_; }  ///< [rows x hidden]

 private:
  const Crbm& crbm_;
  Matrix visible_bias_, hidden_bias_;    // [rows x units]
  Matrix visible_mean_, hidden_, mean_;  // mean_: probabilities of hidden_
};

}  // namespace mcdbn
