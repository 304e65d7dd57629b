#pragma once

#include "comparison/dbm_machine.hpp"
#include "comparison/multimodal_dbm.hpp"
#include "device/optimizer.hpp"
#include "learning/minibatch.hpp"

namespace mcdbn {

/// All stages of a multimodal DBM's training, one mini-batch after another.
class DbmTraining {
 public:
  /// @param data the modalities, [frames x visible]  @param settings must live on
  DbmTraining(DbmMachine& machine, const MultimodalDbmSettings& settings,
              const std::array<MatrixF, 2>& data,
              OptimizerKind optimizer = OptimizerKind::momentum);

  /// Greedy stages, then the joint one.
  void run();

  /// CD-1 for a modality's layer, what comes from below doubled.
  void learn_pathway(std::size_t m, std::size_t first, float rate, const RandomKey& draws);
  /// CD-1 for the joint layer on both modalities' hidden units, what comes from above doubled.
  void learn_joint_layer(std::size_t first, float rate, const RandomKey& draws);
  /// At the first windows.
  void start_chains();
  /// All layers: mean field on the data against persistent chains.
  void learn_all(std::size_t first, float rate, const RandomKey& draws);

  MinibatchSchedule& schedule() { return schedule_; }
  DbmMachine::Units& chains() { return chains_; }
  const DbmMachine::Units& data() const { return data_; }
  /// Gradients of the last mini-batch, downhill, in the optimizer's own buffer.
  Parameters gradients() { return machine_.parameters().in(optimizer_.gradients()); }

 private:
  using Learn = std::function<void(std::size_t first, float progress, const RandomKey& draws)>;
  void run_stage(std::size_t epochs, const Learn& learn);
  void clamp(std::size_t m, std::size_t first);
  /// @param learns whether a parameter is of this stage
  void update(float rate, const std::function<bool(const std::string& name)>& learns);

  DbmMachine& machine_;
  const MultimodalDbmSettings& settings_;
  Optimizer optimizer_;
  std::array<Matrix, 2> frames_;
  MinibatchSchedule schedule_;
  DbmMachine::Units data_, chains_;
  RandomKey random_;  ///< of the next mini-batch's draws
};

}  // namespace mcdbn
