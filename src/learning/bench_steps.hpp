#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "device/kernel_rates.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// One thing to measure. `run` enqueues it once; it owns the matrices that it works on.
struct BenchStep {
  nlohmann::ordered_json what;  ///< layer, sizes, batch and so on
  double flops = 0;             ///< useful arithmetic of one run, 2 a multiply-add; 0: not counted
  std::function<void()> run;
  std::vector<KernelWork> kernels = {};  ///< as far as they are counted one by one
};

/// Makes a step when its turn comes: its matrices alone may take as long as running it.
struct BenchStepMaker {
  std::string layer;  ///< as `what` names it
  std::function<BenchStep(Device&)> make;
};

/// The mini-batch step of each kind of CRBM: what a tuner looks at.
std::vector<BenchStepMaker> crbm_minibatch_steps(std::size_t batch);

/// The mini-batch step of every kind of layer at batch 100 and 1024, the MRBM's inference, the
/// products of the model's sizes by both back ends, fine_tuning_steps, and the regeneration and
/// free generation of ten samples of 1,000 frames.
std::vector<BenchStepMaker> bench_steps();

/// A mini-batch of fine-tuning with the default settings, of one direction and of both, and with
/// squared errors alone (bench_fine_tuning.cpp).
std::vector<BenchStepMaker> fine_tuning_steps();

/// An epoch of a CRBM over a thousand to a million frames: whether the cost is that of the data.
std::vector<BenchStepMaker> epoch_steps();

}  // namespace mcdbn
