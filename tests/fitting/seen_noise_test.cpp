#include "fitting/seen_noise.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mcdbn;

namespace {

constexpr double kFocal_px = 1000, kDepth_m = 4;
const double kUsual = TrackFitSettings{}.detector_noise_heights * 1.7 / kDepth_m;

SeenNoise noise_of(double track_px, bool own_skeleton) {
  Camera camera;
  camera.fx_px = camera.fy_px = kFocal_px;
  return {track_px, camera, kDepth_m, own_skeleton, {}};
}

}  // namespace

TEST_CASE("seen noise: a track is a detector's until a solution shows otherwise") {
  const SeenNoise noise = noise_of(1, true);
  CHECK(noise.rays().lasting == doctest::Approx(kUsual));
  CHECK(noise.rays().white ==
        doctest::Approx(2 * 1 / kFocal_px));  // TrackFitSettings::noise_factor
  CHECK(noise_of(0, true).rays().white == doctest::Approx(0.25 / kFocal_px));
}

TEST_CASE("seen noise: a detector's track stays one") {
  SeenNoise noise = noise_of(0.5, false);
  noise.learn(0.88 * kUsual);
  CHECK(noise.rays().lasting == doctest::Approx(kUsual).epsilon(0.1));
  CHECK_FALSE(noise.learn(0.88 * kUsual));
}

TEST_CASE("seen noise: an exact projection is found out, of an own skeleton alone") {
  SeenNoise own = noise_of(0, true), other = noise_of(0, false);
  CHECK(own.learn(0.25 * kUsual));
  CHECK(own.rays().lasting < 0.1 * kUsual);
  CHECK(own.rays().exact);
  CHECK_FALSE(other.rays().exact);
  CHECK_FALSE(noise_of(0, true).rays().exact);
  SeenNoise noisy = noise_of(2, true);  // new in every frame, so that nothing lasts
  noisy.learn(1e-3 * kUsual);
  CHECK(noisy.share() == 0);
  CHECK_FALSE(noisy.rays().exact);
  CHECK(own.share() == doctest::Approx(own.rays().lasting / kUsual));
  own.learn(0.03 * kUsual);
  CHECK(own.share() == doctest::Approx(0));
  CHECK(own.rays().lasting == doctest::Approx(0).scale(kUsual));
  CHECK_FALSE(other.learn(0.25 * kUsual));
  CHECK(std::hypot(other.rays().lasting, 0.25 / kFocal_px) == doctest::Approx(kUsual));
}

TEST_CASE("seen noise: a track with noise of its own is not exact, near as a solution may come") {
  const auto exact_at = [](double share) {
    SeenNoise noise = noise_of(share * kUsual * kFocal_px / TrackFitSettings{}.noise_factor, true);
    CHECK(noise.rays().steady == (share < 0.25));
    noise.learn(1e-3 * kUsual);
    CHECK(std::hypot(noise.rays().white, noise.rays().lasting) == doctest::Approx(share * kUsual));
    return noise.rays().exact;
  };
  CHECK(exact_at(0.24));
  CHECK_FALSE(exact_at(0.26));
  CHECK_FALSE(exact_at(0.45));
  // An unknown body's is a detector's, whatever noise the track shows.
  CHECK_FALSE(noise_of(0, false).rays().steady);
}

TEST_CASE("seen noise: that of a known body which no detector saw was measured, in the end") {
  SeenNoise own = noise_of(3, true), other = noise_of(3, false), exact = noise_of(0, true);
  own.learn(0.5 * kUsual);
  CHECK_FALSE(own.rays().measured);
  const double lasting = own.rays().lasting;
  CHECK(own.measure());
  CHECK(own.rays().measured);
  CHECK(own.rays().white == doctest::Approx(1.7 * 3 / kFocal_px));  // measured_noise_factor
  CHECK(own.rays().lasting == lasting);
  CHECK_FALSE(own.measure());
  own.learn(0.01 * kUsual);
  CHECK_FALSE(own.rays().exact);
  CHECK_FALSE(other.measure());
  CHECK_FALSE(exact.measure());  // before the first solution, too
  exact.learn(0.25 * kUsual);
  CHECK_FALSE(exact.measure());
}

TEST_CASE("seen noise: a worse detector is one too, up to a limit") {
  SeenNoise worse = noise_of(0.5, false);
  CHECK(worse.learn(1.5 * kUsual));
  CHECK(worse.rays().lasting > 1.5 * kUsual);
  SeenNoise wild = noise_of(0.5, false);
  wild.learn(100 * kUsual);
  CHECK(wild.rays().lasting == doctest::Approx(3 * kUsual).epsilon(0.01));
}
