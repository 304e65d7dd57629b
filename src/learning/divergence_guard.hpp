#pragma once

#include <cstddef>
#include <string>

#include "device/training_state.hpp"
#include "mcdbn/learning/cd_settings.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// A guard's advice for a layer: to lower the settings that it uses.
std::string what_to_lower(const CrbmShape& shape, const CdSettings& settings);

/// Stops a run that blows up before it wastes an hour: the loss is not finite, or has grown to
/// several times the best so far.
class DivergenceGuard {
 public:
  DivergenceGuard(std::string stage, std::string advice);
  /// @throws DivergenceError naming stage, epoch, loss and what to lower
  void check(std::size_t epoch, double loss);
  void visit_state(TrainingState& state) { state.number("best_loss", best_); }

 private:
  static constexpr double kGrowth = 4.0;
  std::string stage_, advice_;
  double best_ = -1;
};

}  // namespace mcdbn
