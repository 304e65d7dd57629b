// The fit of a clip that is still growing, beside that of the whole.

#include "fitting/sliding_fit.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "fitting/quadratic_energy.hpp"
#include "fitting/sliding_scene.hpp"
#include "fitting/terms/normal_term.hpp"
#include "fitting/walk_scene.hpp"
#include "fitting/window_problem.hpp"
#include "motion/body_size.hpp"

// Ceres includes glog, which has a CHECK of its own.
#undef CHECK
#define CHECK DOCTEST_CHECK

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Frame after frame, each settled when `lag` more have come: the channels as they settled.
struct Slid {
  MatrixD channels;
  Skeleton body;
};
Slid slid(const Scene& scene, const std::optional<Skeleton>& skeleton, Eigen::Index lag,
          const TrackFitSettings& settings, const PosePrior& prior) {
  SlidingFit fit(scene.modalities, {scene.known.camera, skeleton}, scene.track, settings);
  MatrixD channels = settled_channels(fit, prior, scene.track, lag, [](Eigen::Index) {});
  return {std::move(channels), fit.body()};
}

Slid slid(const Scene& scene, const std::optional<Skeleton>& skeleton, Eigen::Index lag,
          const TrackFitSettings& settings = {}) {
  return slid(scene, skeleton, lag, settings, scene.mean);
}

/// Mean distance from the root, mm of a 1.7 m body.
double apart_mm(const Motion& one, const Motion& other, const Modalities& modalities) {
  const auto names = modalities.track_features.joint_names();
  const auto places = [&](const Motion& motion) -> MatrixD {
    return 1000 / file_units_per_metre(motion.skeleton) *
           joints_about(motion, names, modalities.root_name());
  };
  const MatrixD off = places(one) - places(other);
  double sum = 0;
  for (Eigen::Index column = 0; column < off.cols(); column += 3)
    sum += off.middleCols<3>(column).rowwise().norm().mean();
  return 3 * sum / static_cast<double>(off.cols());
}

}  // namespace

TEST_CASE("a sliding fit: eight frames later it is where the whole clip's fit is") {
  const Scene scene = make_scene();
  TrackFitSettings settings;
  settings.most_solutions = 1;  // how exact the track is, either would learn at its own pace
  const Slid got = slid(scene, scene.truth.skeleton, 8, settings);
  const Motion motion{scene.truth.skeleton, scene.truth.frame_time_s, got.channels},
      whole = scene.fit(scene.track, settings);
  const double from_whole = apart_mm(motion, whole, scene.modalities),
               from_truth = apart_mm(motion, scene.truth, scene.modalities),
               whole_from_truth = apart_mm(whole, scene.truth, scene.modalities),
               unfitted = apart_mm(scene.unfitted(), scene.truth, scene.modalities);
  CAPTURE(from_whole);
  CAPTURE(from_truth);
  CAPTURE(whole_from_truth);
  CHECK(from_whole < 10);
  CHECK(from_truth < whole_from_truth + 5);
  CHECK(from_truth < 0.5 * unfitted);
}

TEST_CASE("a sliding fit: a prior that is surer than usual counts as one without deviations") {
  const Scene scene = make_scene();
  const auto channels = [&](const PosePrior& prior) {
    return slid(scene, scene.truth.skeleton, 8, {}, prior).channels;
  };
  CHECK(channels({scene.mean, MatrixF::Zero(scene.mean.rows(), scene.mean.cols())}) ==
        channels(scene.mean));
}

