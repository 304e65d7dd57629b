#include "learning/joint_likelihood.hpp"

#include <numeric>

#include "learning/mrbm_rule.hpp"

namespace mcdbn {

JointLikelihood::JointLikelihood(Mrbm& mrbm, std::size_t batch, const MrbmSettings& settings,
                                 std::optional<OptimizerKind> optimizer)
    : MrbmChains(mrbm, batch, settings, optimizer.value_or(optimizer_of(settings))),
      weights_(
          Matrix::from_host(mrbm.device(), MatrixF::Constant(static_cast<Eigen::Index>(batch), 1,
                                                             1.0F / static_cast<float>(batch)))) {
  if (settings.persistent) particles_ = Matrix::like(hidden_sample_);
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
