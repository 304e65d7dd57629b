#include "learning/perceptron_loss.hpp"

#include "base/random_phases.hpp"
#include "device/pointwise.hpp"
#include "learning/optimizer_of.hpp"
#include "machines/mrbm_energy.hpp"

namespace mcdbn {

PerceptronLoss::PerceptronLoss(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                               std::optional<OptimizerKind> optimizer)
    : MrbmChains(mrbm, batch, settings, optimizer.value_or(optimizer_of(settings))),
      weights_(mrbm.device(), batch, 1),
      data_energy_(Matrix::like(weights_)),
      end_energy_(Matrix::like(weights_)) {
  make_matrices();
}

/// Draws binary units of the data, as step 0 of a chain.
void PerceptronLoss::draw_data(const RandomKey& key) {
  for (std::size_t m = 0; m < data_.size(); ++m) {
    if (mrbm_.kind(m) != VisibleKind::binary) continue;
    const Rows units(data_[m]);
    GemmOptions draw;
    draw.sampling = Sampling::bernoulli;
    draw.sample = &units;
    draw.random = key;
    draw.random.phase = static_cast<std::uint16_t>(random_phases::kVisibleUnits + m);
    apply_epilogue(units, draw);
  }
}

void PerceptronLoss::add_gradients(const RandomKey& key, LossAccumulator& losses) {
  if (settings_.sample_visible) draw_data(key);
  for (std::size_t m = 0; m < data_.size(); ++m) {
    const std::size_t free[] = {m};
    RandomKey own = key;
    own.stream = static_cast<std::uint16_t>(key.stream + m);
    hidden_of_data(own);
    run(free, own);
    losses.add_squared_error(m, data_[m], visible_[m],
                             1.0F / static_cast<float>(batch_ * data_[m].columns()));
    free_energy_given_others(mrbm_, m, data(), data_energy_);
    free_energy_given_others(mrbm_, m, units(free), end_energy_);
    weigh_lower(end_energy_, data_energy_, 1.0F / static_cast<float>(batch_), weights_);
    add_contrast(free, weights_);
  }
}

}  // namespace mcdbn
