#pragma once

#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// 1 / (1 + exp(−x)), eq 8.
MatrixF sigmoid_on_host(const MatrixF& x);

/// p(h = 1 | v, H), eq 11 with eq 17, for a few rows without a device.
/// @param visible [rows x visible]  @param history [rows x order·visible], oldest frame first
MatrixF hidden_on_host(const CrbmParameters& crbm, const MatrixF& visible, const MatrixF& history);

/// The mean of v given h and H (eq 6 or 10 with eq 16). @param hidden [rows x hidden]
MatrixF visible_on_host(const CrbmParameters& crbm, const MatrixF& hidden, const MatrixF& history);

}  // namespace mcdbn
