// Motions that fit_to_track draws about the likeliest, and what sets their width.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "fitting/prior_deviations.hpp"
#include "fitting/walk_scene.hpp"
#include "motion/joint_uncertainty.hpp"

namespace fit_draws_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr PosteriorDraws kDraws{.count = 20, .seed = 4};

/// The scene's prior mean with the same deviation of every feature, in radians.
PosePrior prior_of(const Scene& scene, double deviation_rad) {
  const Eigen::VectorXd& scale = scene.modalities.pose_scale.deviation();
  const auto& kept = scene.modalities.pose_scale.kept_columns();
  MatrixF deviation(scene.mean.rows(), scene.mean.cols());
  for (std::size_t k = 0; k < kept.size(); ++k)
    deviation.col(static_cast<Eigen::Index>(k))
        .setConstant(static_cast<float>(deviation_rad / scale[kept[k]]));
  return {scene.mean, deviation};
}

FittedClip drawn(const Scene& scene, const PosePrior& prior, const TrackFitSettings& settings = {},
                 const PosteriorDraws& draws = kDraws) {
  return fit_to_track(prior, scene.modalities, scene.track, scene.known, settings, draws);
}

/// RMS over frames and axes, file units.
double width_of(const Scene& scene, const FittedClip& clip, const char* joint) {
  const MatrixD widths = joint_uncertainty(clip.motion, clip.draws);
  const MatrixD own = widths.middleCols(3 * scene.truth.skeleton.find(joint), 3);
  return std::sqrt(own.squaredNorm() / static_cast<double>(own.size()));
}

}  // namespace

TEST_CASE("fit draws: as many as are asked for, and the likeliest stays what it is") {
  const Scene scene = make_scene(1, 30);
  const FittedClip plain =
      fit_to_track(scene.mean, scene.modalities, scene.track, scene.known, TrackFitSettings{});
  CHECK(plain.draws.empty());
  const FittedClip clip = drawn(scene, scene.mean);
  CHECK(clip.motion.channels == plain.motion.channels);
  CHECK(clip.shown.x_px == plain.shown.x_px);
  REQUIRE(clip.draws.size() == 20);
  CHECK(clip.draws[0].channels == drawn(scene, scene.mean).draws[0].channels);
  CHECK(clip.draws[0].channels != clip.draws[1].channels);
  CHECK(clip.draws[0].channels != drawn(scene, scene.mean, {}, {1, 5}).draws[0].channels);
}

