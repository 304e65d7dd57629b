// The bimodal autoencoder's whole training, tiny, against double precision, and what it can learn.

#include "comparison/bimodal_autoencoder.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "comparison/adam_reference.hpp"
#include "comparison/bimodal_network.hpp"
#include "comparison/bimodal_reference.hpp"
#include "comparison/clips.hpp"
#include "comparison/constant_pose.hpp"
#include "comparison/pretrained_rbm.hpp"
#include "comparison/track_window.hpp"
#include "device/every_device.hpp"

namespace bimodal_autoencoder_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::uint16_t kStream = 0x4d60;

std::vector<MatrixF> tracks() {
  std::vector<MatrixF> clips{random_clip(9, 3, 1), MatrixF(0, 3), random_clip(5, 3, 2)};
  clips[0](4, 1) = NAN;
  return clips;
}

std::vector<MatrixF> poses() {
  return {random_clip(9, 4, 4), MatrixF(0, 4), random_clip(5, 4, 5)};
}

BimodalAutoencoderSettings tiny_settings() {
  BimodalAutoencoderSettings settings;
  settings.track_hidden = 5;
  settings.pose_hidden = 4;
  settings.shared = 6;
  settings.pretraining_epochs = 0;
  settings.epochs = 3;
  settings.least_batches = 4;
  settings.batch = 7;
  settings.rate = 0.01;
  settings.weight_decay = 0.5;
  settings.pose_weight = 2;
  settings.seed = 0x900000007ULL;
  return settings;
}

/// Drawn by the layers' numbers within the two modalities: 2D's encoder, to and from the shared
/// units, decoder; then 3D's.
std::vector<DenseLayer> first_layers(const BimodalAutoencoderSettings& settings) {
  const std::array<std::size_t, 2> visible = {33, 4};
  const std::array<std::size_t, 2> hidden = {settings.track_hidden, settings.pose_hidden};
  std::vector<DenseLayer> layers(8);
  std::uint32_t step = 0;
  for (std::size_t m = 0; m < 2; ++m) {
    const std::array<std::size_t, 5> sizes = {visible[m], hidden[m], settings.shared, hidden[m],
                                              visible[m]};
    for (std::size_t i = 0; i < 4; ++i) {
      MatrixF W(sizes[i], sizes[i + 1]);
      ++step;
      for (Eigen::Index r = 0; r < W.rows(); ++r)
        for (Eigen::Index c = 0; c < W.cols(); ++c)
          W(r, c) = static_cast<float>(std::sqrt(1.0 / (3.0 * static_cast<double>(sizes[i]))) *
                                       random_normal({settings.seed, step, kStream, 0x7100},
                                                     static_cast<std::uint32_t>(r),
                                                     static_cast<std::uint32_t>(c)));
      layers[2 * i + m] = {W, MatrixF::Zero(1, W.cols())};
    }
  }
  return layers;
}

std::vector<BimodalReference::Layer> trained(const BimodalAutoencoderSettings& settings) {
  const WindowPairs pairs = window_pairs(tracks(), poses());
  const std::array<MatrixD, 2> data = {pairs.windows.cast<double>(), pairs.poses.cast<double>()};
  std::vector<Eigen::Index> order;
  do
    for (Eigen::Index i = 0; i < 14; ++i) order.push_back(i);
  while (order.size() / settings.batch < settings.least_batches);
  const std::size_t batches = order.size() / settings.batch, all = settings.epochs * batches;

  BimodalReference reference(first_layers(settings));
  std::vector<AdamReference> W, b;
  for (const auto& layer : reference.layers) {
    W.emplace_back(layer.W);
    b.emplace_back(layer.b);
  }
  for (std::size_t i = 0; i < all; ++i) {
    if (i % batches == 0)
      for (std::size_t k = order.size() - 1; k > 0; --k) {
        const std::uint64_t bits =
            random_bits({settings.seed, static_cast<std::uint32_t>(i / batches), kStream, 0x7000},
                        static_cast<std::uint32_t>(k), 0);
        std::swap(order[k], order[bits * (k + 1) >> 32U]);
      }
    const auto begin = order.begin() + static_cast<std::ptrdiff_t>(i % batches * settings.batch);
    const std::vector<Eigen::Index> rows(begin,
                                         begin + static_cast<std::ptrdiff_t>(settings.batch));
    const std::array<MatrixD, 2> target = {MatrixD(data[0](rows, Eigen::all)),
                                           MatrixD(data[1](rows, Eigen::all))};
    // Of seven windows three have both, two the track alone, two the pose alone.
    std::array<MatrixD, 2> input = target;
    input[1].middleRows(3, 2).setZero();
    input[0].middleRows(5, 2).setZero();
    const auto gradient = reference.gradient(input, target, {1.0, settings.pose_weight});
    const double progress = static_cast<double>(i) / static_cast<double>(all);
    const double rate = settings.rate * std::min(1.0, 2.0 - 1.98 * progress);
    for (std::size_t n = 0; n < 8; ++n) {
      W[n].update(gradient[n].W, rate, settings.weight_decay, static_cast<int>(i + 1));
      b[n].update(gradient[n].b, rate, 0, static_cast<int>(i + 1));
      reference.layers[n] = {W[n].value, b[n].value};
    }
  }
  return reference.layers;
}

