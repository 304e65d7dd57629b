#include "fitting/prior_errors.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mcdbn;

namespace {

/// A root, a turn on it that is twice as open, and one on that.
PosteriorClip three_turns() {
  PosteriorClip clip;
  clip.parents = {-1, 0, 1};
  clip.turn_deviation_rad.resize(2, 3);
  clip.turn_deviation_rad << 0.1, 0.1, 0.1, 0.1, 0.2, 0.3;
  clip.frame_time_s = 1.0 / 30;
  return clip;
}

}  // namespace

TEST_CASE("prior errors: a turn's correlate with its parent's, in their own deviations") {
  const PosteriorClip clip = three_turns();
  TrackFitSettings settings;
  settings.parent_correlation = 0.6;
  settings.exact_parent_correlation = 0.28;
  for (const bool steady : {false, true}) {
    CAPTURE(steady);
    RayNoise noise{0.01, 0, !steady};
    noise.steady = steady;
    const PriorErrors prior(clip, noise, settings);
    const double correlation = steady ? 0.28 : 0.6, own = steady ? 0.96 : 0.8;
    CHECK_UNARY(prior.share_of_parent(1, 0) == 0);
    CHECK(prior.share_of_parent(1, 1) == doctest::Approx(2 * correlation));
    CHECK(prior.share_of_parent(1, 2) == doctest::Approx(1.5 * correlation));
    CHECK(prior.own_deviation_rad(1, 0) == doctest::Approx(0.1));
    CHECK(prior.own_deviation_rad(1, 1) == doctest::Approx(0.2 * own));
    CHECK(prior.own_deviation_rad(0, 2) == doctest::Approx(0.1 * own));
    // The variance that the parent leaves and its share of it are the whole.
    CHECK(std::pow(prior.own_deviation_rad(1, 1), 2) +
              std::pow(prior.share_of_parent(1, 1) * 0.1, 2) ==
          doctest::Approx(0.04));
  }
}

TEST_CASE("prior errors: where rays are exact values count for less, bends as elsewhere") {
  const PosteriorClip clip = three_turns();
  TrackFitSettings settings;
  settings.exact_prior_weight = 0.25;
  const PriorErrors noisy(clip, {0.01, 0}, settings), exact(clip, {0.01, 0, true}, settings);
  CHECK(exact.process().value_weight == doctest::Approx(0.25 * noisy.process().value_weight));
  CHECK_UNARY(exact.process().curvature_weight == noisy.process().curvature_weight);
}

TEST_CASE("prior errors: where a solution measured the noise they last longer") {
  TrackFitSettings settings;
  settings.prior_error_time_s = 0.1;
  settings.measured_prior_error_time_s = 0.2;
  const PosteriorClip clip = three_turns();
  const PriorErrors usual(clip, {0.01, 0}, settings),
      measured(clip, {0.01, 0, false, true}, settings);
  CHECK(measured.process().value_weight == doctest::Approx(usual.process().value_weight / 2));
  CHECK(measured.process().curvature_weight ==
        doctest::Approx(usual.process().curvature_weight * 8));
}
