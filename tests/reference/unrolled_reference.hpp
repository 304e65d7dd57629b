#pragma once

#include <vector>

#include "reference/crbm_reference.hpp"
#include "reference/mrbm_reference.hpp"

namespace mcdbn::reference {

/// A whole MCDBN: of two modalities 0 is 2D and 1 is 3D.
struct UnrolledModel {
  std::vector<std::vector<Crbm>> stacks;
  std::vector<std::vector<RowVectorD>> start;  ///< of each layer, the history before a free run
  Mrbm mrbm;

  /// All parameters (not `start`) behind one another, for finite differences: the layers of each
  /// modality, then the MRBM.
  Eigen::VectorXd flattened() const;
  UnrolledModel with_parameters(const Eigen::VectorXd& flat) const;
};

/// What drop-out does to the hidden units of one window: a unit u becomes ½ + f·(u − ½) with its f
/// of 0 or 1 / kept share, so that a dropped one stands at ½. Empty rows leave all as they are.
struct DropOut {
  std::vector<RowVectorD> up;    ///< of each layer of every present modality, its hidden units
  RowVectorD shared;             ///< of the MRBM, in every step
  std::vector<RowVectorD> down;  ///< of each layer of the absent modality, its visible units
};

/// Algorithm 3 on one window, frame by frame: up-pass of the modalities but `missing`, mean field,
/// down-pass of that one on its own output from frame `first` on.
/// @param values of each modality [frames x D]  @return [frames x D'], `start` before `first`
MatrixD joint_prediction(const UnrolledModel& model, std::size_t missing,
                         const std::vector<MatrixD>& values, int first, int mean_field_steps,
                         const DropOut& drop_out = {});
/// The same of two modalities, of which one is present.
/// @param values the present modality [frames x D]  @return [frames x D'], `start` before `first`
MatrixD joint_prediction(const UnrolledModel& model, int present, const MatrixD& values, int first,
                         int mean_field_steps, const DropOut& drop_out = {});

}  // namespace mcdbn::reference
