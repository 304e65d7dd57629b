// How far orientations may turn, from a prior's deviations.

#include "fitting/prior_deviations.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "features/clip_modalities.hpp"
#include "fitting/two_second_walk.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Of one orientation whose six numbers have a deviation of so many degrees.
double deviation_deg(double given_deg, const TrackFitSettings& settings) {
  const Modalities modalities = modalities_of({two_second_walk()}, {});
  const auto& kept = modalities.pose_scale.kept_columns();
  PosePrior prior(MatrixF::Zero(1, std::ssize(kept)), MatrixF::Zero(1, std::ssize(kept)));
  // A turn of deviation s moves two unit vectors by 2 s² each; here all of it by one number.
  const double given_rad = given_deg * std::numbers::pi / 180;
  prior.deviation(0, 0) =
      static_cast<float>(2 * given_rad / modalities.pose_scale.deviation()[kept[0]]);
  const int turn = kept[0] / PoseFeatures::kBlock;
  return turn_deviations_rad(prior, modalities, settings)(0, turn) * 180 / std::numbers::pi;
}

}  // namespace

TEST_CASE("prior deviations: as given, a tenth of a degree at least") {
  TrackFitSettings settings;
  settings.orientation_deviation_deg = 10;
  CHECK(deviation_deg(0, settings) == doctest::Approx(0.1));
  CHECK(deviation_deg(5, settings) == doctest::Approx(5).epsilon(1e-5));
  CHECK(deviation_deg(40, settings) == doctest::Approx(40).epsilon(1e-5));
}

TEST_CASE("prior deviations: a prior without any has the typical one") {
  const Modalities modalities = modalities_of({two_second_walk()}, {});
  const MatrixF mean = MatrixF::Zero(2, std::ssize(modalities.pose_scale.kept_columns()));
  TrackFitSettings settings;
  settings.orientation_deviation_deg = 18;
  const MatrixD turns = turn_deviations_rad(PosePrior(mean), modalities, settings);
  CHECK((turns.array() - std::numbers::pi / 10).abs().maxCoeff() < 1e-12);
}

TEST_CASE("prior deviations: the fit takes none for smaller than the typical one") {
  const Modalities modalities = modalities_of({two_second_walk()}, {});
  const auto columns = std::ssize(modalities.pose_scale.kept_columns());
  PosePrior prior(MatrixF::Zero(3, columns), MatrixF::Zero(3, columns));
  TrackFitSettings settings;
  settings.orientation_deviation_deg = 18;
  settings.root_m_s2 = 4;
  CHECK(fitted_turn_deviations_rad(prior, modalities, settings).minCoeff() ==
        doctest::Approx(std::numbers::pi / 10));
  CHECK(fitted_root_acceleration_deviation_m_s2(prior, modalities, settings) == 4);
  prior.deviation.setConstant(1000);
  CHECK(fitted_turn_deviations_rad(prior, modalities, settings) ==
        turn_deviations_rad(prior, modalities, settings));
  CHECK(fitted_root_acceleration_deviation_m_s2(prior, modalities, settings) ==
        root_acceleration_deviation_m_s2(prior, modalities, settings));
  CHECK(root_acceleration_deviation_m_s2(prior, modalities, settings) > 4);
}
