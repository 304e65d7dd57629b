#include "comparison/pretrained_rbm.hpp"

#include <numeric>

#include "base/random_phases.hpp"
#include "device/losses.hpp"
#include "learning/contrastive_divergence.hpp"
#include "learning/minibatch.hpp"

namespace mcdbn {

PretrainedRbm pretrained_rbm(Device& device, const MatrixF& data, const CrbmShape& shape,
                             const PretrainingSettings& settings, RandomKey key) {
  CdSettings cd;
  cd.gibbs_steps = 1;
  cd.rate = settings.rate;
  key.phase = random_phases::kFirstWeights;
  Crbm rbm(device, CrbmParameters::random(shape, cd.initial_deviation, key));

  std::vector<std::int32_t> rows(static_cast<std::size_t>(data.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  MinibatchSchedule schedule(device, rows, settings.batch, settings.least_batches);
  ContrastiveDivergence rule(rbm, schedule.batch(), cd);
  LossAccumulator losses(device, rule.loss_count(), schedule.batch());
  const Matrix values = Matrix::from_host(device, data);
  LearningStep step;
  step.random = key;
  step.random.phase = 0;
  for (; step.epoch <= settings.epochs; ++step.epoch) {
    key.step = static_cast<std::uint32_t>(step.epoch);
    key.phase = random_phases::kShuffle;
    schedule.shuffle(key);
    for (std::size_t i = 0; i < schedule.batch_count(); ++i, ++step.random.step) {
      const Rows visible =
          Rows::indexed(values, schedule.index(), schedule.first_of(i), schedule.batch());
      rule.learn({&visible, 1}, step, losses);
    }
  }
  Matrix codes(device, values.rows(), shape.hidden);
  rbm.hidden_probabilities(values, codes);
  return {rbm.to_host(), codes.to_host()};
}

}  // namespace mcdbn
