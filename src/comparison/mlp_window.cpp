#include "comparison/mlp_window.hpp"

#include <algorithm>
#include <cmath>

#include "base/missing_values.hpp"
#include "comparison/clip_pairs.hpp"
#include "device/gemm.hpp"
#include "device/pointwise.hpp"
#include "device/updates.hpp"
#include "learning/minibatch.hpp"
#include "mcdbn/features/standardizer.hpp"

namespace mcdbn {
namespace {

enum RandomPhase : std::uint16_t { kShufflePhase, kWeightPhase, kDropoutPhase };
constexpr std::uint16_t kStream = 0x4d4c;

/// The clip with its ends repeated, so that every frame is the middle of a window.
MatrixF extended(const MatrixF& track) {
  constexpr auto reach = static_cast<Eigen::Index>(MlpWindow::kReach);
  const MatrixF seen = at_mean_where_unknown(track);
  MatrixF rows(track.rows() + 2 * reach, track.cols());
  rows.topRows(reach) = seen.row(0).replicate(reach, 1);
  rows.middleRows(reach, track.rows()) = seen;
  rows.bottomRows(reach) = seen.row(track.rows() - 1).replicate(reach, 1);
  return rows;
}

/// One layer in training: parameters, their transposed copy, gradients and Adam's moments.
class TrainedLayer {
 public:
  TrainedLayer(Device& device, const MlpWindow::Layer& initial)
      : W_(Matrix::from_host(device, initial.W)),
        b_(Matrix::from_host(device, initial.b)),
        W_transposed_(device, W_.columns(), W_.rows()),
        gradient_W_(device, W_.rows(), W_.columns()),
        gradient_b_(device, 1, W_.columns()),
        moments_W_{Matrix::like(W_), Matrix::like(W_)},
        moments_b_{Matrix::like(b_), Matrix::like(b_)} {
    transpose(W_, W_transposed_);
  }

  void forward(const Rows& input, const Rows& output, Activation activation) const {
    GemmOptions options;
    options.bias = &b_;
    options.activation = activation;
    gemm(input, W_, output, options);
  }

  /// Error at this layer's output → error at the output `below` of the rectified layer beneath,
  /// from which drop-out took its part.
  void backward(const Rows& error, const Rows& below, double kept_share,
                const Rows& error_below) const {
    GemmOptions options;
    options.alpha = static_cast<float>(1.0 / kept_share);
    options.activation = Activation::relu_gradient;
    options.factor = &below;
    gemm(error, W_transposed_, error_below, options);
  }

  void update(const Rows& input, const Rows& error, const AdamRule& rule, int step) {
    gemm_transposed_a(input, error, gradient_W_);
    column_sum(error, 1.0F, 0.0F, gradient_b_);
    AdamRule bias_rule = rule;
    bias_rule.weight_decay = 0.0F;
    adam_update(W_, moments_W_[0], moments_W_[1], gradient_W_, rule, step);
    adam_update(b_, moments_b_[0], moments_b_[1], gradient_b_, bias_rule, step);
    transpose(W_, W_transposed_);
  }

  MlpWindow::Layer to_host() const { return {W_.to_host(), b_.to_host()}; }

 private:
  Matrix W_, b_, W_transposed_, gradient_W_, gradient_b_;
  std::array<Matrix, 2> moments_W_, moments_b_;
};

/// Variance 1 / (3 · inputs), as PyTorch starts its linear layers: with the variance of He et al.,
/// six times as much, the error on unseen people is 2 to 3 mm larger. Padding between the frames of
/// a window stays zero, as its inputs are.
MlpWindow::Layer random_layer(std::size_t inputs, std::size_t rows, std::size_t outputs,
                              RandomKey key) {
  const double deviation = std::sqrt(1.0 / (3.0 * static_cast<double>(inputs)));
  MlpWindow::Layer layer{MatrixF(rows, outputs), MatrixF::Zero(1, outputs)};
  for (Eigen::Index r = 0; r < layer.W.rows(); ++r)
    for (Eigen::Index c = 0; c < layer.W.cols(); ++c)
      layer.W(r, c) =
          static_cast<float>(deviation * random_normal(key, static_cast<std::uint32_t>(r),
                                                       static_cast<std::uint32_t>(c)));
  return layer;
}

/// Rows of the clips, one below another, that are the middle of a window.
std::vector<std::int32_t> window_rows(const std::vector<MatrixF>& clips) {
  std::vector<std::int32_t> rows;
  std::size_t first = 0;
  for (const MatrixF& clip : clips) {
    const auto frames = static_cast<std::size_t>(clip.rows());
    for (std::size_t t = MlpWindow::kReach; t + MlpWindow::kReach < frames; ++t)
      rows.push_back(static_cast<std::int32_t>(first + t));
    first += frames;
  }
  return rows;
}

/// The network and a mini-batch's values on the device.
class Trainer {
 public:
  Trainer(Device& device, const MlpWindow::Settings& settings, std::size_t batch,
          const Matrix& tracks, const Matrix& poses)
      : settings_(settings),
        tracks_(tracks),
        poses_(poses),
        layers_(make_layers(device, settings, tracks, poses)),
        hidden_{Matrix(device, batch, settings.hidden), Matrix(device, batch, settings.hidden)},
        errors_{Matrix(device, batch, settings.hidden), Matrix(device, batch, settings.hidden)},
        output_(device, batch, poses.columns()),
        target_(device, batch, poses.columns()) {}

