#pragma once

#include <optional>

#include "device/launch.hpp"
#include "device/row_tile.hpp"
#include "learning/unrolled_network.hpp"
#include "mcdbn/learning/sequence_loss.hpp"

namespace mcdbn {

/// A layer's down-pass on its own output, and the way back through it, in one launch each
/// (cdbn_decoder.cl, unrolled_decoder.cl). The units of a layer that is not the lowest are about
/// zero.
class FusedDownPass {
 public:
  /// Nothing where the kernels do not fit the device, or no history is seen.
  static std::optional<FusedDownPass> of(const UnrolledNetwork::Layer& layer, InputKind input_kind,
                                         const SequenceWindows& windows);
  FusedDownPass(const UnrolledNetwork::Layer& layer, InputKind input_kind,
                const SequenceWindows& windows, const RowTile& tile);

  /// @param input_from_above a and what the layer above gives, of the frames from `first` on
  ///        [count · (frames − first) x visible]
  /// @param states [rows x visible], the history before `first`; the frames after it are written
  void forward(const Matrix& input_from_above, const Matrix& states) const;
  /// @param errors [at least rows x visible] of the frames, become those by their inputs
  /// @param kept_share of drop-out, after which `states` are
  void backward(const Matrix& states, const Matrix& errors, float kept_share) const;

 private:
  LaunchSize size() const;

  const UnrolledNetwork::Layer* layer_;
  InputKind input_kind_;
  SequenceWindows windows_;
  RowTile tile_;
};

}  // namespace mcdbn
