#pragma once

#include "device/updates.hpp"
#include "mcdbn/base/matrices.hpp"

namespace mcdbn::reference {

/// velocity ← momentum·velocity + rate·(gradient − decay·parameter); parameter += velocity.
void momentum_update(MatrixD& parameter, MatrixD& velocity, const MatrixD& gradient,
                     const MomentumRule& rule);

/// Kingma and Ba (2015), algorithm 1, with decoupled weight decay; `step` counts from 1.
void adam_update(MatrixD& parameter, MatrixD& mean, MatrixD& square, const MatrixD& gradient,
                 const AdamRule& rule, int step);

}  // namespace mcdbn::reference
