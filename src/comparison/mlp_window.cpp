#include "comparison/mlp_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/missing_values.hpp"
#include "base/random_streams.hpp"
#include "comparison/clip_pairs.hpp"
#include "device/gemm.hpp"
#include "device/optimizer.hpp"
#include "device/pointwise.hpp"
#include "learning/minibatch.hpp"
#include "mcdbn/features/standardizer.hpp"

namespace mcdbn {
namespace {

enum RandomPhase : std::uint16_t { kShufflePhase, kWeightPhase, kDropoutPhase };
constexpr std::uint16_t kStream = random_streams::kPerceptron;

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

/// `0.W`
std::string name_of(std::size_t layer, const char* letter) {
  return fmt::format("{}.{}", layer, letter);
}

std::vector<ParameterShape> parameter_shapes(const std::vector<MlpWindow::Layer>& layers) {
  std::vector<ParameterShape> shapes;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const auto rows = static_cast<std::size_t>(layers[i].W.rows());
    const auto columns = static_cast<std::size_t>(layers[i].W.cols());
    shapes.push_back({.name = name_of(i, "W"), .rows = rows, .columns = columns});
    shapes.push_back({.name = name_of(i, "b"), .rows = 1, .columns = columns, .is_weight = false});
  }
  return shapes;
}

/// One layer in training: its parameters and gradients, and the transposed copy of W.
class TrainedLayer {
 public:
  TrainedLayer(const Parameters& parameters, const Parameters& gradients, std::size_t number)
      : W_(parameters.matrix(name_of(number, "W"))),
        b_(parameters.matrix(name_of(number, "b"))),
        gradient_W_(gradients.matrix(name_of(number, "W"))),
        gradient_b_(gradients.matrix(name_of(number, "b"))),
        W_transposed_(W_.device(), W_.columns(), W_.rows()) {
    refresh();
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

  void differentiate(const Rows& input, const Rows& error) {
    gemm_transposed_a(input, error, gradient_W_);
    column_sum(error, 1.0F, 0.0F, gradient_b_);
  }

  /// After W changed.
  void refresh() { transpose(W_, W_transposed_); }

  MlpWindow::Layer to_host() const { return {W_.to_host(), b_.to_host()}; }

 private:
  Matrix W_, b_, gradient_W_, gradient_b_, W_transposed_;
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
        optimizer_(start(device, first_layers(settings, tracks, poses)), OptimizerKind::adam),
        layers_(make_layers()),
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
    layers_[2].differentiate(hidden_[1], output_);
    layers_[1].differentiate(hidden_[0], errors_[1]);
    layers_[0].differentiate(input, errors_[0]);
    const UpdateRule rule =
        UpdateRule::adam(static_cast<float>(rate), static_cast<float>(settings_.weight_decay));
    optimizer_.next_step();
    optimizer_.update(rule);
    for (TrainedLayer& layer : layers_) layer.refresh();
  }

  std::array<MlpWindow::Layer, 3> to_host() const {
    return {layers_[0].to_host(), layers_[1].to_host(), layers_[2].to_host()};
  }

 private:
  static std::vector<MlpWindow::Layer> first_layers(const MlpWindow::Settings& settings,
                                                    const Matrix& tracks, const Matrix& poses) {
    RandomKey key{settings.seed, 0, kStream, kWeightPhase};
    const auto layer = [&](std::size_t inputs, std::size_t rows, std::size_t outputs) {
      ++key.step;
      return random_layer(inputs, rows, outputs, key);
    };
    // Read in place, a window of frames has their padding in it.
    return {layer(MlpWindow::kFrames * tracks.columns(), MlpWindow::kFrames * tracks.stride(),
                  settings.hidden),
            layer(settings.hidden, settings.hidden, settings.hidden),
            layer(settings.hidden, settings.hidden, poses.columns())};
  }

  static Parameters start(Device& device, const std::vector<MlpWindow::Layer>& layers) {
    Parameters parameters(device, parameter_shapes(layers));
    for (std::size_t i = 0; i < layers.size(); ++i) {
      parameters.upload(name_of(i, "W"), layers[i].W);
      parameters.upload(name_of(i, "b"), layers[i].b);
    }
    return parameters;
  }

  std::array<TrainedLayer, 3> make_layers() {
    const Parameters& parameters = optimizer_.parameters();
    const Parameters gradients = parameters.in(optimizer_.gradients());
    return {TrainedLayer(parameters, gradients, 0), TrainedLayer(parameters, gradients, 1),
            TrainedLayer(parameters, gradients, 2)};
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
  Optimizer optimizer_;
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
