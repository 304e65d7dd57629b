#include "comparison/dbm_training.hpp"

#include <numeric>

#include "base/random_phases.hpp"
#include "base/random_streams.hpp"
#include "device/pointwise.hpp"
#include "learning/rate_schedule.hpp"

namespace mcdbn {
namespace {

constexpr std::uint16_t kPhasesPerSweep = 5;

std::vector<std::int32_t> all_rows(const MatrixF& values) {
  std::vector<std::int32_t> rows(static_cast<std::size_t>(values.rows()));
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

}  // namespace

DbmTraining::DbmTraining(DbmMachine& machine, const MultimodalDbmSettings& settings,
                         const std::array<MatrixF, 2>& data, OptimizerKind optimizer)
    : machine_(machine),
      settings_(settings),
      optimizer_(machine.parameters(), optimizer),
      frames_{Matrix::from_host(machine.device(), data[0]),
              Matrix::from_host(machine.device(), data[1])},
      schedule_(machine.device(), all_rows(data[0]), settings.batch, settings.least_batches),
      data_(machine.device(), machine.shape(), schedule_.batch()),
      chains_(machine.device(), machine.shape(), schedule_.batch()),
      random_{settings.seed, 0, random_streams::kBoltzmannMachine, 0} {
  optimizer_.gradients();
}

void DbmTraining::run() {
  const auto rate = static_cast<float>(settings_.pretraining_rate);
  for (std::size_t m = 0; m < 2; ++m)
    run_stage(settings_.pretraining_epochs, [&](std::size_t first, float, const RandomKey& draws) {
      learn_pathway(m, first, rate, draws);
    });
  // Binary units bear a higher rate than Gaussian ones, as in the greedy schedule.
  run_stage(settings_.pretraining_epochs, [&](std::size_t first, float, const RandomKey& draws) {
    learn_joint_layer(first, 10 * rate, draws);
  });
  start_chains();
  run_stage(settings_.epochs, [&](std::size_t first, float progress, const RandomKey& draws) {
    learn_all(first, static_cast<float>(settings_.rate) * linear_fall(progress), draws);
  });
  machine_.device().queue().finish();  // what this holds lives no longer
}

void DbmTraining::run_stage(std::size_t epochs, const Learn& learn) {
  const std::size_t batches = schedule_.batch_count();
  for (std::size_t i = 0; i < epochs * batches; ++i, ++random_.step) {
    if (i % batches == 0) {
      RandomKey shuffle = random_;
      shuffle.phase = random_phases::kShuffle;
      schedule_.shuffle(shuffle);
    }
    learn(schedule_.first_of(i % batches),
          static_cast<float>(i) / static_cast<float>(epochs * batches), random_);
  }
}

void DbmTraining::clamp(std::size_t m, std::size_t first) {
  gather(Rows::indexed(frames_[m], schedule_.index(), first, schedule_.batch()), data_.visible[m]);
}

void DbmTraining::start_chains() {
  for (std::size_t m = 0; m < 2; ++m) {
    clamp(m, 0);
    chains_.visible[m].copy_from(data_.visible[m]);
  }
  machine_.mean_field(data_, DbmMachine::kNoneAbsent, settings_.mean_field_steps);
  chains_.joint.copy_from(data_.joint);
}

void DbmTraining::learn_pathway(std::size_t m, std::size_t first, float rate,
                                const RandomKey& draws) {
  const float mean = 1.0F / static_cast<float>(schedule_.batch());
  clamp(m, first);
  machine_.set_input_from_below(m, data_, 2.0F);
  machine_.infer_hidden_from_below(m, data_, &draws);
  machine_.infer_visible(m, data_.hidden_draws[m], chains_);
  machine_.set_input_from_below(m, chains_, 2.0F);
  machine_.infer_hidden_from_below(m, chains_);
  const Parameters gradient = gradients();
  machine_.add_energy_gradient(data_, mean, 0.0F, gradient);
  machine_.add_energy_gradient(chains_, -mean, 1.0F, gradient);
  const std::string modality = m == 0 ? "track" : "pose";
  update(rate,
         [&](const std::string& name) { return name[0] != 'U' && name.ends_with("_" + modality); });
}

void DbmTraining::learn_joint_layer(std::size_t first, float rate, const RandomKey& draws) {
  const float mean = 1.0F / static_cast<float>(schedule_.batch());
  for (std::size_t m = 0; m < 2; ++m) {
    clamp(m, first);
    machine_.set_input_from_below(m, data_, 2.0F);
    machine_.infer_hidden_from_below(m, data_);
  }
  machine_.infer_joint(data_.hidden, chains_, &draws);
  for (std::size_t m = 0; m < 2; ++m) machine_.infer_hidden_from_above(m, chains_);
  machine_.infer_joint(data_.hidden, data_);
  machine_.infer_joint(chains_.hidden, chains_);
  const Parameters gradient = gradients();
  machine_.add_energy_gradient(data_, mean, 0.0F, gradient);
  machine_.add_energy_gradient(chains_, -mean, 1.0F, gradient);
  update(rate, [](const std::string& name) {
    return name[0] == 'U' || name[0] == 'b' || name[0] == 'c';
  });
}

void DbmTraining::learn_all(std::size_t first, float rate, const RandomKey& draws) {
  const float mean = 1.0F / static_cast<float>(schedule_.batch());
  for (std::size_t m = 0; m < 2; ++m) clamp(m, first);
  machine_.mean_field(data_, DbmMachine::kNoneAbsent, settings_.mean_field_steps);
  RandomKey sweep = draws;
  for (std::size_t k = 0; k < settings_.gibbs_sweeps; ++k, sweep.phase += kPhasesPerSweep)
    machine_.gibbs_sweep(chains_, sweep);
  // Probabilities of the chains' hidden units carry more information than draws.
  for (std::size_t m = 0; m < 2; ++m) {
    machine_.set_input_from_below(m, chains_);
    machine_.infer_hidden(m, chains_);
  }
  const Parameters gradient = gradients();
  machine_.add_energy_gradient(data_, mean, 0.0F, gradient);
  machine_.add_energy_gradient(chains_, -mean, 1.0F, gradient);
  update(rate, [](const std::string&) { return true; });
}

void DbmTraining::update(float rate, const std::function<bool(const std::string& name)>& learns) {
  optimizer_.next_step();
  optimizer_.update([&](const ParameterShape& shape) {
    UpdateRule rule{rate, static_cast<float>(settings_.momentum),
                    static_cast<float>(settings_.weight_decay)};
    if (!learns(shape.name)) rule.rate = rule.momentum = 0.0F;
    return rule;
  });
  machine_.refresh_transposed();
}

}  // namespace mcdbn
