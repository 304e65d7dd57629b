#include "learning/random_start.hpp"

#include <cmath>

#include "base/random_streams.hpp"
#include "learning/unrolled_network.hpp"

namespace mcdbn {
namespace {

constexpr std::uint16_t kStream = random_streams::kFirstWeights;

}  // namespace

Mcdbn random_start(Device& device, std::size_t track, std::size_t pose,
                   const LearningSettings& learning) {
  // Units about zero have a slope of a quarter: with this weight a unit says again what the one
  // beneath it says. So a deep stack starts as a shallow one that its upper layers merely pass on:
  // after 250 mini-batches the loss is a tenth smaller than with all of it drawn at full size.
  constexpr float kPassOn = 4.0F;
  // The mean field hears this modality again in every step.
  constexpr float kPassOnAgain = 2.0F;
  std::uint32_t next = 0;
  // Deviations that keep a unit's input near one size, whatever its inputs' number.
  const auto layer = [&](std::size_t visible, VisibleKind kind) {
    const CrbmShape shape{visible, learning.hidden, learning.order, kind};
    CrbmParameters drawn = CrbmParameters::random(shape, 1.0, {learning.seed, next++, kStream, 0});
    const bool lowest = kind == VisibleKind::gaussian;
    const double up = (lowest ? 0.8 : 1.0) / std::sqrt(static_cast<double>(visible));
    const double history =
        1.0 / std::sqrt(static_cast<double>(std::max<std::size_t>(learning.order, 1) * visible));
    drawn.W *= static_cast<float>(up);
    drawn.B *= static_cast<float>((lowest ? 0.6 : 0.7) * history);
    drawn.A *= static_cast<float>((lowest ? 0.09 : 0.9) * history);
    if (!lowest) drawn.W.diagonal().array() += kPassOn;
    return drawn;
  };
  MrbmParameters mrbm =
      MrbmParameters::random(learning.hidden, learning.hidden, learning.mrbm_hidden, 1.0,
                             {learning.seed, next++, kStream, 0});
  const double shared = 1.0 / std::sqrt(static_cast<double>(learning.hidden));
  mrbm.W[0] *= static_cast<float>(shared);
  mrbm.W[1] *= static_cast<float>(2.0 / 3.0 * shared);
  mrbm.W[0].diagonal().array() += kPassOn;
  mrbm.W[1].diagonal().array() += kPassOnAgain;
  // The mean field starts with all units of the absent modality at the same value: that must not
  // push the shared units anywhere.
  for (MatrixF& W : mrbm.W) W.rowwise() -= RowVectorF(W.colwise().mean());
  Mcdbn network{{},
                {},
                Mrbm(device, uncentered(mrbm)),
                learning.look_ahead,
                learning.fine_tuning.mean_field_steps};
  for (const Modality modality : {Modality::track, Modality::pose}) {
    for (std::size_t i = 0; i < learning.layers; ++i) {
      CrbmParameters drawn =
          i == 0 ? layer(modality == Modality::track ? track : pose, VisibleKind::gaussian)
                 : layer(learning.hidden, VisibleKind::binary);
      // The down-pass of the lowest 3D layer sums over hidden units, not over features.
      if (i == 0 && modality == Modality::pose)
        drawn.W *= static_cast<float>(
            1.5 / 0.8 *
            std::sqrt(static_cast<double>(pose) / static_cast<double>(learning.hidden)));
      network.cdbn(modality).layers.emplace_back(device, uncentered(drawn));
    }
  }
  return network;
}

}  // namespace mcdbn
