#include "learning/mrbm_rule.hpp"

#include "learning/joint_likelihood.hpp"
#include "learning/multi_prediction.hpp"
#include "learning/optimizer_of.hpp"
#include "learning/perceptron_loss.hpp"
#include "learning/rate_schedule.hpp"

namespace mcdbn {

std::unique_ptr<LearningRule> make_mrbm_rule(Mrbm& mrbm, std::size_t batch,
                                             const MrbmSettings& settings) {
  if (settings.joint_likelihood) return std::make_unique<JointLikelihood>(mrbm, batch, settings);
  if (settings.perceptron_loss) return std::make_unique<PerceptronLoss>(mrbm, batch, settings);
  return std::make_unique<MultiPrediction>(mrbm, batch, settings, optimizer_of(settings));
}

UpdateRule mrbm_update_rule(const MrbmSettings& settings, double progress) {
  constexpr double kFlat = 0.5;
  const double share = progress < kFlat ? 1.0 : linear_fall((progress - kFlat) / (1.0 - kFlat));
  UpdateRule rule = UpdateRule::adam(static_cast<float>(settings.rate * share),
                                     static_cast<float>(settings.weight_decay));
  rule.momentum = static_cast<float>(settings.momentum);
  return rule;
}

}  // namespace mcdbn
