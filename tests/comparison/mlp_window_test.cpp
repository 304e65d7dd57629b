#include "comparison/mlp_window.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "comparison/clips.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"

namespace mlp_window_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A pose that no linear map of the track gives, and that looks two frames back.
MatrixF bent_pose(const MatrixF& track) {
  MatrixF pose(track.rows(), 2);
  for (Eigen::Index t = 0; t < track.rows(); ++t) {
    const Eigen::Index before = std::max<Eigen::Index>(t - 2, 0);
    pose(t, 0) = std::abs(track(t, 0)) - 0.8F;
    pose(t, 1) = std::max(track(before, 1), 0.0F);
  }
  return pose;
}

struct Clips {
  std::vector<MatrixF> tracks, poses;
};

Clips bent_clips() {
  Clips clips;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    clips.tracks.push_back(random_clip(150, 3, seed));
    clips.poses.push_back(bent_pose(clips.tracks.back()));
  }
  return clips;
}

MlpWindow::Settings small_settings() {
  MlpWindow::Settings settings;
  settings.hidden = 48;
  settings.epochs = 40;
  settings.dropout = 0.0;
  return settings;
}

/// The network in double, on the host, from its layers.
MatrixD host_output(const MlpWindow& mlp, const MatrixF& track, std::size_t stride) {
  MatrixD values = MatrixD::Zero(track.rows(), static_cast<Eigen::Index>(11 * stride));
  for (Eigen::Index t = 0; t < track.rows(); ++t)
    for (Eigen::Index k = 0; k < 11; ++k)
      values.block(t, k * static_cast<Eigen::Index>(stride), 1, track.cols()) =
          track.row(std::clamp<Eigen::Index>(t + k - 5, 0, track.rows() - 1)).cast<double>();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& layer = mlp.layers()[i];
    values = (values * layer.W.cast<double>()).eval();
    values.rowwise() += layer.b.row(0).cast<double>();
    if (i < 2) values = values.cwiseMax(0.0).eval();
  }
  return values;
}

double error_of(const MatrixF& got, const MatrixF& want) {
  return static_cast<double>((got - want).squaredNorm()) / static_cast<double>(want.size());
}

}  // namespace

TEST_CASE("mlp_window learns what no linear map can, and carries it to another clip") {
  on_every_device([](Device& device) {
    const Clips clips = bent_clips();
    MlpWindow mlp(device, small_settings());
    mlp.fit(clips.tracks, clips.poses);
    const MatrixF unseen = random_clip(200, 3, 99);
    const MatrixF want = bent_pose(unseen);
    const double spread = error_of(MatrixF::Zero(200, 2), want);
    CHECK(error_of(mlp.predict(unseen), want) < 0.3 * spread);
    const MatrixD host = host_output(mlp, unseen, padded(3));
    CHECK((mlp.predict(unseen).cast<double>() - host).cwiseAbs().maxCoeff() < 1e-4);
  });
}

TEST_CASE("mlp_window: the same seed gives the same network, another seed another one") {
  on_every_device([](Device& device) {
    const Clips clips = bent_clips();
    MlpWindow::Settings settings = small_settings();
    settings.epochs = 2;
    settings.dropout = 0.3;
    MlpWindow one(device, settings), same(device, settings);
    settings.seed = 2;
    MlpWindow other(device, settings);
    for (MlpWindow* mlp : {&one, &same, &other}) mlp->fit(clips.tracks, clips.poses);
    CHECK(one.predict(clips.tracks[0]) == same.predict(clips.tracks[0]));
    CHECK(one.predict(clips.tracks[0]) != other.predict(clips.tracks[0]));
  });
}

TEST_CASE("mlp_window: missing joints, short clips and misuse") {
  on_every_device([](Device& device) {
    MlpWindow::Settings settings = small_settings();
    settings.epochs = 1;
    MlpWindow mlp(device, settings);
    CHECK(mlp.name() == "mlp_window");
    CHECK_THROWS_AS(mlp.predict(random_clip(4, 3, 1)), ShapeError);
    CHECK_THROWS_AS(mlp.fit({}, {}), ShapeError);
    mlp.fit({random_clip(1, 3, 1), random_clip(4, 3, 2)},
            {random_clip(1, 2, 3), random_clip(4, 2, 4)});
    CHECK_THROWS_AS(mlp.predict(random_clip(4, 2, 1)), ShapeError);
    MatrixF gappy = random_clip(7, 3, 5), zeroed = gappy;
    gappy(2, 1) = NAN;
    zeroed(2, 1) = 0;
    CHECK(mlp.predict(gappy).allFinite());
    CHECK(mlp.predict(gappy) == mlp.predict(zeroed));
    CHECK(mlp.predict(MatrixF(0, 3)).rows() == 0);
  });
}

}  // namespace mlp_window_test
