#pragma once

#include <array>
#include <vector>

#include "reference/crbm_reference.hpp"
#include "reference/mrbm_reference.hpp"

namespace mcdbn::reference {

/// A whole MCDBN: modality 0 is 2D, modality 1 is 3D.
struct UnrolledModel {
  std::array<std::vector<Crbm>, 2> stacks;
  std::array<std::vector<RowVectorD>, 2> start;  ///< of each layer, the history before a free run
  Mrbm mrbm;

  /// All parameters (not `start`) behind one another, for finite differences: the layers of 2D, of
  /// 3D, then the MRBM.
  Eigen::VectorXd flattened() const;
  UnrolledModel with_parameters(const Eigen::VectorXd& flat) const;
};

/// What drop-out does to the hidden units of one window: a unit u becomes ½ + f·(u − ½) with its f
/// of 0 or 1 / kept share, so that a dropped one stands at ½. Empty rows leave all as they are.
struct DropOut {
  std::vector<RowVectorD> up;    ///< of each layer of the present modality, its hidden units
  RowVectorD shared;             ///< of the MRBM, in every step
  std::vector<RowVectorD> down;  ///< of each layer of the absent modality, its visible units
};

/// Algorithm 3 on one window, frame by frame: up-pass of modality `present`, mean field, down-pass
/// of the other on its own output from frame `first` on.
/// @param values the present modality [frames x D]  @return [frames x D'], `start` before `first`
MatrixD joint_prediction(const UnrolledModel& model, int present, const MatrixD& values, int first,
                         int mean_field_steps, const DropOut& drop_out = {});

}  // namespace mcdbn::reference
