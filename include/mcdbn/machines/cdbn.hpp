#pragma once

#include <vector>

#include "mcdbn/machines/crbm.hpp"
#include "mcdbn/machines/sequences.hpp"

namespace mcdbn {

/// A stack of CRBMs of any depth: a Gaussian one below, binary ones on the hidden probabilities of
/// the one beneath (section III.B, Fig. 4).
struct Cdbn {
  std::vector<Crbm> layers;

  std::size_t code_dimension() const { return layers.back().shape().hidden; }
  /// Frames that the whole stack needs before the first one that has a code.
  std::size_t total_order() const;
  /// Mean-field up-pass through every layer: hidden probabilities of all frames that have a
  /// history.
  /// @param visible [all frames x visible units of the lowest layer]
  /// @return [all frames x code_dimension]; the first total_order() frames of each clip have no
  ///         code and are zero (Sequences::valid_from)
  /// @throws ShapeError for a stack without layers, and where the columns are not the visible units
  Sequences up_pass(const Sequences& visible) const;
};

/// Mean-field up-pass through one layer, as Cdbn::up_pass(). @return [all frames x hidden]
/// @throws ShapeError
Sequences up_pass(const Crbm& layer, const Sequences& visible);

}  // namespace mcdbn