/// Slow motion that the pose follows along a curve.
struct Clips {
  std::vector<MatrixF> tracks, poses;
};

void add_clip(Clips& clips, int frames, float phase) {
  MatrixF track(frames, 2), pose(frames, 3);
  for (int t = 0; t < frames; ++t) {
    const float at = 0.15F * static_cast<float>(t) + phase;
    track.row(t) << 1.4F * std::sin(at), 1.4F * std::cos(0.7F * at);
    pose.row(t) << 1.4F * std::cos(at), 1.4F * std::sin(0.7F * at), std::sin(2 * at);
  }
  clips.tracks.push_back(track);
  clips.poses.push_back(pose);
}

double error_of(const MatrixF& got, const MatrixF& want) {
  return static_cast<double>((got - want).squaredNorm()) / static_cast<double>(want.size());
}

}  // namespace

TEST_CASE("bimodal_autoencoder's training is the reference's, step by step") {
  const BimodalAutoencoderSettings settings = tiny_settings();
  const auto want = trained(settings);
  on_every_device([&](Device& device) {
    BimodalAutoencoder baseline(device, settings);
    CHECK(baseline.layers().empty());
    baseline.fit(tracks(), poses());
    const std::vector<DenseLayer> got = baseline.layers();
    REQUIRE(got.size() == 8);
    // As for the perceptron: rounding is far below a thousandth of a step.
    for (std::size_t i = 0; i < 8; ++i) {
      CAPTURE(i);
      CHECK(!((got[i].W.cast<double>() - want[i].W).cwiseAbs().maxCoeff() > 1e-5));
      CHECK(!((got[i].b.cast<double>() - want[i].b).cwiseAbs().maxCoeff() > 1e-5));
    }
    // The answer is the 3D decoder's with no pose to see.
    const MatrixF unseen = random_clip(6, 3, 9);
    BimodalReference reference(got);
    const MatrixD answer =
        reference.pass({track_windows(unseen).cast<double>(), MatrixD::Zero(6, 4)}).output[1];
    CHECK((baseline.predict(unseen).cast<double>() - answer).cwiseAbs().maxCoeff() < 1e-5);
  });
}