TEST_CASE("a sliding fit: each joint moves as far as its own features' deviation lets it") {
  const Scene scene = make_scene();
  const Modalities& m = scene.modalities;
  const std::vector<std::string> names = m.pose_features.feature_names();
  const auto columns_of = [&](const std::string& joint) {
    std::vector<Eigen::Index> columns;
    for (std::size_t k = 0; k < m.pose_scale.kept_columns().size(); ++k)
      if (names[static_cast<std::size_t>(m.pose_scale.kept_columns()[k])].starts_with(joint + "_"))
        columns.push_back(static_cast<Eigen::Index>(k));
    REQUIRE_FALSE(columns.empty());
    return columns;
  };
  PosePrior prior{scene.mean, MatrixF::Zero(scene.mean.rows(), scene.mean.cols())};
  for (const Eigen::Index column : columns_of("LeftForeArm"))
    prior.deviation.col(column).setConstant(10);  // of how far they stray in the clip
  TrackFitSettings settings;
  settings.orientation_deviation_deg = 0.1;
  const Motion motion{scene.truth.skeleton, scene.truth.frame_time_s,
                      slid(scene, scene.truth.skeleton, 8, settings, prior).channels};
  const MatrixF off = m.encode_pose(motion, scene.known.camera->camera_from_world) - scene.mean;
  const auto moved = [&](const std::string& joint) {
    double sum = 0;
    for (const Eigen::Index column : columns_of(joint)) sum += off.col(column).norm();
    return sum;
  };
  CHECK(moved("LeftForeArm") > 5 * moved("RightForeArm"));
}

TEST_CASE("a sliding fit: that a track is exact shows within a second") {
  const Scene scene = make_scene();
  TrackFitSettings unlearned;
  unlearned.most_solutions = 1;
  const auto off_mm = [&](const TrackFitSettings& settings) {
    const Slid got = slid(scene, scene.truth.skeleton, 8, settings);
    Motion second{scene.truth.skeleton, scene.truth.frame_time_s, got.channels.bottomRows(30)};
    Motion truth = scene.truth;
    truth.channels = MatrixD(scene.truth.channels.bottomRows(30));
    return apart_mm(second, truth, scene.modalities);
  };
  const double learned = off_mm({}), otherwise = off_mm(unlearned);
  CAPTURE(learned);
  CAPTURE(otherwise);
  CHECK(learned < 0.8 * otherwise);
}

TEST_CASE("a sliding fit: the person's bones are found as frames come") {
  Scene scene = make_scene();
  Skeleton model = scene.truth.skeleton;
  for (Joint& joint : model.joints)
    if (joint.name.find("Leg") != std::string::npos || joint.name.find("Foot") != std::string::npos)
      joint.offset *= 1.15;
  const auto ratio = [](const Skeleton& body) {
    const auto length = [&](const char* name) {
      return body.joints[static_cast<std::size_t>(body.find(name))].offset.norm();
    };
    return length("LeftFoot") / length("LeftForeArm");
  };
  REQUIRE(ratio(model) > 1.1 * ratio(scene.truth.skeleton));
  Scene longer = scene;
  longer.modalities.pose_features = PoseFeatures::restored(
      model, scene.modalities.pose_features.root(), scene.modalities.pose_features.joints(),
      scene.modalities.pose_features.fixed_channels());
  const Slid got = slid(longer, {}, 8);
  CHECK(std::abs(std::log(ratio(got.body) / ratio(scene.truth.skeleton))) <
        0.5 * std::log(ratio(model) / ratio(scene.truth.skeleton)));
}

TEST_CASE("a sliding fit: looking back finds the body that the whole clip's fit finds") {
  Scene scene = make_scene();
  scene.known.skeleton.reset();
  const Slid got = slid(scene, {}, 8);
  Motion whole = scene.fit();
  const auto length = [](const Skeleton& body, const char* name) {
    return body.joints[static_cast<std::size_t>(body.find(name))].offset.norm();
  };
  for (const char* name : {"LeftFoot", "LeftLeg", "LeftForeArm", "LeftHand", "Neck"}) {
    CAPTURE(std::string(name));
    const double off = std::log(length(got.body, name) / length(whole.skeleton, name));
    CAPTURE(off);
    CHECK(std::abs(off) < 0.02);
  }
  const Motion second{got.body, whole.frame_time_s, got.channels.bottomRows(30)};
  whole.channels = MatrixD(whole.channels.bottomRows(30));
  const double apart = apart_mm(second, whole, scene.modalities);
  CAPTURE(apart);
  CHECK(apart < 5);
}

