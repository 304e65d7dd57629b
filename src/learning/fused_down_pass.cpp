#include "learning/fused_down_pass.hpp"

#include <fmt/format.h>

#include "device/kernel_arguments.hpp"
#include "machines/crbm_defines.hpp"

namespace mcdbn {

std::optional<FusedDownPass> FusedDownPass::of(const UnrolledNetwork::Layer& layer,
                                               InputKind input_kind,
                                               const SequenceWindows& windows) {
  const CrbmShape& shape = layer.crbm.shape();
  if (shape.order_A() == 0) return std::nullopt;
  const auto tile = choose_row_tile(
      layer.crbm.device(), shape.order_A() * padded(shape.visible), windows.count,
      fmt::format("down-pass of {} units, order {}", shape.visible, shape.order_A()));
  if (!tile) return std::nullopt;
  return FusedDownPass(layer, input_kind, windows, *tile);
}

FusedDownPass::FusedDownPass(const UnrolledNetwork::Layer& layer, InputKind input_kind,
                             const SequenceWindows& windows, const RowTile& tile)
    : layer_(&layer), input_kind_(input_kind), windows_(windows), tile_(tile) {}

LaunchSize FusedDownPass::size() const {
  const auto group = static_cast<std::size_t>(tile_.group);
  return {{ceil_divide(windows_.count, static_cast<std::size_t>(tile_.rows)) * group, 1},
          {group, 1}};
}

void FusedDownPass::forward(const Matrix& input_from_above, const Matrix& states) const {
  const Crbm& crbm = layer_->crbm;
  Defines defines = crbm_row_defines(crbm.shape(), tile_);
  defines["ORDER_B"] = 0;
  // Else left to its default, as a decoder does: the two then share one compiled program.
  if (input_kind_ == InputKind::code) defines["CENTERED"] = 1;
  launch(crbm.device(), crbm.device().programs().kernel("cdbn_decoder.cl", "decode_means", defines),
         size(), states.buffer(), input_from_above.buffer(),
         to_int(windows_.frames - windows_.first), to_int(windows_.first), to_int(windows_.count),
         to_int(windows_.frames), to_int(windows_.first), to_int(windows_.frames), crbm.A.buffer());
}

void FusedDownPass::backward(const Matrix& states, const Matrix& errors, float kept_share) const {
  const Crbm& crbm = layer_->crbm;
  Defines defines = crbm_row_defines(crbm.shape(), tile_);
  defines["ORDER_B"] = 0;
  const bool is_gaussian = crbm.shape().kind == VisibleKind::gaussian;
  defines["ACTIVATION"] = input_kind_ == InputKind::code ? "centered_sigmoid_gradient"
                          : is_gaussian                  ? "none"
                                                         : "sigmoid_gradient";
  launch(crbm.device(),
         crbm.device().programs().kernel("unrolled_decoder.cl", "decoder_errors", defines), size(),
         errors.buffer(), states.buffer(), to_int(windows_.count), to_int(windows_.frames),
         to_int(windows_.first), to_int(windows_.frames), layer_->A_following.buffer(), kept_share);
}

}  // namespace mcdbn
