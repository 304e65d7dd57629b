#include "comparison/bimodal_autoencoder.hpp"

#include <numeric>

#include "base/random_phases.hpp"
#include "base/random_streams.hpp"
#include "comparison/bimodal_data.hpp"
#include "comparison/bimodal_network.hpp"
#include "comparison/clip_pairs.hpp"
#include "comparison/pretrained_rbm.hpp"
#include "comparison/track_window.hpp"
#include "device/pointwise.hpp"
#include "learning/minibatch.hpp"

namespace mcdbn {
namespace {

constexpr std::uint16_t kAutoencoderStream = random_streams::kAutoencoder;

DenseLayer transposed(const DenseLayer& layer, const MatrixF& bias) {
  return {layer.W.transpose(), bias};
}

/// Each modality's layer as a Gaussian RBM, the shared one as a binary RBM on both codes; decoders
/// are their transposes.
std::vector<DenseLayer> pretrained_layers(Device& device, const BimodalShape& shape,
                                          const std::array<MatrixF, 2>& data,
                                          const BimodalAutoencoderSettings& settings) {
  PretrainingSettings pretraining{settings.pretraining_epochs, settings.pretraining_rate,
                                  settings.batch, settings.least_batches};
  RandomKey key{settings.seed, 0, kAutoencoderStream + 1, 0};
  std::array<PretrainedRbm, 2> rbms;
  for (std::size_t m = 0; m < 2; ++m, ++key.stream)
    rbms[m] =
        pretrained_rbm(device, data[m], {shape.visible[m], shape.hidden[m], 0}, pretraining, key);
  MatrixF codes(data[0].rows(), rbms[0].codes.cols() + rbms[1].codes.cols());
  codes << rbms[0].codes, rbms[1].codes;
  pretraining.rate *= 10;  // of binary units, as the greedy schedule's
  const CrbmParameters top =
      pretrained_rbm(device, codes,
                     {shape.hidden[0] + shape.hidden[1], shape.top, 0, VisibleKind::binary},
                     pretraining, key)
          .parameters;
  std::vector<DenseLayer> layers(8);
  Eigen::Index first = 0;
  for (std::size_t m = 0; m < 2; ++m) {
    const CrbmParameters& rbm = rbms[m].parameters;
    const auto hidden = static_cast<Eigen::Index>(shape.hidden[m]);
    layers[BimodalNetwork::kEncode[m]] = {rbm.W, rbm.b};
    // The shared bias stands once: the other modality's share of it is zero.
    layers[BimodalNetwork::kShare[m]] = {top.W.middleRows(first, hidden),
                                         m == 0 ? top.b : MatrixF::Zero(1, top.b.cols()).eval()};
    layers[BimodalNetwork::kUnshare[m]] =
        transposed(layers[BimodalNetwork::kShare[m]], top.a.middleCols(first, hidden));
    layers[BimodalNetwork::kDecode[m]] = transposed(layers[BimodalNetwork::kEncode[m]], rbm.a);
    first += hidden;
  }
  return layers;
}

std::vector<DenseLayer> random_layers(const BimodalShape& shape, std::uint64_t seed) {
  RandomKey key{seed, 0, kAutoencoderStream, random_phases::kFirstWeights};
  const auto layer = [&](std::size_t inputs, std::size_t outputs) {
    ++key.step;
    return random_dense_layer(inputs, inputs, outputs, key);
  };
  std::vector<DenseLayer> layers(8);
  for (std::size_t m = 0; m < 2; ++m) {
    layers[BimodalNetwork::kEncode[m]] = layer(shape.visible[m], shape.hidden[m]);
    layers[BimodalNetwork::kShare[m]] = layer(shape.hidden[m], shape.top);
    layers[BimodalNetwork::kUnshare[m]] = layer(shape.top, shape.hidden[m]);
    layers[BimodalNetwork::kDecode[m]] = layer(shape.hidden[m], shape.visible[m]);
  }
  return layers;
}

/// Back-propagation with modalities left out.
class AutoencoderTrainer {
 public:
  AutoencoderTrainer(BimodalNetwork& network, const BimodalAutoencoderSettings& settings,
                     std::size_t batch, const std::array<MatrixF, 2>& data)
      : network_(network),
        settings_(settings),
        pass_(network.device(), network.shape(), batch),
        errors_(network.device(), network.shape(), batch) {
    for (std::size_t m = 0; m < 2; ++m) {
      data_[m] = Matrix::from_host(network.device(), data[m]);
      target_[m] = Matrix::like(pass_.input[m]);
      absent_[m] = Matrix::like(pass_.input[m]);
    }
  }

