#pragma once

#include "mcdbn/base/matrices.hpp"

/// Running error analysis (Higham, chapter 3): values in double beside a bound on how far a single
/// precision computation of the same expression may lie from them, whatever its order of summation.
namespace mcdbn::reference {

struct Bounded {
  MatrixD value;
  MatrixD bound;  ///< of the value's shape, not negative

  /// Numbers that the device was given exactly.
  static Bounded exact(const MatrixD& value);
  Bounded transposed() const { return {value.transpose(), bound.transpose()}; }
};

Bounded operator+(const Bounded& x, const Bounded& y);
Bounded operator-(const Bounded& x, const Bounded& y);
Bounded operator*(double exact, const Bounded& x);
/// x·y, matrix product.
Bounded product(const Bounded& x, const Bounded& y);
/// Entry by entry.
Bounded times(const Bounded& x, const Bounded& y);
/// x with the single row `row` added to each of its rows.
Bounded plus_row(const Bounded& x, const Bounded& row);
/// [1 x columns]
Bounded column_sum(const Bounded& x);
/// σ(x), eq 8: ¼ of the input's error, as |σ'| ≤ ¼, plus the function's own.
Bounded sigmoid(const Bounded& x);
/// y·(1 − y)
Bounded sigmoid_gradient(const Bounded& y);
/// u < p. Where u lies within p's error the device may draw either: an error of 1.
Bounded bernoulli(const Bounded& probability, const MatrixD& uniform);
/// σ(logit p + logit u), by the formula's value at both ends of p's error and six roundings.
Bounded concrete(const Bounded& probability, const MatrixD& uniform);

}  // namespace mcdbn::reference