  void step(const IndexBuffer& index, std::size_t first, double rate) {
    ++steps_;
    const std::size_t n = output_.rows();
    const Rows input = Rows::indexed(tracks_, index, first, n, -static_cast<int>(MlpWindow::kReach),
                                     MlpWindow::kFrames);
    gather(Rows::indexed(poses_, index, first, n), target_);
    const double kept = 1.0 - settings_.dropout;
    layers_[0].forward(input, hidden_[0], Activation::relu);
    drop(0);
    layers_[1].forward(hidden_[0], hidden_[1], Activation::relu);
    drop(1);
    layers_[2].forward(hidden_[1], output_, Activation::none);

    // The squared error's gradient, but for a factor that Adam does not see.
    scaled_difference(output_, target_, 1.0F / static_cast<float>(n), output_);
    layers_[2].backward(output_, hidden_[1], kept, errors_[1]);
    layers_[1].backward(errors_[1], hidden_[0], kept, errors_[0]);
    AdamRule rule;
    rule.rate = static_cast<float>(rate);
    rule.weight_decay = static_cast<float>(settings_.weight_decay);
    layers_[2].update(hidden_[1], output_, rule, steps_);
    layers_[1].update(hidden_[0], errors_[1], rule, steps_);
    layers_[0].update(input, errors_[0], rule, steps_);
  }

  std::array<MlpWindow::Layer, 3> to_host() const {
    return {layers_[0].to_host(), layers_[1].to_host(), layers_[2].to_host()};
  }

 private:
  static std::array<TrainedLayer, 3> make_layers(Device& device,
                                                 const MlpWindow::Settings& settings,
                                                 const Matrix& tracks, const Matrix& poses) {
    RandomKey key{settings.seed, 0, kStream, kWeightPhase};
    const auto layer = [&](std::size_t inputs, std::size_t rows, std::size_t outputs) {
      ++key.step;
      return TrainedLayer(device, random_layer(inputs, rows, outputs, key));
    };
    // Read in place, a window of frames has their padding in it.
    return {layer(MlpWindow::kFrames * tracks.columns(), MlpWindow::kFrames * tracks.stride(),
                  settings.hidden),
            layer(settings.hidden, settings.hidden, settings.hidden),
            layer(settings.hidden, settings.hidden, poses.columns())};
  }

  void drop(std::size_t layer) {
    if (settings_.dropout == 0.0) return;
    dropout(hidden_[layer], static_cast<float>(1.0 - settings_.dropout),
            {settings_.seed, static_cast<std::uint32_t>(steps_),
             static_cast<std::uint16_t>(kStream + 1 + layer), kDropoutPhase});
  }

  const MlpWindow::Settings& settings_;
  const Matrix& tracks_;
  const Matrix& poses_;
  int steps_ = 0;
  std::array<TrainedLayer, 3> layers_;
  std::array<Matrix, 2> hidden_, errors_;
  Matrix output_, target_;
};

}  // namespace

void MlpWindow::fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  check_clip_pairs(tracks, poses);
  std::vector<MatrixF> inputs, targets;
  for (std::size_t clip = 0; clip < tracks.size(); ++clip) {
    if (tracks[clip].rows() == 0) continue;
    inputs.push_back(extended(tracks[clip]));
    targets.push_back(extended(poses[clip]));
  }
  MinibatchSchedule schedule(*device_, window_rows(inputs), settings_.batch,
                             settings_.least_batches);

  const Matrix track_frames = Matrix::from_host(*device_, stacked(inputs));
  const Matrix pose_frames = Matrix::from_host(*device_, stacked(targets));
  Trainer trainer(*device_, settings_, schedule.batch(), track_frames, pose_frames);
  const std::size_t batches = schedule.batch_count();
  for (std::size_t epoch = 0; epoch < settings_.epochs; ++epoch) {
    schedule.shuffle({settings_.seed, static_cast<std::uint32_t>(epoch), kStream, kShufflePhase});
    for (std::size_t i = 0; i < batches; ++i) {
      const double progress = static_cast<double>(epoch * batches + i) /
                              static_cast<double>(settings_.epochs * batches);
      trainer.step(schedule.index(), schedule.first_of(i),
                   settings_.rate * std::min(1.0, 2.0 - 1.98 * progress));
    }
  }
  layers_ = trainer.to_host();
  track_dimension_ = tracks.front().cols();
}

MatrixF MlpWindow::predict(const MatrixF& track) const {
  check_track(track, track_dimension_);
  if (track.rows() == 0) return MatrixF(0, layers_.back().W.cols());
  const Matrix frames = Matrix::from_host(*device_, extended(track));
  const auto count = static_cast<std::size_t>(track.rows());
  Matrix values;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const Matrix W = Matrix::from_host(*device_, layers_[i].W);
    const Matrix b = Matrix::from_host(*device_, layers_[i].b);
    Matrix output(*device_, count, W.columns());
    GemmOptions options;
    options.bias = &b;
    if (i + 1 < layers_.size()) options.activation = Activation::relu;
    gemm(i == 0 ? Rows::strided(frames, 0, count, 1, kFrames) : Rows(values), W, output, options);
    device_->queue().finish();  // W and b live no longer than this
    values = std::move(output);
  }
  return values.to_host();
}

}  // namespace mcdbn
