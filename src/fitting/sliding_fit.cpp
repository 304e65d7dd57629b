#include "fitting/sliding_fit.hpp"

#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "base/upper_median.hpp"
#include "fitting/prior_deviations.hpp"
#include "fitting/root_trajectory.hpp"
#include "fitting/rotation.hpp"
#include "fitting/tracked_joints.hpp"
#include "fitting/upright.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"

namespace mcdbn {
namespace {

/// Steps with each frame: until it settles it has several solutions. With 6 of them the answer is
/// no nearer to that of the whole clip, and takes half as long again.
constexpr int kIterations = 2;
/// A step that lowers the energy by less than this share is the last one.
constexpr double kSmallGain = 1e-3;
/// Solutions of so long a time tell what lasts of the track's noise.
constexpr double kLearned_s = 0.2;

/// The last rows are others; there may be more of them than before.
template <typename Rows>
void replace_behind(Rows& rows, Eigen::Index kept, const Rows& more) {
  rows.conservativeResize(kept + more.rows(), more.cols());
  rows.bottomRows(more.rows()) = more;
}

/// So many rows; those that are new are as the last.
void go_on(MatrixD& rows, Eigen::Index count, Eigen::Index columns) {
  const Eigen::Index before = rows.rows();
  const Eigen::RowVectorXd last =
      before > 0 ? Eigen::RowVectorXd(rows.row(before - 1)) : Eigen::RowVectorXd::Zero(columns);
  rows.conservativeResize(count, columns);
  for (Eigen::Index t = before; t < count; ++t) rows.row(t) = last;
}

template <typename Rows>
void drop_rows(Rows& rows, Eigen::Index count) {
  if (rows.rows() > 0) rows = Rows(rows.bottomRows(rows.rows() - count));
}

}  // namespace

SlidingFit::SlidingFit(const Modalities& modalities, const KnownOfClip& known, const Track2d& like,
                       const TrackFitSettings& settings)
    : modalities_(modalities),
      settings_(settings),
      skeleton_(known.skeleton ? *known.skeleton : modalities.pose_features.skeleton()),
      body_(skeleton_),
      body_unknown_(!known.skeleton),
      detected_(known.detected),
      camera_known_(known.camera.has_value()),
      units_per_m_(file_units_per_metre(skeleton_)),
      assumed_(in_file_units(known.camera_of(like, modalities), skeleton_)),
      camera_(assumed_),
      doubt_(doubt_of(known, modalities, like, settings)),
      names_(tracked_joints(modalities.track_features)) {}

Motion SlidingFit::decoded(const MatrixD& features, const Skeleton& skeleton, const Camera& camera,
                           const MatrixD& root) const {
  return modalities_.pose_features.decode(features, camera.camera_from_world, skeleton,
                                          modalities_.fps, root);
}

/// Held frames keep the prior that they settled with.
void SlidingFit::take_prior(const PosePrior& prior) {
  const Eigen::Index open = prior.mean.rows();
  replace_behind(prior_.mean, held_, prior.mean);
  if (prior.has_deviation()) replace_behind(prior_.deviation, held_, prior.deviation);
  replace_behind(mean_, held_, modalities_.pose_in_camera(prior.mean, camera_.camera_from_world));
  replace_behind(mean_lean_, held_, MatrixD(point_.lean.transpose().replicate(open, 1)));
}

/// Where the track shows the root of the body as the prior turns it.
MatrixD SlidingFit::placed_root(const Track2d& track, const MatrixD& velocity_m_s,
                                double velocity_error_m_s2) const {
  const MatrixD relative =
      positions_about(modalities_.root_name(), names_,
                      decoded(mean_, body_, camera_, MatrixD::Zero(mean_.rows(), 3)));
  const MatrixD root =
      root_trajectory(relative, track_rays(names_, track, camera_), camera_,
                      units_per_m_ * velocity_m_s * camera_.camera_from_world, velocity_error_m_s2);
  return ((root * camera_.camera_from_world.transpose()).rowwise() +
          camera_.translation.transpose()) /
         units_per_m_;
}

/// A new frame goes on as the prior says, from where the solution before ended. At first, and of
/// somebody who was out of sight, the track shows where.
void SlidingFit::place_root(const Track2d& track, const MatrixD& velocity_m_s,
                            double velocity_error_m_s2) {
  const Eigen::Index before = root_m_.rows();
  const bool somebody = before > 0 && (track.confidence.topRows(before).array() > 0).any();
  if (!somebody && (before == 0 || (track.confidence.array() > 0).any())) {
    try {
      root_m_ = placed_root(track, velocity_m_s, velocity_error_m_s2);
    } catch (const InputError&) {  // not enough of a body
      if (before == 0) throw;
    }
  }
  go_on(root_m_, mean_.rows(), 3);
  for (Eigen::Index t = std::max<Eigen::Index>(1, before); t < mean_.rows() && somebody; ++t)
    root_m_.row(t) = root_m_.row(t - 1) + velocity_m_s.row(t) / modalities_.fps;
}

void SlidingFit::solve(const PosePrior& prior, const Track2d& track, double track_noise_px) {
  take_prior(prior);
  const PoseFeatures& features = modalities_.pose_features;
  const MatrixD velocity_m_s = features.root_features(mean_).rightCols(3);
  const double root_m_s2 = fitted_root_acceleration_deviation_m_s2(prior_, modalities_, settings_);
  place_root(track, velocity_m_s, root_m_s2);

  MatrixD travelled = MatrixD::Zero(mean_.rows(), 3);
  for (Eigen::Index t = 1; t < travelled.rows(); ++t)
    travelled.row(t) = travelled.row(t - 1) + velocity_m_s.row(t) / modalities_.fps;
  const MatrixD root = ((root_m_ * units_per_m_).rowwise() - assumed_.translation.transpose()) *
                       assumed_.camera_from_world;
  problem_.reset();
  evidence_ = std::make_unique<ClipEvidence>(features, decoded(mean_, skeleton_, assumed_, root),
                                             units_per_m_ * travelled * assumed_.camera_from_world,
                                             track_rays(names_, track, assumed_), assumed_);
  PosteriorClip& clip = evidence_->clip;
  if (point_.log_lengths.size() == 0) point_ = PosteriorPoint::zero(clip);
  go_on(point_.turns, clip.frames(), point_.turns.cols());
  point_.shift = MatrixD::Zero(clip.frames(), 3);
  take(point_);
  evidence_->find_planted(motion_);
  // From where the solution before ended it would not leave a valley that few frames had led into.
  point_.turns.setZero();
  if (!past_) point_.ground_m = evidence_->ground(point_);
  clip.turn_deviation_rad = fitted_turn_deviations_rad(prior_, modalities_, settings_);
  clip.root_m_s2 = root_m_s2;
  clip.body_unknown = body_unknown_;
  clip.mean_lean = mean_lean_;
  clip.past = past_;
  clip.camera = doubt_;
  if (clip.camera)
    clip.camera->balanced =
        evidence_->balanced(upright(), settings_.balance_deg * kRadiansPerDegree);
  SeenNoise noise(track_noise_px, assumed_, evidence_->usual_depth_m(),
                  !body_unknown_ && !detected_, settings_, lasting_noise_);

  problem_ = std::make_unique<WindowProblem>(clip, noise.rays(), settings_, point_, 0,
                                             clip.frames(), Unknowns::tracked);
  problem_->solve(true, kSmallGain, past_ ? kIterations : WindowProblem::kMostIterations);
  point_ = problem_->solution();
  root_m_ = clip.root + point_.shift;
  learn(noise);
  take(point_);
  shown_ = project_motion(motion_, camera_);
}

/// As often as in a whole clip, each time from other solutions. Of the held frames: open ones, with
/// few or none behind them, come nearer to the rays than a whole clip's do.
void SlidingFit::learn(SeenNoise& noise) {
  if (!past_ || learned_ + 1 >= settings_.solutions) return;
  if (const double residual = evidence_->usual_residual(point_, held_); residual > 0)
    residuals_.push_back(residual);
  if (std::ssize(residuals_) < std::lround(kLearned_s * modalities_.fps)) return;
  learned_ = noise.learn(upper_median(std::move(residuals_))) ? learned_ + 1 : settings_.solutions;
  lasting_noise_ = noise.share();
  residuals_.clear();
}

void SlidingFit::take(const PosteriorPoint& point) {
  double scale = 1;
  if (body_unknown_) {  // one of 1.7 m, as fit_to_track has it
    body_ = evidence_->body(point);
    scale = units_per_m_ / file_units_per_metre(body_);
    for (Joint& joint : body_.joints) joint.offset *= scale;
  }
  if (!camera_known_)
    look_as(point,
            scale * units_per_m_ * (evidence_->clip.root.row(0) + point.shift.row(0)).transpose());
  motion_ = decoded(evidence_->turned(mean_, point), body_, camera_,
                    evidence_->root(point, scale, camera_));
}

/// The world turns about the place where the first frame showed the root, which stays.
void SlidingFit::look_as(const PosteriorPoint& point, const Eigen::Vector3d& first_root) {
  camera_.camera_from_world = rotation_of(point.lean) * assumed_.camera_from_world;
  camera_.fx_px = std::exp(point.log_focal) * assumed_.fx_px;
  camera_.fy_px = std::exp(point.log_focal) * assumed_.fy_px;
  if (settled_ == 0) {
    first_root_ = first_root;
    first_height_ = units_per_m_ * modalities_.pose_features.root_features(mean_).col(0).mean();
  }
  camera_.translation = first_root_ - first_height_ * camera_.camera_from_world.col(1);
}

/// From the feet to the body's middle, the mean of all frames so far.
Eigen::Vector3d SlidingFit::upright() const {
  const auto open = static_cast<double>(motion_.frames() - held_);
  return upright_sum_ + open * upright_in_camera(motion_, camera_);
}

Eigen::Index SlidingFit::settle(Eigen::Index frames) {
  upright_sum_ += static_cast<double>(frames) * upright_in_camera(motion_, camera_);
  settled_ += frames;
  held_ += frames;
  const Eigen::Index dropped = std::max<Eigen::Index>(0, held_ - kHeld);
  if (dropped == 0) return 0;
  past_ = problem_->without_first(dropped);
  held_ -= dropped;
  for (MatrixD* rows : {&mean_, &mean_lean_, &root_m_, &point_.turns, &motion_.channels,
                        &shown_.x_px, &shown_.y_px, &shown_.confidence})
    drop_rows(*rows, dropped);
  drop_rows(prior_.mean, dropped);
  drop_rows(prior_.deviation, dropped);
  return dropped;
}

}  // namespace mcdbn
