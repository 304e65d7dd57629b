#include "fitting/sliding_fit.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/clip_evidence.hpp"
#include "fitting/length_information.hpp"
#include "fitting/prior_deviations.hpp"
#include "fitting/root_trajectory.hpp"
#include "fitting/seen_noise.hpp"
#include "fitting/tracked_joints.hpp"
#include "fitting/window_problem.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// At most, with each frame.
constexpr int kIterations = 8;
/// Solutions that the noise is told by: few, so that an exact track is found out soon.
constexpr int kResiduals = 6;

}  // namespace

SlidingFit::SlidingFit(const Modalities& modalities, const std::optional<Skeleton>& skeleton,
                       const Camera& camera, const TrackFitSettings& settings)
    : modalities_(modalities),
      settings_(settings),
      skeleton_(skeleton ? *skeleton : modalities.pose_features.skeleton()),
      body_(skeleton_),
      body_unknown_(!skeleton),
      units_per_m_(file_units_per_metre(skeleton_)),
      camera_(in_file_units(camera, skeleton_)),
      names_(tracked_joints(modalities.track_features)) {}

MatrixD SlidingFit::world_path(const MatrixD& root_m) const {
  // x_camera = R·x_world + t, row by row.
  return ((root_m * units_per_m_).rowwise() - camera_.translation.transpose()) *
         camera_.camera_from_world;
}

MatrixD SlidingFit::camera_path(const MatrixD& world) const {
  return ((world * camera_.camera_from_world.transpose()).rowwise() +
          camera_.translation.transpose()) /
         units_per_m_;
}

Motion SlidingFit::decoded(const MatrixD& features, const Skeleton& skeleton) const {
  return modalities_.pose_features.decode(features, camera_.camera_from_world, skeleton,
                                          modalities_.fps, world_path(root_m_));
}

/// Where a solution starts: in the prior's mean, the root where the track shows it, as in the whole
/// clip. From the solution before it would not leave a valley that few frames had led it into.
/// While nobody is seen the root goes on as the prior says.
void SlidingFit::start(const MatrixD& mean, const TrackRays& rays, const MatrixD& velocity_m_s,
                       double velocity_error_m_s2) {
  const Eigen::Index frames = mean.rows(), before = root_m_.rows();
  const MatrixD still = MatrixD::Zero(frames, 3);
  const MatrixD all = joint_positions(modalities_.pose_features.decode(
      mean, camera_.camera_from_world, skeleton_, modalities_.fps, still));
  const MatrixD zero = all.middleCols(3 * skeleton_.find(modalities_.root_name()), 3);
  MatrixD relative(frames, 3 * std::ssize(names_));
  for (std::size_t i = 0; i < names_.size(); ++i)
    relative.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
        all.middleCols(3 * skeleton_.find(names_[i]), 3) - zero;
  try {
    root_m_ = camera_path(root_trajectory(
        relative, rays, camera_, MatrixD(units_per_m_ * velocity_m_s * camera_.camera_from_world),
        velocity_error_m_s2));
  } catch (const InputError&) {
    if (before == 0) throw;
    root_m_.conservativeResize(frames, 3);
    for (Eigen::Index t = before; t < frames; ++t)
      root_m_.row(t) = root_m_.row(t - 1) + velocity_m_s.row(t) / modalities_.fps;
  }
}

void SlidingFit::solve(const PosePrior& prior, const Track2d& track, double track_noise_px) {
  const PoseFeatures& features = modalities_.pose_features;
  const MatrixD mean = modalities_.pose_in_camera(prior.mean, camera_.camera_from_world);
  const MatrixD velocity_m_s = features.root_features(mean).rightCols(3);
  const TrackRays rays = track_rays(names_, track, camera_);
  const double root_m_s2 = root_acceleration_deviation_m_s2(prior, modalities_, settings_);
  start(mean, rays, velocity_m_s, root_m_s2);

  MatrixD travelled = MatrixD::Zero(mean.rows(), 3);
  for (Eigen::Index t = 1; t < travelled.rows(); ++t)
    travelled.row(t) = travelled.row(t - 1) + velocity_m_s.row(t) / modalities_.fps;
  ClipEvidence evidence(features, decoded(mean, skeleton_),
                        units_per_m_ * travelled * camera_.camera_from_world, rays, camera_);
  PosteriorClip& clip = evidence.clip;
  PosteriorPoint point = PosteriorPoint::zero(clip);
  if (log_lengths_.size() == 0) {
    log_lengths_ = point.log_lengths;
    told_ = {log_lengths_, Eigen::MatrixXd::Identity(log_lengths_.size(), log_lengths_.size()) /
                               (settings_.proportions * settings_.proportions)};
  }
  point.log_lengths = log_lengths_;
  evidence.find_planted(decoded(evidence.turned(mean, point), body_));
  clip.turn_deviation_rad = turn_deviations_rad(prior, modalities_, settings_);
  clip.root_m_s2 = root_m_s2;
  clip.body_unknown = body_unknown_;
  clip.body_told = told_;
  SeenNoise noise(track_noise_px, camera_, evidence.usual_depth_m(), !body_unknown_, settings_);
  if (residuals_ > 0) noise.settle_on(std::exp(log_residual_));

  WindowProblem problem(clip, noise.rays(), settings_, point, 0, clip.frames());
  problem.solve(body_unknown_, kIterations);
  point = problem.solution();
  root_m_ = clip.root + point.shift;
  log_lengths_ = point.log_lengths;
  if (const double residual = evidence.usual_residual(point); residual > 0) {
    residuals_ = std::min(residuals_ + 1, kResiduals);
    log_residual_ += (std::log(residual) - log_residual_) / residuals_;
  }
  if (body_unknown_ && untold_ > 0 && untold_ >= clip.frames())
    tell_of_body(clip, noise.rays(), point);
  body_ = evidence.body(point);
  features_ = evidence.turned(mean, point);
  motion_ = decoded(features_, body_);
  shown_ = project_motion(motion_, camera_);
}

void SlidingFit::set_camera(const Camera& camera) {
  camera_ = camera;
  if (root_m_.rows() > 0) motion_ = decoded(features_, body_);
}

/// All frames are others than when the body was told last: what they say of it is new.
void SlidingFit::tell_of_body(const PosteriorClip& clip, const RayNoise& noise,
                              const PosteriorPoint& point) {
  PosteriorClip frames = clip;
  frames.body_told->information.setZero();
  WindowProblem problem(frames, noise, settings_, point, 0, frames.frames());
  told_.information += information_on_lengths(problem.derivatives(), log_lengths_.size());
  told_.log_lengths = log_lengths_;
  untold_ = 0;
}

Eigen::Index SlidingFit::settle(Eigen::Index frames) {
  held_ += frames;
  untold_ += frames;
  const Eigen::Index dropped = std::max<Eigen::Index>(0, held_ - kHeld);
  held_ -= dropped;
  for (MatrixD* rows :
       {&root_m_, &features_, &motion_.channels, &shown_.x_px, &shown_.y_px, &shown_.confidence})
    *rows = MatrixD(rows->bottomRows(rows->rows() - dropped));
  return dropped;
}

}  // namespace mcdbn
