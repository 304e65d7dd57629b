#include "learning/joint_likelihood.hpp"

#include <numeric>

#include "learning/code_stack.hpp"
#include "learning/mrbm_rule.hpp"
#include "learning/optimizer_of.hpp"

namespace mcdbn {
namespace {

std::optional<RowTile> choose_joint_tile(const Mrbm& mrbm, std::size_t batch) {
  return choose_row_tile(mrbm.device(), all_units(mrbm) + padded(mrbm.hidden()), batch,
                         "joint likelihood");
}

}  // namespace

JointLikelihood::JointLikelihood(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                                 std::optional<OptimizerKind> optimizer)
    : JointLikelihood(mrbm, batch, choose_joint_tile(mrbm, batch), settings, optimizer) {}

JointLikelihood::JointLikelihood(Mrbm& mrbm, std::size_t batch, std::optional<RowTile> tile,
                                 const MrbmSettings& settings,
                                 std::optional<OptimizerKind> optimizer)
    : MrbmChains(mrbm, batch, settings, optimizer.value_or(optimizer_of(settings))),
      tile_(tile),
      block_(whole_blocks(batch, tile)) {
  if (settings.persistent) particles_ = Matrix(mrbm.device(), block_, mrbm.hidden());
  if (tile_) {
    make_stacks();
    return;
  }
  make_matrices();
  weights_ = Matrix::from_host(mrbm.device(), MatrixF::Constant(static_cast<Eigen::Index>(batch), 1,
                                                                1.0F / static_cast<float>(batch)));
}

void JointLikelihood::make_stacks() {
  Device& device = mrbm_.device();
  hidden_data_ = Matrix(device, block_, mrbm_.hidden());
  hidden_ = Matrix::like(hidden_data_);
  codes_ = Matrix(device, 1, block_ * all_units(mrbm_));
  stacked_visible_ = Matrix::like(codes_);
  row_losses_ = Matrix(device, 1, mrbm_.modality_count() * block_);
}

void JointLikelihood::visit_state(TrainingState& state) {
  MrbmChains::visit_state(state);
  state.number("started", started_);
  if (particles_.empty()) return;
  // Without the rows that fill up the device's blocks.
  Matrix particles = particles_.part(0, batch_, particles_.columns());
  state.matrix("particles", particles);
}

void JointLikelihood::run_minibatch(std::span<const Rows> visible, const LearningStep& step,
                                    LossAccumulator& losses) {
  if (!tile_) {
    MrbmChains::run_minibatch(visible, step, losses);
    return;
  }
  gather_codes(visible, block_, codes_);
  fused_chain(step.random);
  fused_update(mrbm_update_rule(settings_, step.progress), losses);
  started_ = true;
}

void JointLikelihood::add_gradients(const RandomKey& key, LossAccumulator& losses) {
  std::vector<std::size_t> all(data_.size());
  std::iota(all.begin(), all.end(), 0);
  hidden_of_data(key);
  if (settings_.persistent && started_) hidden_sample_.copy_from(particles_);
  run(all, key, settings_.persistent);
  if (settings_.persistent) particles_.copy_from(hidden_sample_);
  started_ = true;
  for (const std::size_t m : all)
    losses.add_squared_error(m, data_[m], visible_[m],
                             1.0F / static_cast<float>(batch_ * data_[m].columns()));
  add_contrast(all, weights_);
}

}  // namespace mcdbn