TEST_CASE("a sliding fit: after a past solution it is no matter how solutions went before") {
  TrackFitSettings settings;
  settings.most_solutions = 1;  // how noisy the track is they would learn at their own pace
  constexpr Eigen::Index kLag = 8, kSettled = 19;
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Scene scene = make_scene(seed);
    const auto after = [&](const std::vector<Eigen::Index>& solved) {
      SlidingFit fit(scene.modalities, {scene.known.camera, {}}, scene.track, settings);
      Eigen::Index first = 0;
      for (const Eigen::Index end : solved) {
        const Eigen::Index held = fit.held(), count = end - first;
        fit.solve(some_rows(scene.mean, first + held, count - held),
                  some_rows(scene.track, first, count), 0.1);
        if (end > kLag && end != solved.back()) first += fit.settle(end - kLag - first - held);
      }
      Motion held = fit.motion();
      held.channels.conservativeResize(fit.held(), Eigen::NoChange);
      return held;
    };
    std::vector<Eigen::Index> frame_by_frame(kSettled + kLag + 1);
    std::iota(frame_by_frame.begin(), frame_by_frame.end(), 1);
    const double apart = apart_mm(after(frame_by_frame),
                                  after({kSettled + kLag, kSettled + kLag + 1}), scene.modalities);
    CAPTURE(seed);
    CAPTURE(apart);
    CHECK(apart < 1.2);
  }
}

TEST_CASE("a sliding fit: it keeps looking back, and its thread's pace changes nothing") {
  const Scene scene = make_scene();
  const auto again = [](const auto& rows, Eigen::Index first, Eigen::Index count) {
    std::decay_t<decltype(rows)> part(count, rows.cols());
    for (Eigen::Index t = 0; t < count; ++t) part.row(t) = rows.row((first + t) % rows.rows());
    return part;
  };
  const auto bodies = [&] {
    constexpr Eigen::Index kFrames = 160, kLag = 8;  // five seconds
    SlidingFit fit(scene.modalities, {scene.known.camera, {}}, scene.track, {});
    std::vector<double> lengths;
    Eigen::Index first = 0;
    for (Eigen::Index t = 0; t < kFrames; ++t) {
      const Eigen::Index held = fit.held(), count = t + 1 - first;
      Track2d track = scene.track;
      for (MatrixD Track2d::*rows : {&Track2d::x_px, &Track2d::y_px, &Track2d::confidence})
        track.*rows = again(scene.track.*rows, first, count);
      fit.solve(again(scene.mean, first + held, count - held), track, 0.1);
      if (t >= kLag) first += fit.settle(1);
      lengths.push_back(fit.body().joints[3].offset.norm());
    }
    return lengths;
  };
  const std::vector<double> lengths = bodies();
  CHECK(lengths == bodies());
  CHECK(lengths[159] != lengths[125]);  // both more than three seconds after the first
}

namespace {

/// How far a frame with few frames behind it and one with many moved, over some solutions.
struct Moved {
  double settling_mm = 0, newest_mm = 0;
};

Moved moved_by(const Scene& scene, const KnownOfClip& known, const TrackFitSettings& settings,
               const std::vector<Eigen::Index>& solutions) {
  SlidingFit fit(scene.modalities, known, scene.track, settings);
  constexpr Eigen::Index kLag = 8;
  Eigen::Index first = 0;
  Moved moved;
  for (Eigen::Index t = 0; t < scene.track.frames(); ++t) {
    const Eigen::Index count = t + 1 - first;
    Motion before = fit.motion();
    const Eigen::Index held = fit.held();
    fit.solve(some_rows(scene.mean, first + held, count - held),
              some_rows(scene.track, first, count), 0.1);
    const auto moved_mm = [&](Eigen::Index frame) {
      Motion now = fit.motion(), then = before;
      now.channels = MatrixD(fit.motion().channels.row(frame));
      then.channels = MatrixD(before.channels.row(frame));
      return apart_mm(now, then, scene.modalities);
    };
    if (std::ranges::find(solutions, t) != solutions.end()) {
      moved.settling_mm += moved_mm(held);
      moved.newest_mm += moved_mm(held + kLag - 1);
    }
    if (t >= kLag) first += fit.settle(1);
  }
  return moved;
}

}  // namespace

