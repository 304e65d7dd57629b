#pragma once

#include <memory>

#include "device/optimizer.hpp"
#include "learning/learning_rule.hpp"
#include "mcdbn/learning/mrbm_settings.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {

/// The rule that the settings specify: JointLikelihood, else PerceptronLoss, else MultiPrediction.
std::unique_ptr<LearningRule> make_mrbm_rule(Mrbm& mrbm, std::size_t batch,
                                             const MrbmSettings& settings);

/// Flat, then falling to kFinalRate over the second half, so that the last epochs average out the
/// noise. @param progress 0 … 1, of all mini-batches
UpdateRule mrbm_update_rule(const MrbmSettings& settings, double progress);

}  // namespace mcdbn
