#include "comparison/mlp_window.hpp"

#include "base/missing_values.hpp"
#include "base/random_streams.hpp"
#include "comparison/clip_pairs.hpp"
#include "comparison/track_window.hpp"
#include "device/pointwise.hpp"
#include "learning/minibatch.hpp"
#include "mcdbn/features/standardizer.hpp"

namespace mcdbn {
namespace {

enum PerceptronPhase : std::uint16_t { kPerceptronShuffle, kPerceptronWeights, kDropoutPhase };
constexpr std::uint16_t kPerceptronStream = random_streams::kPerceptron;

/// The clip with its ends repeated, so that every frame is the middle of a window.
MatrixF extended(const MatrixF& track) {
  constexpr Eigen::Index reach = kWindowReach;
  const MatrixF seen = at_mean_where_unknown(track);
  MatrixF rows(track.rows() + 2 * reach, track.cols());
  rows.topRows(reach) = seen.row(0).replicate(reach, 1);
  rows.middleRows(reach, track.rows()) = seen;
  rows.bottomRows(reach) = seen.row(track.rows() - 1).replicate(reach, 1);
  return rows;
}

/// Rows of the clips, one below another, that are the middle of a window.
std::vector<std::int32_t> window_rows(const std::vector<MatrixF>& clips) {
  std::vector<std::int32_t> rows;
  std::size_t first = 0;
  for (const MatrixF& clip : clips) {
    const auto frames = static_cast<std::size_t>(clip.rows());
    for (auto t = static_cast<std::size_t>(kWindowReach); t + kWindowReach < frames; ++t)
      rows.push_back(static_cast<std::int32_t>(first + t));
    first += frames;
  }
  return rows;
}

/// The network and a mini-batch's values on the device.
class PerceptronTrainer {
 public:
  PerceptronTrainer(Device& device, const MlpWindow::Settings& settings, std::size_t batch,
                    const Matrix& tracks, const Matrix& poses)
      : settings_(settings),
        tracks_(tracks),
        poses_(poses),
        network_(device, first_layers(settings, tracks, poses)),
        hidden_{Matrix(device, batch, settings.hidden), Matrix(device, batch, settings.hidden)},
        errors_{Matrix(device, batch, settings.hidden), Matrix(device, batch, settings.hidden)},
        output_(device, batch, poses.columns()),
        target_(device, batch, poses.columns()) {}

  void step(const IndexBuffer& index, std::size_t first, double rate) {
    ++steps_;
    const std::size_t n = output_.rows();
    const Rows input = Rows::indexed(tracks_, index, first, n, -static_cast<int>(kWindowReach),
                                     static_cast<std::size_t>(kWindowFrames));
    gather(Rows::indexed(poses_, index, first, n), target_);
    network_.forward(0, input, hidden_[0], Activation::relu);
    drop(0);
    network_.forward(1, hidden_[0], hidden_[1], Activation::relu);
    drop(1);
    network_.forward(2, hidden_[1], output_);

    // The squared error's gradient, but for a factor that Adam does not see.
    scaled_difference(output_, target_, 1.0F / static_cast<float>(n), output_);
    back(2, output_, 1);
    back(1, errors_[1], 0);
    network_.differentiate(2, hidden_[1], output_);
    network_.differentiate(1, hidden_[0], errors_[1]);
    network_.differentiate(0, input, errors_[0]);
    network_.update(
        UpdateRule::adam(static_cast<float>(rate), static_cast<float>(settings_.weight_decay)));
  }

  std::vector<DenseLayer> to_host() const { return network_.to_host(); }

 private:
  /// With the variance of He et al., six times as much, the error on unseen people is 2 to 3 mm
  /// larger. Padding between the frames of a window stays zero, as its inputs are.
  static std::vector<DenseLayer> first_layers(const MlpWindow::Settings& settings,
                                              const Matrix& tracks, const Matrix& poses) {
    RandomKey key{settings.seed, 0, kPerceptronStream, kPerceptronWeights};
    const auto layer = [&](std::size_t inputs, std::size_t rows, std::size_t outputs) {
      ++key.step;
      return random_dense_layer(inputs, rows, outputs, key);
    };
    // Read in place, a window of frames has their padding in it.
    return {
        layer(kWindowFrames * tracks.columns(), kWindowFrames * tracks.stride(), settings.hidden),
        layer(settings.hidden, settings.hidden, settings.hidden),
        layer(settings.hidden, settings.hidden, poses.columns())};
  }

  /// Error at a layer's output → error at the rectified units beneath, of which drop-out took its
  /// part.
  void back(std::size_t layer, const Rows& error, std::size_t below) {
    const Rows units = hidden_[below];
    network_.backward(layer, error, errors_[below],
                      {.gradient = Activation::relu_gradient,
                       .units = &units,
                       .scale = static_cast<float>(1.0 / (1.0 - settings_.dropout))});
  }

  void drop(std::size_t layer) {
    if (settings_.dropout == 0.0) return;
    dropout(hidden_[layer], static_cast<float>(1.0 - settings_.dropout),
            {settings_.seed, static_cast<std::uint32_t>(steps_),
             static_cast<std::uint16_t>(kPerceptronStream + 1 + layer), kDropoutPhase});
  }

  const MlpWindow::Settings& settings_;
  const Matrix& tracks_;
  const Matrix& poses_;
  int steps_ = 0;
  DenseNetwork network_;
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
  PerceptronTrainer trainer(*device_, settings_, schedule.batch(), track_frames, pose_frames);
  train_epochs(trainer, schedule, settings_,
               {settings_.seed, 0, kPerceptronStream, kPerceptronShuffle});
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
    gemm(i == 0 ? Rows::strided(frames, 0, count, 1, kWindowFrames) : Rows(values), W, output,
         options);
    device_->queue().finish();  // W and b live no longer than this
    values = std::move(output);
  }
  return values.to_host();
}

}  // namespace mcdbn
