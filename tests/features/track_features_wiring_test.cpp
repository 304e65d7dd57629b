#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/missing_values.hpp"
#include "mcdbn/features/standardizer.hpp"
#include "mcdbn/features/track_features.hpp"

using namespace mcdbn;

namespace {

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

/// Joints that move in ways of their own, the root too, in another order than the features'.
Track2d track_at(double fps, int frames) {
  Track2d track;
  track.joint_names = {"Foot", "Hips", "Hand", "Other"};
  track.fps = fps;
  track.width_px = 1280;
  track.height_px = 720;
  track.x_px = track.y_px = MatrixD(frames, 4);
  track.confidence = MatrixD::Ones(frames, 4);
  for (int t = 0; t < frames; ++t) {
    track.x_px.row(t) << 300 + t, 310 + 2 * t, 350 + 2.5 * t, 5;
    track.y_px.row(t) << 480 - t, 400 + t, 330 + 3 * std::sin(t), 9;
  }
  return track;
}

const TrackFeatures kWiredFeatures({"Hand", "Foot"}, "Hips");

}  // namespace

TEST_CASE("track features: which number of a track stands in which feature") {
  const Track2d track = track_at(30, 40);
  const MatrixD features = kWiredFeatures.encode(track);
  const std::vector<std::string> names = kWiredFeatures.feature_names();
  CHECK(names == std::vector<std::string>{"Hand_x", "Hand_y", "Foot_x", "Foot_y", "root_image_x",
                                          "root_image_y", "log_body_size"});
  for (const int t : {0, 1, 20, 39}) {
    CAPTURE(t);
    const double scale = 720 * std::exp(features(t, 6));
    const auto check = [&](int feature, double pixels) {
      CHECK(std::abs(features(t, feature) * scale - pixels) < 1e-9);
    };
    const double root_x = track.x_px(t, 1), root_y = track.y_px(t, 1);
    check(0, track.x_px(t, 2) - root_x);
    check(1, track.y_px(t, 2) - root_y);
    check(2, track.x_px(t, 0) - root_x);
    check(3, track.y_px(t, 0) - root_y);
    CHECK(std::abs(features(t, 4) - (root_x - 640) / 720) < 1e-12);
    CHECK(std::abs(features(t, 5) - (root_y - 360) / 720) < 1e-12);
  }
}

TEST_CASE("track features: gaps are short and sizes smooth by seconds, not by frames") {
  for (const double fps : {15.0, 60.0}) {
    CAPTURE(fps);
    const int frames = static_cast<int>(4 * fps), bridged = static_cast<int>(0.2 * fps);
    Track2d track = track_at(fps, frames);
    const MatrixD whole = kWiredFeatures.encode(track);
    const auto lose = [&](int first, int count) {
      track.x_px.block(first, 2, count, 1).setConstant(kUnseen);
      track.y_px.block(first, 2, count, 1).setConstant(kUnseen);
      track.confidence.block(first, 2, count, 1).setZero();
    };
    lose(5, bridged);
    lose(30, bridged + 1);
    TrackFeatures::FillCount filled;
    const MatrixD features = kWiredFeatures.encode(track, &filled);
    CHECK(filled.interpolated == bridged);
    CHECK(filled.missing == bridged + 1);
    CHECK(features.block(5, 0, bridged, 2).allFinite());
    CHECK(features.block(30, 0, bridged + 1, 2).array().isNaN().all());
  }
  // Two seconds of a size that swings twice a second: as flat at any rate.
  const auto swing = [](double fps) {
    const int frames = static_cast<int>(4 * fps);
    Track2d track = track_at(fps, frames);
    for (int t = 0; t < frames; ++t) {
      const double size = std::exp(0.2 * std::sin(4 * M_PI * t / fps));
      track.x_px.row(t) << 640, 640, 640 + 100 * size, 0;
      track.y_px.row(t) << 360 + 150 * size, 360, 360, 0;
    }
    const Eigen::VectorXd log_size =
        kWiredFeatures.encode(track).col(6).segment(frames / 4, frames / 2);
    return log_size.maxCoeff() - log_size.minCoeff();
  };
  CHECK(std::abs(swing(15) - swing(60)) < 0.01);
  CHECK(swing(60) < 0.02);
}

TEST_CASE("standardizer: what is unknown stands at the mean, and numbers keep their columns") {
  MatrixD values(3, 4);
  values << 1, 5, kUnseen, 10,  //
      2, 5, 7, 30,              //
      6, 5, 11, 80;
  const Standardizer scaling = Standardizer::fit({&values});
  REQUIRE(scaling.kept_columns() == std::vector<int>{0, 2, 3});
  const MatrixF known = at_mean_where_unknown(scaling.apply(values));
  CHECK(known(0, 1) == 0);
  CHECK(known(1, 1) == doctest::Approx(-1));
  CHECK(known(2, 1) == doctest::Approx(1));
  CHECK(known(0, 0) == doctest::Approx(-2 / std::sqrt(14 / 3.0)));
  CHECK(known(2, 2) == doctest::Approx(40 / std::sqrt(2600 / 3.0)));
  const MatrixD back = scaling.invert(known);
  CHECK(back(0, 2) == doctest::Approx(9));
  CHECK(back(1, 3) == doctest::Approx(30));
  CHECK(back.col(1) == values.col(1));
  // What varies by less than counts is no column; what varies by more is.
  MatrixD still(2, 2);
  still << 1, 1, 1 + 1.9e-6, 1 + 2.1e-6;
  CHECK(Standardizer::fit({&still}).kept_columns() == std::vector<int>{1});
}
