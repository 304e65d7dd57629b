#pragma once

#include "mcdbn/base/matrices.hpp"

/// The paper's mathematics in double precision with Eigen, written to be read beside the equations.
/// What the kernels compute is tested against it. Batches are row-major: one row, one case.
namespace mcdbn::reference {

/// eq 8, without overflow on either side.
double sigmoid(double x);
MatrixD sigmoid(const MatrixD& x);

/// log(1 + exp(x)), without overflow.
double softplus(double x);
MatrixD softplus(const MatrixD& x);

/// 1 where the uniform draw is below the probability (eq 6, 7), else 0.
MatrixD bernoulli(const MatrixD& probability, const MatrixD& uniform);

/// Smallest |p − u|: where it is below rounding error, single precision may draw another bit.
double closest_draw(const MatrixD& probability, const MatrixD& uniform);

/// Every row of `x` with `row` added.
MatrixD plus_row(const MatrixD& x, const RowVectorD& row);

/// Sum of − t·log p − (1 − t)·log(1 − p) over all entries, for p = σ(x).
/// @param x what the sigmoid takes, so that no p rounds to 0 or 1
double cross_entropy_of_sigmoid(const MatrixD& target, const MatrixD& x);

}  // namespace mcdbn::reference