TEST_CASE("a sliding fit: what settles does not jump where the past is looked at again") {
  const Scene scene = make_scene();
  TrackFitSettings settings;
  settings.most_solutions = 1;  // no noise is learned
  // It is looked back when 5 frames have settled, and half as many more each time.
  const Moved moved =
      moved_by(scene, {std::nullopt, scene.truth.skeleton}, settings, {13, 17, 21, 27, 36, 50});
  CAPTURE(moved.settling_mm);
  CAPTURE(moved.newest_mm);
  CHECK(moved.newest_mm > 5);
  CHECK(moved.settling_mm < 0.35 * moved.newest_mm);
}

TEST_CASE("a sliding fit: what settles does not jump where less noise is learned") {
  const Scene scene = make_scene();
  // It is learned each fifth of a second, from when the first frame is dropped.
  const Moved moved = moved_by(scene, {scene.known.camera, scene.truth.skeleton}, {}, {19, 25, 31});
  CAPTURE(moved.settling_mm);
  CAPTURE(moved.newest_mm);
  CHECK(moved.newest_mm > 5);
  CHECK(moved.settling_mm < 0.35 * moved.newest_mm);
}

TEST_CASE("a sliding fit: what dropped frames add leaves the others where all frames put them") {
  const Scene scene = make_scene(1, 14);
  const Skeleton& model = scene.truth.skeleton;
  const std::vector<std::string> names = scene.modalities.track_features.joint_names();
  const TrackRays rays = track_rays(names, scene.track, *scene.known.camera);
  const PoseFeatures& features = scene.modalities.pose_features;
  const MatrixD mean =
      scene.modalities.pose_in_camera(scene.mean, scene.known.camera->camera_from_world);
  const MatrixD root = joint_positions(scene.truth).leftCols(3);
  const Motion answer = features.decode(mean, scene.known.camera->camera_from_world, model,
                                        scene.modalities.fps, root);
  const auto clip_of = [&](Eigen::Index first) {
    Motion part = answer;
    part.channels = MatrixD(answer.channels.bottomRows(answer.frames() - first));
    TrackRays seen = rays;
    seen.rays = MatrixD(rays.rays.bottomRows(part.frames()));
    seen.confidence = MatrixD(rays.confidence.bottomRows(part.frames()));
    ClipEvidence evidence(features, part, MatrixD::Zero(part.frames(), 3), seen,
                          *scene.known.camera);
    evidence.clip.turn_deviation_rad =
        MatrixD::Constant(part.frames(), std::ssize(evidence.clip.parents), 0.15);
    evidence.clip.body_unknown = true;
    evidence.find_planted(part);
    return evidence.clip;
  };
  constexpr Eigen::Index kDropped = 5;
  const RayNoise noise{1e-3, 2e-3};
  const TrackFitSettings settings;
  const PosteriorClip whole = clip_of(0);
  WindowProblem problem(whole, noise, settings, PosteriorPoint::zero(whole), 0, 14, Unknowns::all);
  // To the very end, so that the energy is level there.
  for (int round = 0; round < 40; ++round) problem.solve(true, 1e-12, 100);
  PosteriorClip rest = clip_of(kDropped);
  PosteriorPoint want = problem.solution();
  for (const auto rows : {&PosteriorPoint::turns, &PosteriorPoint::shift})
    want.*rows = MatrixD((want.*rows).bottomRows(14 - kDropped));
  const auto apart = [&] {
    WindowProblem behind(rest, noise, settings, want, 0, 14 - kDropped, Unknowns::all);
    for (int round = 0; round < 40; ++round) behind.solve(false, 1e-12, 100);
    return (behind.solution().turns - want.turns).cwiseAbs().maxCoeff();
  };
  const double alone = apart();
  rest.past = problem.without_first(kDropped);
  const double marginal = apart();
  CAPTURE(alone);
  CAPTURE(marginal);
  CHECK(marginal < 0.003);
  CHECK(marginal < 0.1 * alone);
}