TEST_CASE("without a fit draws are what the prior leaves open, bones turned with their parents") {
  const Scene scene = make_scene(0, 30);
  constexpr double kDeviation_rad = 0.05;
  constexpr PosteriorDraws kMany{.count = 400, .seed = 4};
  const PosePrior prior = prior_of(scene, kDeviation_rad);
  const auto unfitted = [&](const PosteriorDraws& draws) {
    return fit_to_track(prior, scene.modalities, scene.track, scene.known, std::nullopt, draws);
  };
  const FittedClip clip = unfitted(kMany);
  CHECK(clip.motion.channels == unfitted({}).motion.channels);
  REQUIRE(clip.draws.size() == 400);
  // e of deviation s about every axis moves a bone b by e × b: 2 s² |b|² in all. Two bones, of
  // which the lower one's e is as the upper one's by the correlation k, add 4 k s s' b·b'.
  const MatrixD prior_rad = turn_deviations_rad(prior, scene.modalities, TrackFitSettings{});
  const auto bone = [&](const char* upper, const char* lower) {
    const MatrixD places = joint_positions(clip.motion);
    const std::vector<int>& turning = scene.modalities.pose_features.joints();
    const auto turn =
        std::ranges::find(turning, scene.modalities.pose_features.skeleton().find(upper)) -
        turning.begin();
    const MatrixD along = places.middleCols(3 * clip.motion.skeleton.find(lower), 3) -
                          places.middleCols(3 * clip.motion.skeleton.find(upper), 3);
    return (along.array().colwise() * prior_rad.col(turn).array()).matrix().eval();
  };
  const MatrixD hip = bone("Hips", "LeftUpLeg"), thigh = bone("LeftUpLeg", "LeftLeg");
  const double one = hip.squaredNorm(), two = one + thigh.squaredNorm(),
               together = 2 * TrackFitSettings{}.parent_correlation * hip.cwiseProduct(thigh).sum();
  const auto wanted = [&](double squares) {
    return std::sqrt(2 * squares / static_cast<double>(hip.size()));
  };
  CHECK(width_of(scene, clip, "LeftUpLeg") == doctest::Approx(wanted(one)).epsilon(0.1));
  CHECK(width_of(scene, clip, "LeftLeg") == doctest::Approx(wanted(two + together)).epsilon(0.1));
  CHECK(unfitted({1, 4}).draws[0].channels == clip.draws[0].channels);
  CHECK(unfitted({1, 5}).draws[0].channels != clip.draws[0].channels);
  // Nobody's own skeleton: its bones may be longer or shorter.
  KnownOfClip stranger = scene.known;
  stranger.skeleton.reset();
  const FittedClip bodies =
      fit_to_track(prior, scene.modalities, scene.track, stranger, std::nullopt, kMany);
  for (const Motion& draw : bodies.draws)
    CHECK((joint_positions(draw).leftCols<3>() - joint_positions(bodies.motion).leftCols<3>())
              .cwiseAbs()
              .maxCoeff() < 1e-9);  // the root stays
  double sum = 0;
  // Each by a tenth, and the body as a whole no larger or smaller for it.
  const auto thigh_to_shank = [](const Skeleton& body) {
    const auto length = [&](const char* joint) {
      return body.joints[static_cast<std::size_t>(body.find(joint))].offset.norm();
    };
    return length("LeftLeg") / length("LeftFoot");
  };
  for (const Motion& draw : bodies.draws)
    sum += std::pow(
        std::log(thigh_to_shank(draw.skeleton) / thigh_to_shank(bodies.motion.skeleton)), 2);
  CHECK(std::sqrt(sum / 400) == doctest::Approx(std::sqrt(2) * 0.1).epsilon(0.15));
}

TEST_CASE("fit draws: they spread as the settings specify, and less where the track shows") {
  const Scene scene = make_scene(0, 30);
  const FittedClip narrow = drawn(scene, scene.mean);
  TrackFitSettings settings;
  settings.draw_width_factor = 2.6;
  // Turns are rotations, so that twice the turn is not quite twice the distance.
  CHECK(width_of(scene, drawn(scene, scene.mean, settings), "LeftHand") /
            width_of(scene, narrow, "LeftHand") ==
        doctest::Approx(2).epsilon(0.05));
  Scene hidden = scene;
  hidden.track.confidence.col(hidden.track.find("LeftHand")).setZero();
  CHECK(width_of(hidden, drawn(hidden, hidden.mean), "LeftHand") >
        2 * width_of(scene, narrow, "LeftHand"));
}

TEST_CASE("fit draws: the prior's deviation counts as given, whatever the likeliest takes it for") {
  Scene scene = make_scene(0, 30);
  for (const char* joint : {"LeftForeArm", "LeftHand"})
    scene.track.confidence.col(scene.track.find(joint)).setZero();
  TrackFitSettings settings;
  settings.exact_prior_weight = 1;
  const double once = width_of(scene, drawn(scene, prior_of(scene, 0.2), settings), "LeftHand");
  const double twice = width_of(scene, drawn(scene, prior_of(scene, 0.4), settings), "LeftHand");
  CHECK(twice > 1.7 * once);
}

TEST_CASE("fit draws: a detector's error lasts throughout, whatever the likeliest takes it for") {
  const Scene scene = make_scene(0, 30);
  TrackFitSettings settings;
  settings.most_solutions = 1;
  settings.detector_noise_time_s = 0;
  const double brief = width_of(scene, drawn(scene, scene.mean, settings), "LeftHand");
  settings.detector_noise_time_s = 3;
  CHECK(width_of(scene, drawn(scene, scene.mean, settings), "LeftHand") / brief ==
        doctest::Approx(1).epsilon(0.02));
}

