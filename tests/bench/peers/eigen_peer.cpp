// The mini-batch steps of `mcdbn-cl bench` with Eigen's products, threaded by OpenMP.

#include <Eigen/Core>
#include <array>

#include "peer.hpp"

namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Row = Eigen::Matrix<float, 1, Eigen::Dynamic>;

/// Small and fast (xorshift), one state a thread's row: sampling must not be what is measured.
void draw(const Matrix& p, Matrix& sample, unsigned& seed) {
  seed += 0x9E3779B9U;
#pragma omp parallel for schedule(static)
  for (Eigen::Index r = 0; r < p.rows(); ++r) {
    unsigned state = seed ^ (static_cast<unsigned>(r + 1) * 2654435761U);
    for (Eigen::Index c = 0; c < p.cols(); ++c) {
      state ^= state << 13;
      state ^= state >> 17;
      state ^= state << 5;
      sample(r, c) = static_cast<float>(state >> 8) * 0x1p-24F < p(r, c) ? 1.0F : 0.0F;
    }
  }
}

void apply_sigmoid(Matrix& x) {
#pragma omp parallel for schedule(static)
  for (Eigen::Index r = 0; r < x.rows(); ++r)
    x.row(r) = (1.0F + (-x.row(r).array()).exp()).inverse().matrix();
}

Matrix frames_of(std::size_t visible, bool binary) {
  std::mt19937 generator(2);
  std::normal_distribution<float> normal;
  Matrix frames = Matrix::NullaryExpr(peer::kFrames, static_cast<Eigen::Index>(visible),
                                      [&] { return normal(generator); });
  if (binary) frames = (0.5F + 0.2F * frames.array()).max(0.0F).min(1.0F).matrix();
  return frames;
}

