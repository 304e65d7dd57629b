#pragma once

#include <cstddef>
#include <vector>

#include "device/kernel_rates.hpp"
#include "mcdbn/learning/fine_tuning_settings.hpp"
#include "mcdbn/learning/sequence_loss.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// A mini-batch of CD-k by its two kernels: dynamic biases, up, k times down and up; every
/// gradient.
std::vector<KernelWork> contrastive_divergence_work(const CrbmShape& shape, std::size_t batch,
                                                    std::size_t gibbs_steps);

/// One of multi-prediction of an MRBM whose modalities have `visible` units each, by the kernels of
/// its unrolled mean field and of its products, and that which updates.
std::vector<KernelWork> multi_prediction_work(std::size_t modalities, std::size_t visible,
                                              std::size_t hidden, std::size_t batch,
                                              std::size_t steps);

/// One of the joint likelihood of the same by its two kernels.
std::vector<KernelWork> joint_likelihood_work(std::size_t modalities, std::size_t visible,
                                              std::size_t hidden, std::size_t batch,
                                              std::size_t gibbs_steps);

/// Arithmetic of one direction of fine-tuning and its back-propagation (unrolled_pass.hpp), of the
/// frames from SequenceWindows::first on. What does not depend on the data, the mean field's start,
/// does not count.
double unrolled_flops(const Mcdbn& network, std::size_t absent, const SequenceWindows& windows,
                      const FineTuningSettings& settings);

/// Floating-point operations of all kernels together.
double flops_of(const std::vector<KernelWork>& work);

}  // namespace mcdbn