TEST_CASE("fit draws: an unknown body has one length of each bone a draw, and its own in each") {
  Scene scene = make_scene(0, 20);
  scene.known.skeleton.reset();
  const FittedClip clip = drawn(scene, scene.mean);
  const int knee = scene.truth.skeleton.find("LeftLeg"),
            other = scene.truth.skeleton.find("RightLeg");
  const auto length = [](const Motion& motion, int joint) {
    return motion.skeleton.joints[static_cast<std::size_t>(joint)].offset.norm();
  };
  CHECK(length(clip.draws[0], knee) != length(clip.motion, knee));
  CHECK(length(clip.draws[0], knee) != length(clip.draws[1], knee));
  CHECK(length(clip.draws[0], knee) == doctest::Approx(length(clip.draws[0], other)));
  const TrackFitSettings settings;
  const auto deviation_of = [&](const std::string& name) {
    if (name.ends_with("Leg") || name.ends_with("Foot")) return settings.leg_log_deviation;
    if (name.ends_with("ForeArm") || name.ends_with("Hand")) return settings.arm_log_deviation;
    return settings.bone_log_deviation;
  };
  for (const Motion& draw : clip.draws)
    for (int joint = 1; joint < draw.skeleton.joint_count(); ++joint) {
      const std::string& name = draw.skeleton.joints[static_cast<std::size_t>(joint)].name;
      CAPTURE(name);
      if (name.ends_with("UpLeg") || !(length(clip.motion, joint) > 0)) continue;  // none's bone
      CHECK(std::abs(std::log(length(draw, joint) / length(clip.motion, joint))) <=
            5 * settings.draw_width_factor * deviation_of(name));
    }
}

TEST_CASE("fit draws: a body that was found elsewhere stays, and draws doubt it all the same") {
  Scene scene = make_scene(0, 20);
  const auto thigh = [&](const Motion& motion) {
    return motion.skeleton.joints[static_cast<std::size_t>(motion.skeleton.find("LeftLeg"))]
        .offset.norm();
  };
  for (const bool fitted : {false, true}) {
    CAPTURE(fitted);
    std::optional<TrackFitSettings> settings;
    if (fitted) settings.emplace();
    for (const bool found : {false, true}) {
      CAPTURE(found);
      scene.known.skeleton_found = found;
      const FittedClip clip =
          fit_to_track(scene.mean, scene.modalities, scene.track, scene.known, settings, kDraws);
      CHECK(thigh(clip.motion) == doctest::Approx(thigh(scene.truth)));
      for (const Motion& draw : clip.draws)
        CHECK((std::abs(thigh(draw) / thigh(clip.motion) - 1) > 1e-6) == found);
    }
  }
}

TEST_CASE("fit draws: without a camera they lie about the motion at the origin") {
  Scene scene = make_scene(0, 20);
  scene.known.camera.reset();
  const FittedClip clip = drawn(scene, scene.mean);
  CHECK(clip.motion.channels == drawn(scene, scene.mean, {}, {}).motion.channels);
  MatrixD mean = MatrixD::Zero(20, 3), squares = mean;
  for (const Motion& draw : clip.draws) {
    const MatrixD root = joint_positions(draw).leftCols<3>();
    mean += root / static_cast<double>(clip.draws.size());
    squares += root.cwiseAbs2() / static_cast<double>(clip.draws.size());
  }
  const MatrixD widths = (squares - mean.cwiseAbs2()).cwiseSqrt();
  const MatrixD off = mean - joint_positions(clip.motion).leftCols<3>();
  // The mean of 20 draws, in each of 60 numbers that hang together.
  CHECK((off.array() / widths.array()).abs().maxCoeff() < 1);
}

}  // namespace fit_draws_test
