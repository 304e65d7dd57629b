#include "learning/persistent_contrastive_divergence.hpp"

namespace mcdbn {
namespace {

/// Share of the fast weights that is kept from mini-batch to mini-batch (Tieleman and Hinton 2009).
constexpr float kFastKept = 19.0F / 20.0F;

}  // namespace

PersistentContrastiveDivergence::PersistentContrastiveDivergence(
    Crbm& crbm, std::size_t largest_batch, const CdSettings& settings,
    std::optional<OptimizerKind> optimizer)
    : PersistentContrastiveDivergence(crbm, largest_batch,
                                      choose_chain_tile(crbm.device(), crbm.shape(), largest_batch),
                                      settings, optimizer) {}

PersistentContrastiveDivergence::PersistentContrastiveDivergence(
    Crbm& crbm, std::size_t largest_batch, std::optional<RowTile> tile, const CdSettings& settings,
    std::optional<OptimizerKind> optimizer)
    : ContrastiveDivergence(crbm, largest_batch,
                            settings.fast_rate > 0.0 ? std::nullopt : std::move(tile), settings,
                            optimizer),
      batch_(largest_batch),
      particles_(Matrix::like(hidden_data_)) {
  if (settings.fast_rate <= 0.0) return;
  fast_ = Matrix::like(crbm.parameters().all());
  fast_sum_ = Matrix::like(fast_);
  fast_sum_.copy_from(crbm.parameters().all());
  fast_machine_.emplace(crbm.parameters().in(fast_sum_), crbm.shape(), crbm.visible_mean.to_host());
}

void PersistentContrastiveDivergence::visit_state(TrainingState& state) {
  ContrastiveDivergence::visit_state(state);
  state.number("fresh", fresh_);
  // Without the rows that fill up the device's blocks.
  Matrix particles = particles_.part(0, batch_, particles_.columns());
  state.matrix("particles", particles);
  if (!fast_machine_) return;
  state.matrix("fast", fast_);
  state.matrix("fast_sum", fast_sum_);
  if (state.restores()) fast_machine_->refresh_transposed();
}

void PersistentContrastiveDivergence::run_chain(const Rows& rows, const CdRule& rule,
                                                const RandomKey& key) {
  if (tile_)
    fused_chain(rows, rule, key, &particles_, fresh_);
  else
    composed_chain(rows, rule, key);
  fresh_ = false;
}

void PersistentContrastiveDivergence::composed_chain(const Rows& rows, const CdRule& rule,
                                                     const RandomKey& key) {
  clamp_data(rows, key);
  const Crbm& machine = fast_machine_ ? *fast_machine_ : crbm_;
  if (fast_machine_) dynamic_biases(machine, rows);
  if (!fresh_) hidden_sample_.copy_from(particles_);
  gibbs_chain(machine, rows.count, rule, key, true);
  particles_.copy_from(hidden_sample_);
}

void PersistentContrastiveDivergence::after_update(const CdRule& rule) {
  if (!fast_machine_) return;
  fast_update(fast_, fast_sum_, crbm_.parameters(), optimizer_.gradients(), kFastKept,
              [&rule](const ParameterShape& shape) {
                return shape.name == "A" || shape.name == "B" ? 0.0F : rule.fast_rate;
              });
  fast_machine_->refresh_transposed();
}

}  // namespace mcdbn
