#pragma once

#include <functional>

#include "reference/mrbm_reference.hpp"
#include "reference/running_error.hpp"

namespace mcdbn::reference {

struct ClampedChain {
  int steps = 1;
  double temperature = 0.0;  ///< 0 mean field, 1 sampled, between: p + temperature · (draw − p)
  bool concrete = false;     ///< draws are σ(logit p + logit u)
};

/// Numbers for the draws of pass 0, 1, …: of each step the hidden units, then every absent
/// modality. Uniform ones, for Gaussian units of variance 1 and mean 0. @return [rows x units]
using PassDraws = std::function<MatrixD(int pass, Eigen::Index units)>;

/// The MRBM's chain with the modalities that are `present` clamped, the others started from zeros
/// (eq 21 to 23 and 32, 33), in double with a bound on what single precision makes of it. Where
/// rounding may decide a draw, the bound of its row is that of not knowing it.
/// @param values of each modality [rows x D_m]; those of the absent ones are not read
/// @param normal draws of Gaussian units
/// @return the means of every absent modality in the last step, nothing for the present ones
std::vector<Bounded> bounded_chain(const Mrbm& model, const std::vector<bool>& present,
                                   const std::vector<MatrixD>& values, const ClampedChain& chain,
                                   const PassDraws& uniform, const PassDraws& normal);

/// The same of two binary modalities, of which `present` (0 or 1) is clamped.
/// @param values the present modality [rows x D_present]
/// @return p(absent | hidden) of the last step [rows x D_absent]
Bounded bounded_clamped_chain(const Mrbm& model, int present, const MatrixD& values,
                              const ClampedChain& chain, const PassDraws& draws);

/// The sampled chain of one row as a Markov chain over the 2^K hidden states, bit k of a state
/// being unit k, by summing over all states of the absent modality.
struct HiddenStates {
  RowVectorD start;       ///< p(h | present, absent = 0): the first step's
  MatrixD transition;     ///< from a row's state to a column's: absent given h, then h given both
  RowVectorD stationary;  ///< p(h | present), eq 18 and 19 summed over the absent modality
  MatrixD absent;         ///< p(absent unit = 1 | h) [2^K x D_absent]
};
HiddenStates enumerate_hidden(const Mrbm& model, int present, const RowVectorD& values);

}  // namespace mcdbn::reference
