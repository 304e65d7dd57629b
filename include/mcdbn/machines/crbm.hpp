#pragma once

#include <optional>

#include "mcdbn/base/random.hpp"
#include "mcdbn/device/parameters.hpp"

namespace mcdbn {

enum class VisibleKind { gaussian, binary };

struct CrbmShape {
  std::size_t visible = 0;
  std::size_t hidden = 0;
  std::size_t order = 0;  ///< frames of history; 0 makes it an RBM
  VisibleKind kind = VisibleKind::gaussian;
  /// How many of the latest history frames A and B use; at most `order`; unset: `order`.
  std::optional<std::size_t> own_order_A = {}, own_order_B = {};

  std::size_t order_A() const { return own_order_A.value_or(order); }
  std::size_t order_B() const { return own_order_B.value_or(order); }
  bool operator==(const CrbmShape& other) const;
};

/// A CRBM's parameters on the host, with the paper's letters. Histories run oldest frame first.
struct CrbmParameters {
  CrbmShape shape;
  MatrixF W;  ///< [visible x hidden]
  MatrixF A;  ///< [order_A·visible x visible] history → visible (eq 16)
  MatrixF B;  ///< [order_B·visible x hidden]  history → hidden (eq 17)
  MatrixF a;  ///< [1 x visible]
  MatrixF b;  ///< [1 x hidden]
  /// [1 x visible] what the visible units are on average over the training windows (0 where they
  /// are standardized): the history before a free-running start.
  MatrixF visible_mean;
  /// [1 x visible] σ of Gaussian units (eq 9): what the frames that the machine sees are divided by
  /// before it sees them, so that its own units have variance 1. Ones, unless it was learnt or
  /// given.
  MatrixF visible_deviation;

  static CrbmParameters zeros(const CrbmShape& shape);
  /// W, A and B drawn from N(0, deviation²), biases zero.
  /// @param key theirs are the three phases that follow its own
  static CrbmParameters random(const CrbmShape& shape, double deviation, const RandomKey& key);
  /// The contents of a machine's buffer (Crbm::parameter_shapes), or of one of gradients;
  /// visible_mean is zero, visible_deviation one.
  static CrbmParameters read(const Parameters& from, const CrbmShape& shape);
  /// W, A, B, a and b. @throws ShapeError
  void write(Parameters to) const;
};

/// The paper's letters in place among parameters of Crbm::parameter_shapes, or among gradients. A
/// and B have a row for every float of the frames that they see: a history is read with its
/// padding, whose weights are zero and stay zero because the padding is.
struct CrbmMatrices {
  explicit CrbmMatrices(const Parameters& parameters);
  Matrix W, A, B, a, b;
};

/// A conditional RBM (eq 13 to 17; Gaussian units have variance 1, as data is standardized); an RBM
/// or Gaussian RBM where the order is 0 (eq 1 to 11). Frames stand in one matrix
/// [frames x visible], so that the history of row t is the `order` rows before it, read in place.
class Crbm : public CrbmMatrices {
 public:
  /// W, A, B, a, b. @throws ShapeError if A or B should see more frames than `order`
  static std::vector<ParameterShape> parameter_shapes(const CrbmShape& shape);

  /// @throws ShapeError if a matrix does not have the shape that CrbmParameters gives for it
  Crbm(Device& device, const CrbmParameters& start);
  /// A CRBM on existing parameters, which it shares; they may be part of a larger machine's.
  /// @param visible_mean_row [1 x visible]  @param visible_deviation_row [1 x visible]; none: ones
  /// @throws ShapeError
  Crbm(const Parameters& parameters, const CrbmShape& shape, const MatrixF& visible_mean_row,
       const MatrixF& visible_deviation_row = {});
  CrbmParameters to_host() const;
  const CrbmShape& shape() const { return shape_; }
  const Parameters& parameters() const { return parameters_; }
  Device& device() const { return W.device(); }

  /// The history of each row in place: the `order` frames before it as one row, oldest first, each
  /// with its padding.
  /// @param rows [rows x visible], one frame each
  /// @return [rows x order · padded(visible)]
  /// @throws ShapeError if a row has fewer frames before it than the order; of indexed rows the
  ///         caller answers for that. So do all that follow, which read histories
  Rows history(const Rows& rows) const;
  /// The parts of the history for A and B: order_A and order_B frames.
  Rows history_for_A(const Rows& rows) const;
  Rows history_for_B(const Rows& rows) const;

  /// b̂ = b + H·B (eq 17). @param out [rows x hidden]  @throws ShapeError
  void dynamic_hidden_bias(const Rows& rows, const Rows& out) const;
  /// â = a + H·A (eq 16). @param out [rows x visible]  @throws ShapeError
  void dynamic_visible_bias(const Rows& rows, const Rows& out) const;
  /// p(h = 1 | v, H), eq 11 with eq 17. @param out [rows x hidden]  @throws ShapeError
  void hidden_probabilities(const Rows& rows, const Rows& out) const;
  /// Brings the transposed copy of W up to date after W changed.
  void refresh_transposed();

  Matrix W_transposed;       ///< [hidden x visible]
  Matrix visible_mean;       ///< [1 x visible], see CrbmParameters
  Matrix visible_deviation;  ///< [1 x visible], see CrbmParameters
  /// If true, callers divide frames by visible_deviation before use and multiply results by it.
  bool has_deviation = false;

 private:
  CrbmShape shape_;
  Parameters parameters_;
};

}  // namespace mcdbn