TEST_CASE("normal term: the energy is that of its distribution, derivatives right") {
  Eigen::MatrixXd factor(3, 3);
  factor << 2, 0.5, -1, 0, 3, 0.2, 0, 0, 0.7;
  const Eigen::Vector3d centre(0.1, -0.2, 0.05), at(0.3, 0.1, -0.4), residual(1, 2, 3);
  const NormalTerm term(factor, centre, residual, {1, 2});
  const double* blocks[] = {&at[0], &at[1]};
  Eigen::Vector3d residuals, first;
  Eigen::Matrix<double, 3, 2, Eigen::RowMajor> second;
  double* jacobians[] = {first.data(), second.data()};
  REQUIRE(term.Evaluate(blocks, residuals.data(), jacobians));
  CHECK((residuals - factor * (at - centre) - residual).norm() < 1e-12);
  Eigen::Matrix3d jacobian;
  jacobian << first, second;
  CHECK(jacobian == factor);
}

TEST_CASE("a quadratic energy without some unknowns: as the inverse of a dense covariance has it") {
  const Eigen::MatrixXd factor = Eigen::MatrixXd::Random(9, 9);
  const Eigen::VectorXd off = Eigen::VectorXd::Random(9);
  std::vector<double> x(9, 0.25);
  ceres::Problem problem;
  const auto* term = problem.AddResidualBlock(
      new NormalTerm(factor, Eigen::VectorXd::Zero(9), off, {4, 5}), nullptr, {&x[0], &x[4]});
  QuadraticEnergy energy({{&x[0], 4}, {&x[4], 5}});
  energy.add(problem, const_cast<ceres::ResidualBlockId>(term));
  const MarginalPrior marginal = energy.without_first(4);
  const Eigen::MatrixXd all = factor.transpose() * factor;
  const Eigen::MatrixXd want = all.inverse().bottomRightCorner(5, 5).inverse();
  CHECK((marginal.factor.transpose() * marginal.factor - want).cwiseAbs().maxCoeff() < 1e-9);
  // Both energies are least at the same place.
  const Eigen::VectorXd least = -factor.lu().solve(off);
  CHECK((marginal.factor * (least.tail(5) - marginal.at) + marginal.residual).norm() < 1e-8);
}

TEST_CASE("a quadratic energy of some unknowns: the others stay as they are") {
  const Eigen::MatrixXd factor = Eigen::MatrixXd::Random(9, 9);
  const Eigen::VectorXd off = Eigen::VectorXd::Random(9);
  std::vector<double> x(9, 0.25);
  ceres::Problem problem;
  const auto* term =
      problem.AddResidualBlock(new NormalTerm(factor, Eigen::VectorXd::Zero(9), off, {4, 3, 2}),
                               nullptr, {&x[0], &x[4], &x[7]});
  QuadraticEnergy energy({{&x[0], 4}, {&x[7], 2}});
  energy.add(problem, const_cast<ceres::ResidualBlockId>(term));
  const MarginalPrior marginal = energy.without_first(4);
  Eigen::MatrixXd asked(9, 6);
  asked << factor.leftCols(4), factor.rightCols(2);
  const Eigen::MatrixXd all = asked.transpose() * asked;
  const Eigen::MatrixXd want = all.inverse().bottomRightCorner(2, 2).inverse();
  CHECK((marginal.factor.transpose() * marginal.factor - want).cwiseAbs().maxCoeff() < 1e-9);
  const Eigen::VectorXd rest = factor * Eigen::VectorXd::Constant(9, 0.25) + off;
  const Eigen::VectorXd least =
      Eigen::VectorXd::Constant(6, 0.25) - asked.colPivHouseholderQr().solve(rest);
  CHECK((marginal.factor * (least.tail(2) - marginal.at) + marginal.residual).norm() < 1e-8);
}