TEST_CASE("bimodal_autoencoder's layers start as RBMs, the decoders as their transposes") {
  BimodalAutoencoderSettings settings = tiny_settings();
  settings.pretraining_epochs = 2;
  settings.pretraining_rate = 0.02;
  settings.epochs = 1;
  settings.rate = 1e-12;  // the start stays as it is
  const WindowPairs pairs = window_pairs(tracks(), poses());
  on_every_device([&](Device& device) {
    BimodalAutoencoder baseline(device, settings);
    baseline.fit(tracks(), poses());
    const std::vector<DenseLayer> got = baseline.layers();
    PretrainingSettings pretraining{2, 0.02, 7, 4};
    const PretrainedRbm track = pretrained_rbm(device, pairs.windows, {33, 5, 0}, pretraining,
                                               {settings.seed, 0, kStream + 1, 0});
    const PretrainedRbm pose = pretrained_rbm(device, pairs.poses, {4, 4, 0}, pretraining,
                                              {settings.seed, 0, kStream + 2, 0});
    MatrixF codes(14, 9);
    codes << track.codes, pose.codes;
    pretraining.rate = 0.2;
    const CrbmParameters top = pretrained_rbm(device, codes, {9, 6, 0, VisibleKind::binary},
                                              pretraining, {settings.seed, 0, kStream + 3, 0})
                                   .parameters;
    const auto same = [](const MatrixF& x, const MatrixF& y) {
      return x.rows() == y.rows() && x.cols() == y.cols() && (x - y).cwiseAbs().maxCoeff() < 1e-6F;
    };
    CHECK(same(got[0].W, track.parameters.W));
    CHECK(same(got[0].b, track.parameters.b));
    CHECK(same(got[1].W, pose.parameters.W));
    CHECK(same(got[1].b, pose.parameters.b));
    CHECK(same(got[2].W, top.W.topRows(5)));
    CHECK(same(got[2].b + got[3].b, top.b));
    CHECK(same(got[3].W, top.W.bottomRows(4)));
    CHECK(same(got[4].W, top.W.topRows(5).transpose()));
    CHECK(same(got[4].b, top.a.leftCols(5)));
    CHECK(same(got[5].W, top.W.bottomRows(4).transpose()));
    CHECK(same(got[5].b, top.a.rightCols(4)));
    CHECK(same(got[6].W, track.parameters.W.transpose()));
    CHECK(same(got[6].b, track.parameters.a));
    CHECK(same(got[7].W, pose.parameters.W.transpose()));
    CHECK(same(got[7].b, pose.parameters.a));
    CHECK(top.W.cwiseAbs().maxCoeff() > 0.02F);  // they did learn
  });
}

TEST_CASE("pretrained_rbm learns to reconstruct, and its codes are its hidden units'") {
  on_every_device([](Device& device) {
    Clips clips;
    add_clip(clips, 200, 0);
    const MatrixF data = track_windows(clips.tracks[0]);
    PretrainingSettings settings;
    settings.rate = 0.005;
    settings.epochs = 10;
    const PretrainedRbm rbm = pretrained_rbm(device, data, {22, 12, 0}, settings, {3, 0, 7, 0});
    const CrbmParameters& p = rbm.parameters;
    settings.epochs = 0;
    const auto start = pretrained_rbm(device, data, {22, 12, 0}, settings, {3, 0, 7, 0});
    CHECK(start.parameters.W == CrbmParameters::random({22, 12, 0}, 0.01, {3, 0, 7, 0x7100}).W);
    settings.epochs = 1;
    CHECK(pretrained_rbm(device, data, {22, 12, 0}, settings, {3, 0, 7, 0}).parameters.W !=
          start.parameters.W);
    const MatrixD codes = BimodalReference::sigmoid((data * p.W).cast<double>().rowwise() +
                                                    RowVectorD(p.b.row(0).cast<double>()));
    CHECK((rbm.codes.cast<double>() - codes).cwiseAbs().maxCoeff() < 1e-5);
    const MatrixF back = (rbm.codes * p.W.transpose()).rowwise() + RowVectorF(p.a.row(0));
    CHECK(error_of(back, data) < 0.3 * error_of(MatrixF::Zero(200, 22), data));
  });
}

TEST_CASE("bimodal_autoencoder infers the pose of another clip, far better than the mean") {
  Clips clips;
  for (const float phase : {0.0F, 4.0F, 9.0F}) add_clip(clips, 120, phase);
  Clips other;
  add_clip(other, 80, 6.5F);
  BimodalAutoencoderSettings settings;
  settings.track_hidden = 32;
  settings.pose_hidden = 16;
  settings.shared = 32;
  settings.pretraining_epochs = 0;
  settings.epochs = 8;
  settings.weight_decay = 0;
  settings.rate = 0.02;
  ConstantPose constant;
  constant.fit(clips.tracks, clips.poses);
  on_every_device([&](Device& device) {
    BimodalAutoencoder baseline(device, settings), same(device, settings);
    baseline.fit(clips.tracks, clips.poses);
    CHECK(error_of(baseline.predict(other.tracks[0]), other.poses[0]) <
          0.2 * error_of(constant.predict(other.tracks[0]), other.poses[0]));
    same.fit(clips.tracks, clips.poses);
    CHECK(same.predict(other.tracks[0]) == baseline.predict(other.tracks[0]));
  });
}

}  // namespace bimodal_autoencoder_test
