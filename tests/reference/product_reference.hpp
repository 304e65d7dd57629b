#pragma once

#include "reference/running_error.hpp"

namespace mcdbn::reference {

/// alpha·A·B + beta·C, within (k + 2)·u·(|alpha||A||B| + |beta||C|), k being A's columns.
Bounded product(const MatrixD& a, const MatrixD& b, double alpha = 1.0, double beta = 0.0,
                const MatrixD& c = {});

/// The positive part, which brings no two numbers further apart.
Bounded relu(const Bounded& x);

/// x where y is positive, else exactly 0.
Bounded relu_gradient(const Bounded& x, const MatrixD& y);

/// σ(x) − ½ [Montavon and Müller 2012], and the error x before such a unit, of which drop-out kept
/// `kept_share` and left y: x·(¼ − (kept_share·y)²) / kept_share, nothing where the unit was
/// dropped.
Bounded centered_sigmoid(const Bounded& x);
Bounded centered_sigmoid_gradient(const Bounded& x, const MatrixD& y, double kept_share);

}  // namespace mcdbn::reference
