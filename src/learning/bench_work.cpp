#include "learning/bench_work.hpp"

#include "mcdbn/device/matrix.hpp"

namespace mcdbn {
namespace {

constexpr double kFloat = sizeof(float);

double padded_units(std::size_t units) {
  return static_cast<double>(padded(units));
}

}  // namespace

std::vector<KernelWork> contrastive_divergence_work(const CrbmShape& shape, std::size_t batch,
                                                    std::size_t gibbs_steps) {
  const auto v = static_cast<double>(shape.visible), h = static_cast<double>(shape.hidden);
  const auto order_a = static_cast<double>(shape.order_A()),
             order_b = static_cast<double>(shape.order_B());
  const auto k = static_cast<double>(gibbs_steps), n = static_cast<double>(batch);
  const double directed = order_a * v * v + order_b * v * h;
  const double wide_v = padded_units(shape.visible), wide_h = padded_units(shape.hidden);
  const double weights = wide_v * wide_h,
               all_directed = order_a * wide_v * wide_v + order_b * wide_v * wide_h;
  const double history = n * static_cast<double>(shape.order) * wide_v;
  // Three matrices of visible and hidden units: the data, the chain's end, their difference.
  const double units = 3.0 * n * (wide_v + wide_h);
  return {{"gibbs_chain", 2.0 * n * (directed + (1.0 + 2.0 * k) * v * h),
           kFloat * (2.0 * weights + all_directed + history + n * wide_v + units)},
          // A parameter and its velocity are read and written; the transposed copy is written.
          {"cd_update", 2.0 * n * (directed + 2.0 * v * h),
           kFloat * (history + units + 5.0 * weights + 4.0 * all_directed)}};
}

std::vector<KernelWork> multi_prediction_work(std::size_t modalities, std::size_t visible,
                                              std::size_t hidden, std::size_t batch,
                                              std::size_t steps) {
  const auto m = static_cast<double>(modalities), t = static_cast<double>(steps);
  const auto n = static_cast<double>(batch);
  const double product = 2.0 * n * static_cast<double>(visible * hidden);
  const double wide_v = padded_units(visible), wide_h = padded_units(hidden);
  const double weights = m * wide_v * wide_h;
  const double stacks = m * t * n * 2.0 * (wide_v + wide_h);
  // A direction: the present modalities' input; T downs, T − 1 ups (the first starts from zeros),
  // and as many of their back-propagation and of their gradients.
  return {{"multi_prediction", m * product * (m - 1.0 + 4.0 * t - 2.0),
           kFloat * (2.0 * weights + m * n * (wide_v + 2.0 * wide_h) + stacks)},
          {"multi_prediction_products", m * product * (m - 1.0 + 2.0 * t - 1.0),
           kFloat * (stacks + m * n * (wide_v + wide_h))},
          {"multi_prediction_update", 0.0, kFloat * 7.0 * weights}};
}

std::vector<KernelWork> joint_likelihood_work(std::size_t modalities, std::size_t visible,
                                              std::size_t hidden, std::size_t batch,
                                              std::size_t gibbs_steps) {
  const auto m = static_cast<double>(modalities), k = static_cast<double>(gibbs_steps);
  const auto n = static_cast<double>(batch);
  const double product = 2.0 * n * m * static_cast<double>(visible * hidden);
  const double wide_v = m * padded_units(visible), wide_h = padded_units(hidden);
  const double units = 2.0 * n * (wide_v + wide_h);
  return {{"joint_chain", product * (1.0 + 2.0 * k), kFloat * (2.0 * wide_v * wide_h + units)},
          {"joint_likelihood_update", 2.0 * product, kFloat * (units + 7.0 * wide_v * wide_h)}};
}

double unrolled_flops(const Mcdbn& network, std::size_t absent, const SequenceWindows& windows,
                      const FineTuningSettings& settings) {
  const auto rows = static_cast<double>(windows.count * (windows.frames - windows.first));
  const auto shared = static_cast<double>(network.mrbm.hidden());
  const auto t = static_cast<double>(settings.mean_field_steps);
  double multiply_adds = 0;
  for (std::size_t m = 0; m < network.modality_count(); ++m) {
    const auto& layers = network.cdbns[m].layers;
    for (const Crbm& layer : layers) {
      const CrbmShape& shape = layer.shape();
      const auto v = static_cast<double>(shape.visible), h = static_cast<double>(shape.hidden);
      const auto order_a = static_cast<double>(shape.order_A()),
                 order_b = static_cast<double>(shape.order_B());
      // Values, gradients and, where something lies before it, errors.
      if (m == absent)
        multiply_adds += 3.0 * (v * h + order_a * v * v);
      else
        multiply_adds += (&layer == &layers.front() ? 2.0 : 3.0) * (1.0 + order_b) * v * h;
    }
    const double product = static_cast<double>(network.mrbm.visible(m)) * shared;
    // T products down and T − 1 up, as the first starts from zeros; as many errors and gradients.
    multiply_adds += product * (m == absent ? 3.0 * (2.0 * t - 1.0) : 3.0);
  }
  return 2.0 * multiply_adds * rows;
}

double flops_of(const std::vector<KernelWork>& work) {
  double flops = 0;
  for (const KernelWork& kernel : work) flops += kernel.flops;
  return flops;
}

}  // namespace mcdbn
