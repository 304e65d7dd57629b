#pragma once

#include "mcdbn/base/matrices.hpp"

/// Running error analysis (Higham, section 3.3): values in double beside a bound on how far a
/// single precision computation of the same expression may lie from them, whatever its order of
/// summation.
namespace mcdbn::reference {

struct Bounded {
  MatrixD value;
  MatrixD bound;  ///< of the value's shape, not negative

  /// Numbers that the device was given exactly.
  static Bounded exact(const MatrixD& value);
  Bounded transposed() const { return {value.transpose(), bound.transpose()}; }
};

/// As Bounded::exact(), for numbers as the device has them.
Bounded exact(const MatrixF& values);

/// Terms that are added up in any order, all at once or in pieces that are stored in between: each
/// is rounded at most once for every term that there is (Higham, sections 3.1 and 4.2).
class Sum {
 public:
  Sum& add(const Bounded& term);
  /// The single row `row` to each row of what is there already.
  Sum& add_row(const Bounded& row);
  /// x·y, matrix product: a term for each column of x.
  Sum& add_product(const Bounded& x, const Bounded& y);
  /// [1 x columns], a term for each row of x.
  Sum& add_column_sum(const Bounded& x);
  /// Times `factor`, or over a count, be it the whole sum or every term on its way into it.
  Sum& scale(double factor);
  Sum& divide(double count);
  Bounded result() const;

 private:
  Sum& add_terms(const MatrixD& value, const MatrixD& inherited, const MatrixD& size, double count);

  MatrixD value_;
  MatrixD inherited_;  ///< what the terms' own errors make
  MatrixD size_;       ///< Σ |term|, errors included
  double roundings_ = 0;
};

Bounded operator-(const Bounded& x);
Bounded operator+(const Bounded& x, const Bounded& y);
Bounded operator-(const Bounded& x, const Bounded& y);
Bounded operator*(double factor, const Bounded& x);
/// x / count, or x times the reciprocal of a count.
Bounded divided(const Bounded& x, double count);
/// x·y, matrix product.
Bounded product(const Bounded& x, const Bounded& y);
/// Entry by entry.
Bounded times(const Bounded& x, const Bounded& y);
/// Entry by entry, y positive.
Bounded quotient(const Bounded& x, const Bounded& y);
Bounded square_root(const Bounded& x);
/// Of positive numbers.
Bounded logarithm(const Bounded& x);
Bounded one_minus(const Bounded& x);
Bounded clamped(const Bounded& x, double low, double high);
/// x with the single row `row` added to each of its rows.
Bounded plus_row(const Bounded& x, const Bounded& row);
/// [1 x columns]
Bounded column_sum(const Bounded& x);
/// Of all entries: those of a row, then the rows. [1 x 1]
Bounded total(const Bounded& x);
/// σ(x), eq 8: ¼ of the input's error, as |σ'| ≤ ¼, plus the function's own.
Bounded sigmoid(const Bounded& x);
/// log(1 + exp(x)) as max(x, 0) + log(1 + exp(−|x|)): it brings no two numbers further apart.
Bounded softplus(const Bounded& x);
/// y·(1 − y)
Bounded sigmoid_gradient(const Bounded& y);

/// u < p. Where u lies within p's error the device may draw either: an error of 1.
Bounded bernoulli(const Bounded& probability, const MatrixD& uniform);
/// σ(logit p + logit u), by the formula's value at both ends of p's error and its roundings.
Bounded concrete(const Bounded& probability, const MatrixD& uniform);
/// mean + z for unit normals z, which the device has by Box-Muller: sqrt(−2·log u)·cospi(2u').
Bounded gaussian(const Bounded& mean, const MatrixD& normal);
/// mean + temperature·(draw − mean), the draw's and the mean's errors each by their own weight.
Bounded tempered(const Bounded& mean, const Bounded& draw, double temperature);

}  // namespace mcdbn::reference
