#pragma once

#include "device/optimizer.hpp"
#include "mcdbn/base/matrices.hpp"

namespace mcdbn::reference {

/// `gradient` points uphill (eq 36):
/// velocity ← momentum·velocity + rate·(gradient − decay·parameter − l1·sign(parameter));
/// parameter += velocity.
void momentum_update(MatrixD& parameter, MatrixD& velocity, const MatrixD& gradient,
                     const UpdateRule& rule);

/// Kingma and Ba (2015), algorithm 1, with decoupled weight decay and L1; `step` counts from 1.
void adam_update(MatrixD& parameter, MatrixD& mean, MatrixD& square, const MatrixD& gradient,
                 const UpdateRule& rule, int step);

}  // namespace mcdbn::reference