  void step(const IndexBuffer& index, std::size_t first, double rate) {
    const std::size_t rows = pass_.shared.rows(), third = rows / 3;
    for (std::size_t m = 0; m < 2; ++m) {
      gather(Rows::indexed(data_[m], index, first, rows), target_[m]);
      pass_.input[m].copy_from(target_[m]);
      // First both, then the track alone, then the pose alone.
      const std::size_t alone = m == 0 ? rows - third : rows - 2 * third;
      pass_.input[m].copy_rows_from(absent_[m], 0, third, alone);
    }
    network_.forward(pass_);
    network_.differentiate(pass_, target_, {1.0F, static_cast<float>(settings_.pose_weight)},
                           errors_);
    network_.layers().update(
        UpdateRule::adam(static_cast<float>(rate), static_cast<float>(settings_.weight_decay)));
  }

 private:
  BimodalNetwork& network_;
  const BimodalAutoencoderSettings& settings_;
  BimodalNetwork::Pass pass_, errors_;
  std::array<Matrix, 2> data_, target_, absent_;
};

}  // namespace

BimodalAutoencoder::BimodalAutoencoder(Device& device, const BimodalAutoencoderSettings& settings)
    : device_(&device), settings_(settings) {
  settings_.validate();
}

BimodalAutoencoder::~BimodalAutoencoder() = default;

void BimodalAutoencoder::fit(const std::vector<MatrixF>& tracks,
                             const std::vector<MatrixF>& poses) {
  const std::array<MatrixF, 2> data = bimodal_data(tracks, poses);
  const BimodalShape shape =
      bimodal_shape(data, {settings_.track_hidden, settings_.pose_hidden}, settings_.shared);
  network_ = std::make_unique<BimodalNetwork>(
      *device_, shape,
      settings_.pretraining_epochs > 0 ? pretrained_layers(*device_, shape, data, settings_)
                                       : random_layers(shape, settings_.seed));

  std::vector<std::int32_t> rows(static_cast<std::size_t>(data[0].rows()));
  std::iota(rows.begin(), rows.end(), 0);
  MinibatchSchedule schedule(*device_, rows, settings_.batch, settings_.least_batches);
  AutoencoderTrainer trainer(*network_, settings_, schedule.batch(), data);
  train_epochs(trainer, schedule, settings_,
               {settings_.seed, 0, kAutoencoderStream, random_phases::kShuffle});
  device_->queue().finish();  // what the trainer holds lives no longer
  track_dimension_ = tracks.front().cols();
}

std::vector<DenseLayer> BimodalAutoencoder::layers() const {
  return network_ ? network_->layers().to_host() : std::vector<DenseLayer>();
}

MatrixF BimodalAutoencoder::predict(const MatrixF& track) const {
  check_track(track, track_dimension_);
  if (track.rows() == 0) return MatrixF(0, static_cast<Eigen::Index>(network_->shape().visible[1]));
  BimodalNetwork::Pass pass(*device_, network_->shape(), static_cast<std::size_t>(track.rows()));
  pass.input[0].upload(track_windows(track));
  network_->forward(pass);
  return pass.output[1].to_host();
}

}  // namespace mcdbn
