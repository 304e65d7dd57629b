#include "camera/track_resample.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"

namespace track_resample_test {

using namespace mcdbn;

namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Two joints: x of the first is `values`; its y, the second joint and the confidences are other
/// numbers, so that none of them can stand for another.
Track2d track_of(const std::vector<double>& values, double fps) {
  const auto frames = static_cast<Eigen::Index>(values.size());
  Track2d track;
  track.joint_names = {"hip", "knee"};
  track.fps = fps;
  track.width_px = 640;
  track.height_px = 480;
  track.x_px = track.y_px = track.confidence = MatrixD(frames, 2);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const double value = values[static_cast<std::size_t>(t)];
    track.x_px.row(t) << value, 1000 - 3 * value;
    track.y_px.row(t) << 200 + 2 * value, 70 + value;
    track.confidence.row(t) << value / 1000, 1 - value / 500;
  }
  return track;
}

void lose(Track2d& track, Eigen::Index frame, Eigen::Index joint) {
  track.x_px(frame, joint) = track.y_px(frame, joint) = kMissing;
  track.confidence(frame, joint) = 0;
}

/// Both tracks' numbers are equal, missing ones where missing ones are wanted. The numbers are
/// below 1000 and a few roundings off.
void check_alike(const Track2d& got, const Track2d& want) {
  CHECK(got.joint_names == want.joint_names);
  CHECK(got.fps == want.fps);
  CHECK(got.width_px == want.width_px);
  CHECK(got.height_px == want.height_px);
  for (const auto values : {&Track2d::x_px, &Track2d::y_px, &Track2d::confidence}) {
    const MatrixD &a = got.*values, &b = want.*values;
    REQUIRE(a.rows() == b.rows());
    REQUIRE(a.cols() == b.cols());
    for (Eigen::Index t = 0; t < a.rows(); ++t)
      for (Eigen::Index j = 0; j < a.cols(); ++j) {
        CAPTURE(t);
        CAPTURE(j);
        CHECK(std::isnan(a(t, j)) == std::isnan(b(t, j)));
        if (!std::isnan(b(t, j))) CHECK(std::abs(a(t, j) - b(t, j)) <= 1e-11);
      }
  }
}

}  // namespace

TEST_CASE("a track at a higher rate is linear between its frames") {
  const Track2d track = track_of({100, 130, 90, 110}, 10);
  check_alike(resample_track(track, 30),
              track_of({100, 110, 120, 130, 130 - 40.0 / 3, 130 - 80.0 / 3, 90, 90 + 20.0 / 3,
                        90 + 40.0 / 3, 110},
                       30));
  // Rates that do not divide each other: frames at 0, 0.4, 0.8, … 2.8 of the old ones.
  check_alike(resample_track(track, 25), track_of({100, 112, 124, 130 - 0.2 * 40, 130 - 0.6 * 40,
                                                   90, 90 + 0.4 * 20, 90 + 0.8 * 20},
                                                  25));
}

TEST_CASE("a track at a lower rate is the triangle-weighted mean around each new frame") {
  const Track2d track = track_of({100, 140, 60, 180, 20, 300, 7}, 60);
  // Two old frames to a new one: weights ½ 1 ½, cut off at the ends.
  const auto mean = [](double before, double at, double after) {
    return (0.5 * before + at + 0.5 * after) / 2;
  };
  check_alike(resample_track(track, 30), track_of({(100 + 0.5 * 140) / 1.5, mean(140, 60, 180),
                                                   mean(180, 20, 300), (7 + 0.5 * 300) / 1.5},
                                                  30));
  // One and a half: old frames at distances 0 and 1, or ½ and ½, weigh 1 and ⅓, or ⅔ and ⅔.
  check_alike(resample_track(track, 40), track_of({(100 + 140 / 3.0) / (4 / 3.0), (140 + 60) / 2.0,
                                                   (180 + (60 + 20) / 3.0) / (5 / 3.0),
                                                   (20 + 300) / 2.0, (7 + 300 / 3.0) / (4 / 3.0)},
                                                  40));
}

