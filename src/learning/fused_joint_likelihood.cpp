// The two launches of a fused mini-batch.

#include "device/kernel_arguments.hpp"
#include "learning/code_stack.hpp"
#include "learning/joint_likelihood.hpp"
#include "machines/mrbm_chain.hpp"

namespace mcdbn {

Defines JointLikelihood::fused_defines() const {
  Defines defines = shape_defines(mrbm_);
  defines["VEC"] = tile_->vector_width;
  return defines;
}

void JointLikelihood::fused_chain(const RandomKey& key) {
  Defines defines = with_tile(fused_defines(), *tile_);
  defines["ALL_UNITS"] = to_int(all_units(mrbm_));
  if (settings_.sample_visible) defines["SAMPLE_VISIBLE"] = 1;
  if (settings_.persistent) defines["PERSISTENT"] = 1;
  Device& device = mrbm_.device();
  cl::Kernel& kernel = device.programs().kernel("joint_likelihood.cl", "joint_chain", defines);
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t blocks = block_ / static_cast<std::size_t>(tile_->rows);
  launch(device, kernel, {{blocks * group, 1}, {group, 1}}, mrbm_.layout().buffer(), to_int(batch_),
         to_int(block_), mrbm_.parameters().all().buffer(), mrbm_.transposed().all().buffer(),
         codes_.buffer(), stacked_visible_.buffer(), hidden_data_.buffer(), hidden_.buffer(),
         row_losses_.buffer(), to_int(settings_.gibbs_steps), random_argument(key),
         (settings_.persistent ? particles_ : hidden_).buffer(), started_ ? 0 : 1);
}

void JointLikelihood::fused_update(const UpdateRule& rule, LossAccumulator& losses) {
  Defines defines = with_update_tile(fused_defines(), *tile_);
  defines["OPTIMIZER"] = optimizer_.define();
  Device& device = mrbm_.device();
  cl::Kernel& kernel =
      device.programs().kernel("joint_likelihood_update.cl", "joint_likelihood_update", defines);
  const auto vec = static_cast<std::size_t>(tile_->vector_width);
  const auto group = static_cast<std::size_t>(tile_->group);
  // Panels, then a work-item for each vector of the biases, and one for the losses.
  const std::size_t biases = (all_units(mrbm_) + padded(mrbm_.hidden())) / vec;
  const std::size_t groups = all_panels(mrbm_, *tile_) + ceil_divide(biases + 1, group);
  // Sums that wait for the next chunk do so where gradients lie.
  const cl::Buffer& gradients =
      batch_ > kUpdateChunk ? optimizer_.gradients().buffer() : optimizer_.gradient_buffer();
  launch(device, kernel, {{groups * group, 1}, {group, 1}}, mrbm_.layout().buffer(), to_int(batch_),
         to_int(block_), codes_.buffer(), stacked_visible_.buffer(), hidden_data_.buffer(),
         hidden_.buffer(), mrbm_.parameters().all().buffer(), mrbm_.transposed().all().buffer(),
         gradients, optimizer_.state_buffer(), optimizer_.size(), optimizer_.argument(rule),
         row_losses_.buffer(), losses.buffer());
}

}  // namespace mcdbn
