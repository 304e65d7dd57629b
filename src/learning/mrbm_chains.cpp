#include "learning/mrbm_chains.hpp"

#include <numeric>

#include "base/random_phases.hpp"
#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "learning/mrbm_rule.hpp"
#include "machines/mean_field.hpp"

namespace mcdbn {

MrbmChains::MrbmChains(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                       OptimizerKind optimizer)
    : mrbm_(mrbm), settings_(settings), batch_(batch), optimizer_(mrbm.parameters(), optimizer) {}

void MrbmChains::make_matrices() {
  hidden_data_ = Matrix(mrbm_.device(), batch_, mrbm_.hidden());
  for (Matrix* matrix : {&hidden_, &hidden_sample_, &weighted_})
    *matrix = Matrix::like(hidden_data_);
  for (const Matrix& W : mrbm_.W) {
    data_.emplace_back(mrbm_.device(), batch_, W.rows());
    visible_.push_back(Matrix::like(data_.back()));
  }
  gradient_.emplace(mrbm_.parameters().in(optimizer_.gradients()), mrbm_.shape());
}

void MrbmChains::learn(std::span<const Rows> visible, const LearningStep& step,
                       LossAccumulator& losses) {
  require(visible.size() == mrbm_.modality_count(), "MRBM: needs every modality");
  for (std::size_t m = 0; m < visible.size(); ++m)
    require(visible[m].index != nullptr && visible[m].count == batch_ &&
                visible[m].columns == mrbm_.visible(m),
            "MRBM: needs indexed codes, as many as it was made for");
  optimizer_.next_step();
  run_minibatch(visible, step, losses);
}

void MrbmChains::run_minibatch(std::span<const Rows> visible, const LearningStep& step,
                               LossAccumulator& losses) {
  for (std::size_t m = 0; m < visible.size(); ++m) gather(visible[m], data_[m]);
  optimizer_.gradients().set_zero();
  add_gradients(step.random, losses);
  optimizer_.update(mrbm_update_rule(settings_, step.progress));
  mrbm_.refresh_transposed();
}

std::vector<Rows> MrbmChains::units(std::span<const std::size_t> free) const {
  std::vector<Rows> rows(data_.begin(), data_.end());
  for (const std::size_t m : free) rows[m] = visible_[m];
  return rows;
}

void MrbmChains::hidden_of_data(const RandomKey& key) {
  std::vector<std::size_t> all(data_.size());
  std::iota(all.begin(), all.end(), 0);
  const Rows sample(hidden_sample_);
  GemmOptions up = mean_of_units(VisibleKind::binary);
  up.sampling = Sampling::bernoulli;
  up.sample = &sample;
  up.random = key;
  shared_units(mrbm_, all, data(), mrbm_.b, up, hidden_data_);
}

void MrbmChains::run(std::span<const std::size_t> free, const RandomKey& key, bool draw_last) {
  std::vector<std::size_t> all(data_.size());
  std::iota(all.begin(), all.end(), 0);
  const Rows hidden_sample(hidden_sample_);
  const std::vector<Rows> chain = units(free);
  for (std::size_t k = 1; k <= settings_.gibbs_steps; ++k) {
    for (const std::size_t m : free) {
      GemmOptions down = mean_of_units(mrbm_.kind(m));
      if (settings_.sample_visible) {
        down.sampling = sampling_of(mrbm_.kind(m));
        down.sample = &chain[m];
        down.random = key;
        down.random.phase =
            static_cast<std::uint16_t>(random_phases::kVisibleUnits + k * chain.size() + m);
      }
      absent_units(mrbm_, m, hidden_sample, down, chain[m]);
    }
    GemmOptions up = mean_of_units(VisibleKind::binary);
    if (k < settings_.gibbs_steps || draw_last) {
      up.sampling = Sampling::bernoulli;
      up.sample = &hidden_sample;
      up.random = key;
      up.random.phase = static_cast<std::uint16_t>(k);
    }
    shared_units(mrbm_, all, chain, mrbm_.b, up, hidden_);
  }
}

void MrbmChains::add_contrast(std::span<const std::size_t> free, const Matrix& weights) {
  add_side(units(free), hidden_, weights, 1.0F);
  add_side(data(), hidden_data_, weights, -1.0F);
}

void MrbmChains::add_side(const std::vector<Rows>& units, const Matrix& hidden,
                          const Matrix& weights, float sign) {
  scale_rows(hidden, weights, weighted_);
  for (std::size_t m = 0; m < units.size(); ++m) {
    gemm_transposed_a(units[m], weighted_, gradient_->W[m], sign, 1.0F);
    gemm_transposed_a(weights, units[m], gradient_->a[m], sign, 1.0F);
  }
  column_sum(weighted_, sign, 1.0F, gradient_->b);
}

MrbmParameters MrbmChains::gradients() {
  return MrbmParameters::read(mrbm_.parameters().in(optimizer_.gradients()), mrbm_.shape());
}

}  // namespace mcdbn
