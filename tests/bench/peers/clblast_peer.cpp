// The CRBM steps of `mcdbn-cl bench` with CLBlast's products and one elementwise kernel after each.

#include "device/gemm.hpp"
#include "device/losses.hpp"
#include "device/optimizer.hpp"
#include "device/pointwise.hpp"
#include "mcdbn/machines/crbm.hpp"
#include "peer.hpp"

using namespace mcdbn;

namespace {

Matrix like(const Matrix& matrix) {
  return {matrix.device(), matrix.rows(), matrix.columns()};
}

class CrbmStep {
 public:
  CrbmStep(Device& device, const CrbmShape& shape, std::size_t batch, std::size_t gibbs_steps)
      : crbm_(device, CrbmParameters::random(shape, 0.01, {})),
        frames_(Matrix::from_host(
            device, MatrixF::Random(peer::kFrames, static_cast<Eigen::Index>(shape.visible)))),
        index_(device, peer::random_rows(batch)),
        gibbs_steps_(gibbs_steps),
        data_(device, batch, shape.visible),
        visible_(like(data_)),
        bias_v_(like(data_)),
        history_(device, batch, crbm_.A.rows()),
        hidden_data_(device, batch, shape.hidden),
        hidden_(like(hidden_data_)),
        sample_(like(hidden_data_)),
        bias_h_(like(hidden_data_)),
        optimizer_(crbm_.parameters(), OptimizerKind::momentum),
        losses_(device, 1, batch) {
    const Parameters gradients = crbm_.parameters().in(optimizer_.gradients());
    for (const char* name : {"W", "A", "B", "a", "b"}) gradients_.push_back(gradients.matrix(name));
  }

  void operator()() {
    const std::size_t n = data_.rows();
    const Rows rows = Rows::indexed(frames_, index_, 0, n);
    gather(rows, data_);
    gather(crbm_.history(rows), history_);
    product(history_, crbm_.A, bias_v_, crbm_.a, Activation::none);
    product(history_, crbm_.B, bias_h_, crbm_.b, Activation::none);
    ++key_.step;
    key_.phase = 0;
    units(data_, crbm_.W, hidden_data_, true);
    for (std::size_t k = 1; k <= gibbs_steps_; ++k) {
      product(sample_, crbm_.W_transposed, visible_, bias_v_,
              crbm_.shape().kind == VisibleKind::binary ? Activation::sigmoid : Activation::none);
      key_.phase = static_cast<std::uint16_t>(k);
      units(visible_, crbm_.W, hidden_, k < gibbs_steps_);
    }
    losses_.add_squared_error(0, data_, visible_, 1.0F);
    update(1.0F / static_cast<float>(n));
  }

 private:
  static void product(const Matrix& x, const Matrix& w, const Matrix& out, const Matrix& bias,
                      Activation activation) {
    GemmOptions options;
    options.backend = GemmBackend::clblast;
    options.bias = &bias;
    options.activation = activation;
    gemm(x, w, out, options);
  }

  void units(const Matrix& x, const Matrix& w, const Matrix& out, bool drawn) {
    const Rows sample(sample_);
    GemmOptions options;
    options.backend = GemmBackend::clblast;
    options.bias = &bias_h_;
    options.activation = Activation::sigmoid;
    if (drawn) {
      options.sampling = Sampling::bernoulli;
      options.sample = &sample;
      options.random = key_;
    }
    gemm(x, w, out, options);
  }

  void update(float mean) {
    constexpr auto kClblast = GemmBackend::clblast;
    gemm_transposed_a(data_, hidden_data_, gradients_[0], -mean, 0.0F, kClblast);
    gemm_transposed_a(visible_, hidden_, gradients_[0], mean, 1.0F, kClblast);
    scaled_difference(visible_, data_, mean, visible_);
    scaled_difference(hidden_, hidden_data_, mean, hidden_);
    gemm_transposed_a(history_, visible_, gradients_[1], 1.0F, 0.0F, kClblast);
    gemm_transposed_a(history_, hidden_, gradients_[2], 1.0F, 0.0F, kClblast);
    column_sum(visible_, 1.0F, 0.0F, gradients_[3]);
    column_sum(hidden_, 1.0F, 0.0F, gradients_[4]);
    optimizer_.update([](const ParameterShape& shape) {
      return UpdateRule{shape.name == "A" ? peer::kRateA : peer::kRate, peer::kMomentum,
                        shape.is_weight ? peer::kDecay : 0.0F};
    });
    crbm_.refresh_transposed();
  }

  Crbm crbm_;
  Matrix frames_;
  IndexBuffer index_;
  std::size_t gibbs_steps_;
  Matrix data_, visible_, bias_v_, history_, hidden_data_, hidden_, sample_, bias_h_;
  Optimizer optimizer_;
  std::vector<Matrix> gradients_;
  LossAccumulator losses_;
  RandomKey key_;
};

}  // namespace

int main(int argc, char** argv) {
  const peer::Arguments arguments = peer::arguments(argc, argv);
  const bool gaussian = arguments.layer == "gaussian_crbm";
  if (!gaussian && arguments.layer != "binary_crbm") return 0;
  Device device = Device::open();
  CrbmStep step(device,
                gaussian ? CrbmShape{96, peer::kHidden, peer::kOrder, VisibleKind::gaussian}
                         : CrbmShape{300, peer::kHidden, peer::kOrder, VisibleKind::binary},
                arguments.batch, gaussian ? 5 : 1);
  peer::serve(
      "CLBlast + elementwise", arguments.seconds, [&] { step(); }, [&] { device.finish(); });
  return 0;
}