Matrix weights(std::size_t rows, std::size_t columns) {
  return 0.01F *
         Matrix::Random(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
}

struct Parameter {
  Matrix value, velocity;
  explicit Parameter(const Matrix& start) : value(start), velocity(0.0F * start) {}
  void update(const Matrix& gradient, float rate, float decay) {
#pragma omp parallel for schedule(static)
    for (Eigen::Index r = 0; r < value.rows(); ++r) {
      velocity.row(r) =
          peer::kMomentum * velocity.row(r) + rate * (gradient.row(r) - decay * value.row(r));
      value.row(r) += velocity.row(r);
    }
  }
};

class CrbmStep {
 public:
  CrbmStep(std::size_t visible, std::size_t batch, int gibbs_steps, bool binary)
      : frames_(frames_of(visible, binary)),
        rows_(peer::random_rows(batch)),
        W_(weights(visible, peer::kHidden)),
        A_(weights(peer::kOrder * visible, visible)),
        B_(weights(peer::kOrder * visible, peer::kHidden)),
        a_(weights(1, visible)),
        b_(weights(1, peer::kHidden)),
        gibbs_steps_(gibbs_steps),
        binary_(binary) {
    const auto n = static_cast<Eigen::Index>(batch), v = static_cast<Eigen::Index>(visible);
    data_.resize(n, v);
    history_.resize(n, static_cast<Eigen::Index>(peer::kOrder) * v);
    sample_.resize(n, peer::kHidden);
  }

  void operator()() {
    const auto n = static_cast<float>(rows_.size());
    gather();
    bias_v_.noalias() = history_ * A_.value;
    bias_h_.noalias() = history_ * B_.value;
    bias_v_.rowwise() += Row(a_.value);
    bias_h_.rowwise() += Row(b_.value);
    hidden_data_ = bias_h_;
    hidden_data_.noalias() += data_ * W_.value;
    apply_sigmoid(hidden_data_);
    for (int k = 0; k < gibbs_steps_; ++k) {
      draw(k == 0 ? hidden_data_ : hidden_, sample_, seed_);
      visible_ = bias_v_;
      visible_.noalias() += sample_ * W_.value.transpose();
      if (binary_) apply_sigmoid(visible_);
      hidden_ = bias_h_;
      hidden_.noalias() += visible_ * W_.value;
      apply_sigmoid(hidden_);
    }
    gradient_.noalias() = data_.transpose() * hidden_data_;
    gradient_.noalias() -= visible_.transpose() * hidden_;
    W_.update(gradient_ / n, peer::kRate, peer::kDecay);
    visible_ = (data_ - visible_) / n;
    hidden_ = (hidden_data_ - hidden_) / n;
    loss_ += visible_.squaredNorm();
    gradient_.noalias() = history_.transpose() * visible_;
    A_.update(gradient_, peer::kRateA, peer::kDecay);
    gradient_.noalias() = history_.transpose() * hidden_;
    B_.update(gradient_, peer::kRate, peer::kDecay);
    a_.update(visible_.colwise().sum(), peer::kRate, 0.0F);
    b_.update(hidden_.colwise().sum(), peer::kRate, 0.0F);
  }

 private:
  void gather() {
    const Eigen::Index v = frames_.cols();
    for (Eigen::Index r = 0; r < data_.rows(); ++r) {
      const int at = rows_[static_cast<std::size_t>(r)];
      data_.row(r) = frames_.row(at);
      for (int q = 0; q < static_cast<int>(peer::kOrder); ++q)
        history_.block(r, q * v, 1, v) = frames_.row(at - static_cast<int>(peer::kOrder) + q);
    }
  }

  Matrix frames_;
  std::vector<int> rows_;
  Parameter W_, A_, B_, a_, b_;
  int gibbs_steps_;
  bool binary_;
  unsigned seed_ = 1;
  float loss_ = 0;
  Matrix data_, history_, bias_v_, bias_h_, hidden_data_, hidden_, sample_, visible_, gradient_;
};

/// Multi-prediction through ten mean-field steps with its back-propagation by hand; momentum
/// instead of Adam, which is cheaper.
class MrbmStep {
 public:
  static constexpr std::size_t kVisible = 300, kUnits = 150, kSteps = 10;

  explicit MrbmStep(std::size_t batch)
      : frames_{frames_of(kVisible, true), frames_of(kVisible, true)},
        rows_(peer::random_rows(batch)),
        W_{Parameter(weights(kVisible, kUnits)), Parameter(weights(kVisible, kUnits))},
        a_{Parameter(weights(1, kVisible)), Parameter(weights(1, kVisible))},
        b_(weights(1, kUnits)) {
    for (Matrix& code : code_) code.resize(static_cast<Eigen::Index>(batch), kVisible);
  }

  void operator()() {
    for (std::size_t m = 0; m < 2; ++m) {
      for (Eigen::Index r = 0; r < code_[m].rows(); ++r)
        code_[m].row(r) = frames_[m].row(rows_[static_cast<std::size_t>(r)]);
      gradient_W_[m] = Matrix::Zero(kVisible, kUnits);
    }
    gradient_b_ = Matrix::Zero(1, kUnits);
    for (std::size_t present = 0; present < 2; ++present) direction(present, 1 - present);
    for (std::size_t m = 0; m < 2; ++m) {
      W_[m].update(gradient_W_[m], peer::kRate, 0.0F);
      a_[m].update(gradient_a_[m], peer::kRate, 0.0F);
    }
    b_.update(gradient_b_, peer::kRate, 0.0F);
  }

 private:
  void direction(std::size_t present, std::size_t absent) {
    const Matrix& W = W_[absent].value;
    drive_.noalias() = code_[present] * W_[present].value;
    drive_.rowwise() += Row(b_.value);
    for (std::size_t t = 0; t < kSteps; ++t) {
      hidden_[t] = drive_;
      if (t > 0) hidden_[t].noalias() += value_[t - 1] * W;
      apply_sigmoid(hidden_[t]);
      value_[t].noalias() = hidden_[t] * W.transpose();
      value_[t].rowwise() += Row(a_[absent].value);
      apply_sigmoid(value_[t]);
    }
    error_v_ = (value_[kSteps - 1] - code_[absent]) / static_cast<float>(rows_.size());
    drive_error_ = Matrix::Zero(drive_.rows(), drive_.cols());
    gradient_a_[absent] = Matrix::Zero(1, kVisible);
    for (std::size_t t = kSteps; t-- > 0;) {
      gradient_a_[absent] += error_v_.colwise().sum();
      gradient_W_[absent].noalias() += error_v_.transpose() * hidden_[t];
      error_h_.noalias() = error_v_ * W;
      error_h_.array() *= hidden_[t].array() * (1.0F - hidden_[t].array());
      drive_error_ += error_h_;
      if (t == 0) break;
      gradient_W_[absent].noalias() += value_[t - 1].transpose() * error_h_;
      error_v_.noalias() = error_h_ * W.transpose();
      error_v_.array() *= value_[t - 1].array() * (1.0F - value_[t - 1].array());
    }
    gradient_W_[present].noalias() += code_[present].transpose() * drive_error_;
    gradient_b_ += drive_error_.colwise().sum();
  }

  std::array<Matrix, 2> frames_;
  std::vector<int> rows_;
  std::array<Parameter, 2> W_, a_;
  Parameter b_;
  std::array<Matrix, 2> code_, gradient_W_, gradient_a_;
  std::array<Matrix, kSteps> hidden_, value_;
  Matrix drive_, drive_error_, error_v_, error_h_, gradient_b_;
};

}  // namespace

int main(int argc, char** argv) {
  const peer::Arguments arguments = peer::arguments(argc, argv);
  const auto report = [&](auto step) {
    peer::serve(
        "Eigen + OpenMP", arguments.seconds, [&] { step(); }, [] {});
  };
  if (arguments.layer == "gaussian_crbm") report(CrbmStep(96, arguments.batch, 5, false));
  if (arguments.layer == "binary_crbm") report(CrbmStep(300, arguments.batch, 1, true));
  if (arguments.layer == "mrbm") report(MrbmStep(arguments.batch));
  return 0;
}
