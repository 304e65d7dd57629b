#include "mcdbn/machines/partition.hpp"

#include <cmath>
#include <numbers>

#include "base/random_streams.hpp"
#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"
#include "machines/own_units.hpp"

namespace mcdbn {
namespace {

/// Visible biases of the base distribution. @return [1 x visible]
MatrixF base_bias(const Crbm& crbm, const MatrixF& own) {
  if (crbm.shape().kind == VisibleKind::gaussian) return own;
  const Eigen::ArrayXXf mean = crbm.visible_mean.to_host().array().max(0.05F).min(0.95F);
  return (mean / (1.0F - mean)).log().matrix();
}

/// log Z of the base: Gaussian units of variance 1, or independent binary ones; hidden units are
/// even.
double base_log_partition(const CrbmShape& shape, const MatrixF& bias) {
  double sum = static_cast<double>(shape.hidden) * std::numbers::ln2;
  if (shape.kind == VisibleKind::gaussian)
    return sum + 0.5 * static_cast<double>(shape.visible) * std::log(2.0 * std::numbers::pi);
  for (const float x : bias.reshaped()) sum += std::log1p(std::exp(static_cast<double>(x)));
  return sum;
}

/// The mean of exp(x) and its standard error over it, in logarithms.
LogPartition mean_of_weights(const MatrixF& log_weights) {
  const auto count = static_cast<double>(log_weights.rows());
  const Eigen::ArrayXd x = log_weights.col(0).cast<double>();
  const double largest = x.maxCoeff();
  const Eigen::ArrayXd weights = (x - largest).exp();
  const double mean = weights.mean();
  const double variance = (weights - mean).square().sum() / (count - 1.0);
  return {largest + std::log(mean), std::sqrt(variance / count) / mean};
}

/// Chains on their way from the base distribution to the machine.
class Annealing {
 public:
  Annealing(const Crbm& crbm, const AisSettings& settings, const RowVectorF& history)
      : crbm_(crbm),
        settings_(settings),
        visible_bias_(crbm.device(), 1, crbm.shape().visible),
        hidden_bias_(crbm.device(), 1, crbm.shape().hidden),
        visible_(crbm.device(), settings.chains, crbm.shape().visible),
        visible_mean_(Matrix::like(visible_)),
        hidden_(crbm.device(), settings.chains, crbm.shape().hidden),
        input_(Matrix::like(hidden_)),
        log_weights_(crbm.device(), settings.chains, 1),
        lost_(Matrix::like(log_weights_)) {
    take_history(history);
    const MatrixF own = visible_bias_.to_host(), base = base_bias(crbm, own);
    base_bias_ = Matrix::from_host(crbm.device(), base);
    difference_ = Matrix::from_host(crbm.device(), own - base);
    differences_ = Matrix::filled_with_row(difference_, settings.chains);
    base_log_partition_ = base_log_partition(crbm.shape(), base);
  }

  LogPartition run() {
    draw_visible(0.0F, 0);  // hidden units are zero, their weights too
    const auto last = static_cast<double>(settings_.temperatures);
    for (std::size_t k = 1; k <= settings_.temperatures; ++k) {
      const auto before = static_cast<float>(static_cast<double>(k - 1) / last),
                 after = static_cast<float>(static_cast<double>(k) / last);
      weigh_and_draw_hidden(before, after, k);
      draw_visible(after, k);
    }
    LogPartition result = mean_of_weights(log_weights_.to_host());
    result.value += base_log_partition_;
    return result;
  }

 private:
  enum Phase : std::uint16_t { kHidden, kVisible };

  RandomKey key(std::size_t step, Phase phase) const {
    return {settings_.seed, static_cast<std::uint32_t>(step), random_streams::kAnnealing, phase};
  }

  void take_history(const RowVectorF& history) {
    const CrbmShape& shape = crbm_.shape();
    require(history.size() == static_cast<Eigen::Index>(shape.order * shape.visible),
            "log partition: the history does not fit the machine");
    // The frames of the history, and one more, which it is the history of.
    MatrixF frames = MatrixF::Zero(static_cast<Eigen::Index>(shape.order) + 1,
                                   static_cast<Eigen::Index>(shape.visible));
    frames.topRows(static_cast<Eigen::Index>(shape.order)) = history.reshaped<Eigen::RowMajor>(
        static_cast<Eigen::Index>(shape.order), static_cast<Eigen::Index>(shape.visible));
    const Matrix on_device = in_own_units(crbm_, Matrix::from_host(crbm_.device(), frames));
    const Rows row(on_device, shape.order, 1);
    crbm_.dynamic_visible_bias(row, visible_bias_);
    crbm_.dynamic_hidden_bias(row, hidden_bias_);
  }

  void weigh_and_draw_hidden(float before, float after, std::size_t step) {
    GemmOptions bias;
    bias.bias = &hidden_bias_;
    gemm(visible_, crbm_.W, input_, bias);
    Device& device = crbm_.device();
    cl::Kernel& kernel = device.programs().kernel("energy.cl", "anneal",
                                                  {{"VEC", vector_width(device)}, {"SAMPLE", 1}});
    launch(device, kernel, {{visible_.rows(), 1}}, input_.buffer(), to_int(input_.stride()),
           to_int(input_.columns()), visible_.buffer(), to_int(visible_.stride()),
           difference_.buffer(), to_int(visible_.columns()), before, after, log_weights_.buffer(),
           lost_.buffer(), to_int(log_weights_.stride()), hidden_.buffer(),
           to_int(hidden_.stride()), random_argument(key(step, kHidden)));
  }

  /// v given h at β: the bias is the base's and β times the difference, the weights β·W.
  void draw_visible(float beta, std::size_t step) {
    const bool is_binary = crbm_.shape().kind == VisibleKind::binary;
    visible_mean_.copy_from(differences_);
    const Rows sample(visible_);
    GemmOptions options;
    options.alpha = options.beta = beta;
    options.bias = &base_bias_;
    if (is_binary) options.activation = Activation::sigmoid;
    options.sampling = is_binary ? Sampling::bernoulli : Sampling::gaussian;
    options.sample = &sample;
    options.random = key(step, kVisible);
    gemm(hidden_, crbm_.W_transposed, visible_mean_, options);
  }

  const Crbm& crbm_;
  AisSettings settings_;
  Matrix visible_bias_, hidden_bias_;  // [1 x units], of the history
  Matrix base_bias_, difference_;      // [1 x visible], difference_: the machine's less the base's
  Matrix visible_, visible_mean_, hidden_, input_, differences_;  // [chains x units]
  Matrix log_weights_, lost_;                                     // [chains x 1]
  double base_log_partition_ = 0;
};

}  // namespace

LogPartition log_partition(const Crbm& crbm, const AisSettings& settings,
                           const RowVectorF& history) {
  check_settings(settings);
  return Annealing(crbm, settings, history).run();
}

}  // namespace mcdbn
