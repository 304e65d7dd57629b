#include "learning/random_start.hpp"

#include <cmath>

#include "base/random_streams.hpp"
#include "learning/unrolled_network.hpp"

namespace mcdbn {
namespace {

constexpr std::uint16_t kStream = random_streams::kFirstWeights;

}  // namespace

Mcdbn random_start(Device& device, const std::vector<Modality>& modalities,
                   const LearningSettings& learning) {
  // Units about zero have a slope of a quarter: with this weight a unit has the value of the one
  // beneath it. So a deep stack starts as a shallow one that its upper layers merely pass on:
  // after 250 mini-batches the loss is a tenth smaller than with all of it drawn at full size.
  constexpr float kPassOn = 4.0F;
  // The mean field uses this modality's code again in every step.
  constexpr float kPassOnAgain = 2.0F;
  // Sizes of weights, whatever their inputs' number: of a unit's input, of variance one, more comes
  // from the frame itself than from its history. On CMU walkers (02, 32, 35, 39; one held out),
  // after 200 mini-batches: A of 0.6 makes the loss 7 % larger, a down-pass of 0.8 makes it 10 %
  // larger.
  constexpr double kFromFrame = 0.8, kFromHistory = 0.6;
  constexpr double kHistoryToVisible = 0.09;
  constexpr double kDown = 1.5;
  std::uint32_t next = 0;
  const auto layer = [&](std::size_t visible, VisibleKind kind) {
    const CrbmShape shape{visible, learning.hidden, learning.order, kind};
    CrbmParameters drawn = CrbmParameters::random(shape, 1.0, {learning.seed, next++, kStream, 0});
    const double history =
        1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(learning.order, 1) * visible));
    drawn.W *= static_cast<float>(kFromFrame / std::sqrt(static_cast<double>(visible)));
    drawn.B *= static_cast<float>(kFromHistory * history);
    drawn.A *= static_cast<float>(kHistoryToVisible * history);
    if (kind == VisibleKind::binary) drawn.W.diagonal().array() += kPassOn;
    return drawn;
  };
  MrbmShape shape{modalities, learning.mrbm_hidden};
  for (Modality& code : shape.modalities) {
    code.visible = learning.hidden;
    code.kind = VisibleKind::binary;
  }
  MrbmParameters mrbm = MrbmParameters::random(shape, 1.0, {learning.seed, next, kStream, 0});
  next += static_cast<std::uint32_t>(modalities.size());
  const double shared = 1.0 / std::sqrt(static_cast<double>(learning.hidden));
  for (MatrixF& W : mrbm.W) W *= static_cast<float>(shared);
  const std::size_t last = modalities.size() - 1;
  for (std::size_t m = 0; m <= last; ++m)
    mrbm.W[m].diagonal().array() += m == last ? kPassOnAgain : kPassOn;
  // The mean field starts with all units of the absent modality at the same value: that must not
  // push the shared units anywhere.
  for (MatrixF& W : mrbm.W) W.rowwise() -= RowVectorF(W.colwise().mean());
  Mcdbn network{std::vector<Cdbn>(modalities.size()), Mrbm(device, uncentered(mrbm)),
                learning.look_ahead, learning.fine_tuning.mean_field_steps};
  for (std::size_t m = 0; m <= last; ++m) {
    const Modality& modality = modalities[m];
    for (std::size_t i = 0; i < learning.layers; ++i) {
      CrbmParameters drawn = i == 0 ? layer(modality.visible, modality.kind)
                                    : layer(learning.hidden, VisibleKind::binary);
      // The down-pass of the last modality's lowest layer sums over hidden units, not over
      // features.
      if (i == 0 && m == last)
        drawn.W *= static_cast<float>(kDown / kFromFrame *
                                      std::sqrt(static_cast<double>(modality.visible) /
                                                static_cast<double>(learning.hidden)));
      network.cdbns[m].layers.emplace_back(
          device, uncentered(drawn, i == 0 ? InputKind::data : InputKind::code));
    }
  }
  return network;
}

}  // namespace mcdbn
