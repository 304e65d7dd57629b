// The fit of a clip that is still growing, beside that of the whole.

#include "fitting/sliding_fit.hpp"

#include <doctest/doctest.h>

#include <Eigen/Dense>

#include "fitting/length_information.hpp"
#include "fitting/terms/told_lengths.hpp"
#include "fitting/track_smoothing.hpp"
#include "fitting/walk_scene.hpp"
#include "motion/body_size.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

PosePrior some_rows(const PosePrior& prior, Eigen::Index first, Eigen::Index count) {
  return MatrixF(prior.mean.middleRows(first, count));
}

Track2d some_rows(const Track2d& track, Eigen::Index first, Eigen::Index count) {
  Track2d part = track;
  part.x_px = track.x_px.middleRows(first, count);
  part.y_px = track.y_px.middleRows(first, count);
  part.confidence = track.confidence.middleRows(first, count);
  return part;
}

/// Frame after frame, each settled when `lag` more have come. @return the channels as they settled
struct Slid {
  MatrixD channels;
  Skeleton body;
  std::vector<Motion> solutions;  ///< of every frame: what was held and open
};
Slid slid(const Scene& scene, const std::optional<Skeleton>& skeleton, Eigen::Index lag) {
  SlidingFit fit(scene.modalities, skeleton, *scene.known.camera, {});
  const Eigen::Index frames = scene.track.frames();
  Slid result{MatrixD(frames, scene.truth.channels.cols()), {}, {}};
  Eigen::Index first = 0, settled = 0;
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index count = t + 1 - first;
    fit.solve(some_rows(PosePrior(scene.mean), first, count), some_rows(scene.track, first, count),
              track_noise_px(some_rows(scene.track, 0, t + 1)));
    result.solutions.push_back(fit.motion());
    const Eigen::Index done = (t + 1 == frames ? frames : t + 1 - lag) - settled;
    if (done <= 0) continue;
    result.channels.middleRows(settled, done) = fit.motion().channels.middleRows(fit.held(), done);
    settled += done;
    first += fit.settle(done);
    CHECK(fit.held() <= SlidingFit::kHeld);
    CHECK(fit.motion().frames() == t + 1 - first);
  }
  result.body = fit.body();
  return result;
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
  const Slid got = slid(scene, scene.truth.skeleton, 8);
  const Motion motion{scene.truth.skeleton, scene.truth.frame_time_s, got.channels};
  const double from_whole = apart_mm(motion, scene.fit(), scene.modalities),
               from_truth = apart_mm(motion, scene.truth, scene.modalities),
               whole_from_truth = apart_mm(scene.fit(), scene.truth, scene.modalities),
               unfitted = apart_mm(scene.unfitted(), scene.truth, scene.modalities);
  CAPTURE(from_whole);
  CAPTURE(from_truth);
  CAPTURE(whole_from_truth);
  CHECK(from_whole < 10);
  CHECK(from_truth < whole_from_truth + 5);
  CHECK(from_truth < 0.3 * unfitted);
}

TEST_CASE("a sliding fit: the person's bones are told as frames come") {
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

TEST_CASE(
    "a sliding fit: the world may be seen by another camera, frames stay where it sees them") {
  const Scene scene = make_scene(1, 12);
  SlidingFit fit(scene.modalities, scene.truth.skeleton, *scene.known.camera, {});
  fit.solve(PosePrior(scene.mean), scene.track, 0);
  const Track2d before = fit.shown();
  Camera other = fit.camera();
  other.camera_from_world = other.camera_from_world * rotation_of(Eigen::Vector3d(0.1, 0.2, -0.1));
  other.translation += Eigen::Vector3d(3, -2, 1);
  fit.set_camera(other);
  const Track2d after = project_motion(fit.motion(), other);
  CHECK((after.x_px - before.x_px).cwiseAbs().maxCoeff() < 1e-6);
  CHECK((after.y_px - before.y_px).cwiseAbs().maxCoeff() < 1e-6);
}

TEST_CASE("told lengths: the energy is that of their normal distribution, derivatives right") {
  Eigen::MatrixXd factor(3, 3);
  factor << 2, 0, 0, 0.5, 3, 0, -1, 0.2, 0.7;
  const Eigen::MatrixXd information = factor * factor.transpose();
  const Eigen::Vector3d centre(0.1, -0.2, 0.05), at(0.3, 0.1, -0.4);
  const ToldLengths term(centre, information);
  const double* blocks[] = {&at[0], &at[1], &at[2]};
  Eigen::Vector3d residuals;
  Eigen::Vector3d columns[3];
  double* jacobians[] = {columns[0].data(), columns[1].data(), columns[2].data()};
  REQUIRE(term.Evaluate(blocks, residuals.data(), jacobians));
  CHECK(residuals.squaredNorm() == doctest::Approx((at - centre).dot(information * (at - centre))));
  Eigen::Matrix3d jacobian;
  jacobian << columns[0], columns[1], columns[2];
  CHECK((jacobian.transpose() * jacobian - information).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((jacobian * (at - centre) - residuals).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("information on lengths: as the inverse of a dense covariance has it") {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Random(30, 9);
  const Eigen::SparseMatrix<double> derivatives = dense.sparseView();
  const Eigen::MatrixXd all = dense.transpose() * dense;
  const Eigen::MatrixXd want = all.inverse().bottomRightCorner(3, 3).inverse();
  const Eigen::MatrixXd got = information_on_lengths(derivatives, 3);
  // A deviation of 10 of what is not told adds a hundredth to numbers of some 10.
  CHECK((got - want).cwiseAbs().maxCoeff() < 0.01 * want.cwiseAbs().maxCoeff());
  CHECK((got - all.bottomRightCorner(3, 3)).cwiseAbs().maxCoeff() > 0.05 * want.maxCoeff());
}