TEST_CASE("a steady movement keeps its place and its pace at any rate") {
  std::vector<double> ramp;
  for (int t = 0; t < 61; ++t) ramp.push_back(100 + 2.0 * t);
  for (const double hz : {24.0, 30.0, 50.0, 90.0}) {
    CAPTURE(hz);
    const Track2d result = resample_track(track_of(ramp, 60), hz);
    REQUIRE(result.frames() == static_cast<int>(std::floor(hz * 1.0 + 1e-9)) + 1);
    // Ends of a lower rate have neighbours on one side only.
    for (int t = 2; t + 2 < result.frames(); ++t)
      CHECK(std::abs(result.x_px(t, 0) - (100 + 120 * t / hz)) < 60 / hz);
    if (hz > 60)
      for (int t = 0; t < result.frames(); ++t)
        CHECK(std::abs(result.x_px(t, 0) - (100 + 120 * t / hz)) < 1e-10);
  }
}

TEST_CASE("what is missing in a track takes no part; a frame that draws on nothing is missing") {
  Track2d track = track_of({100, 140, 60, 180, 20, 300, 7}, 60);
  lose(track, 2, 0);
  SUBCASE("down: its neighbours stand in") {
    Track2d want = resample_track(track_of({100, 140, 60, 180, 20, 300, 7}, 60), 30);
    const auto only = track_of({(140 + 180) / 2.0}, 60);
    want.x_px(1, 0) = only.x_px(0, 0);
    want.y_px(1, 0) = only.y_px(0, 0);
    want.confidence(1, 0) = only.confidence(0, 0);
    check_alike(resample_track(track, 30), want);
  }
  SUBCASE("down: all of them missing") {
    lose(track, 1, 0);
    lose(track, 3, 0);
    const Track2d result = resample_track(track, 30);
    CHECK(std::isnan(result.x_px(1, 0)));
    CHECK(std::isnan(result.y_px(1, 0)));
    CHECK(result.confidence(1, 0) == 0);
    CHECK(std::abs(result.x_px(0, 0) - 100) < 1e-12);
    CHECK_FALSE(std::isnan(result.x_px(1, 1)));
  }
  SUBCASE("up: the seen neighbour stands in, but the lost frame itself stays lost") {
    const Track2d result = resample_track(track, 120);
    REQUIRE(result.frames() == 13);
    CHECK(std::abs(result.x_px(3, 0) - 140) < 1e-12);
    CHECK(std::isnan(result.x_px(4, 0)));
    CHECK(result.confidence(4, 0) == 0);
    CHECK(std::abs(result.x_px(5, 0) - 180) < 1e-12);
    CHECK(std::abs(result.x_px(4, 1) - (1000 - 3 * 60)) < 1e-11);
  }
}

TEST_CASE("the same rate, no frames, and rates that are none") {
  Track2d track = track_of({100, 140, 60}, 29.97);
  lose(track, 1, 1);
  check_alike(resample_track(track, 29.97), track);
  // 29.97 and 30 are two rates: ten minutes apart by half a second.
  CHECK(resample_track(track, 30).fps == 30);
  CHECK(resample_track(track_of({}, 60), 30).frames() == 0);
  CHECK_THROWS_AS(resample_track(track, 0), ConfigError);
  CHECK_THROWS_AS(resample_track(track, -30), ConfigError);
  CHECK_THROWS_AS(resample_track(track, kMissing), ConfigError);
  CHECK_THROWS_AS(resample_track(track, 1e9), ConfigError);
  for (const double rate : {0.0, 1e-9, 1e300}) {
    track.fps = rate;
    CHECK_THROWS_AS(resample_track(track, 30), ConfigError);
  }
}

}  // namespace track_resample_test
