#include "fitting/sliding_fit.hpp"

#include <algorithm>
#include <cmath>

#include "base/interruption.hpp"
#include "base/upper_median.hpp"
#include "fitting/prior_deviations.hpp"
#include "fitting/root_trajectory.hpp"
#include "fitting/tracked_joints.hpp"
#include "fitting/usual_body.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/body_size.hpp"
#include "motion/interpolated_pose.hpp"

namespace mcdbn {
namespace {

/// Steps with each frame: until it settles it has several solutions. With 6 of them the answer is
/// no nearer to that of the whole clip, and takes half as long again.
constexpr int kIterations = 2;
/// A step that lowers the energy by less than this share is the last one.
constexpr double kSmallGain = 1e-3;
/// Time whose solutions give an estimate of the track's lasting noise.
constexpr double kLearned_s = 0.2;
/// Length of the past that is solved again: that of the window in which fit_to_track finds body and
/// camera. With 8 s the answer is 0.6 mm further from that of the whole clip.
constexpr double kPastSolution_s = 15;
/// How often it is; while the clip is short, after half as many frames again.
constexpr double kPastSolutionEvery_s = 0.5;
constexpr long long kPastSolutionAfter = 4;
/// Longest past whose solution the frames wait for: it takes no longer than a frame or two, and is
/// worth two millimetres. A longer one's result is taken when the next solution of the past begins.
constexpr double kWaitedFor_s = 3;
/// Settled frames that the held ones' prior is computed from, once the body has changed.
constexpr Eigen::Index kBeforeHeld = 8;

/// Replaces the rows from `kept` on; there may be more of them than before.
template <typename Rows>
void replace_tail(Rows& rows, Eigen::Index kept, const Rows& more) {
  rows.conservativeResize(kept + more.rows(), more.cols());
  rows.bottomRows(more.rows()) = more;
}

/// Extends to `count` rows: new rows repeat the last one, or are 0 where there is none.
void extend_with_last_row(MatrixD& rows, Eigen::Index count, Eigen::Index columns) {
  const Eigen::Index before = rows.rows();
  const Eigen::RowVectorXd last =
      before > 0 ? Eigen::RowVectorXd(rows.row(before - 1)) : Eigen::RowVectorXd::Zero(columns);
  rows.conservativeResize(count, columns);
  for (Eigen::Index t = before; t < count; ++t) rows.row(t) = last;
}

void drop_rows(MatrixD& rows, Eigen::Index count) {
  rows = rows.bottomRows(std::max<Eigen::Index>(0, rows.rows() - count)).eval();
}

}  // namespace

SlidingFit::SlidingFit(const Modalities& modalities, const KnownOfClip& known, const Track2d& like,
                       const TrackFitSettings& settings)
    : modalities_(modalities),
      settings_(settings),
      skeleton_(body_to_begin_with(known, modalities)),
      body_(skeleton_),
      body_unknown_(!known.skeleton),
      may_be_exact_(known.may_be_exact()),
      camera_known_(known.camera.has_value()),
      units_per_m_(file_units_per_metre(skeleton_)),
      assumed_(in_file_units(known.camera_of(like, modalities), skeleton_)),
      camera_(assumed_),
      unknown_camera_(unknown_camera_of(known, modalities, like, settings)),
      names_(tracked_joints(modalities.track_features)) {}

Motion SlidingFit::decoded(const MatrixD& features, const Skeleton& skeleton, const Camera& camera,
                           const MatrixD& root) const {
  return modalities_.pose_features.decode(features, camera.camera_from_world, skeleton,
                                          modalities_.fps, root);
}

/// Held frames keep the prior that they settled with.
void SlidingFit::take_prior(const PosePrior& prior) {
  const Eigen::Index open = prior.mean.rows();
  replace_tail(rows_.prior.mean, held_, prior.mean);
  if (prior.has_deviation()) replace_tail(rows_.prior.deviation, held_, prior.deviation);
  replace_tail(rows_.mean, held_,
               modalities_.pose_in_camera(prior.mean, camera_.camera_from_world));
  replace_tail(rows_.mean_lean, held_, MatrixD(camera_lean_.transpose().replicate(open, 1)));
}

/// Where the track shows the root of the body as the prior turns it.
MatrixD SlidingFit::placed_root(const MatrixD& velocity_m_s) const {
  const MatrixD relative =
      positions_about(modalities_.root_name(), names_,
                      decoded(rows_.mean, body_, camera_, MatrixD::Zero(rows_.frames(), 3)));
  const MatrixD root =
      root_trajectory(relative, track_rays(names_, rows_.track, camera_), camera_,
                      units_per_m_ * velocity_m_s * camera_.camera_from_world,
                      fitted_root_acceleration_deviation_m_s2(rows_.prior, modalities_, settings_))
          .root;
  return ((root * camera_.camera_from_world.transpose()).rowwise() +
          camera_.translation.transpose()) /
         units_per_m_;
}

/// A new frame goes on with the prior's velocity from where the solution before ended. At first,
/// and after the person was hidden, the track gives the place.
void SlidingFit::place_root() {
  const Track2d& track = rows_.track;
  const MatrixD velocity_m_s = modalities_.pose_features.root_features(rows_.mean).rightCols(3);
  const Eigen::Index before = rows_.root_m.rows();
  const bool seen_before = before > 0 && (track.confidence.topRows(before).array() > 0).any();
  if (!seen_before && (before == 0 || (track.confidence.array() > 0).any())) {
    try {
      rows_.root_m = placed_root(velocity_m_s);
    } catch (const InputError&) {  // not enough of a body
      if (before == 0) throw;
    }
  }
  extend_with_last_row(rows_.root_m, rows_.frames(), 3);
  for (Eigen::Index t = std::max<Eigen::Index>(1, before); t < rows_.frames() && seen_before; ++t)
    rows_.root_m.row(t) = rows_.root_m.row(t - 1) + velocity_m_s.row(t) / modalities_.fps;
}

/// The prior's mean motion, its roots placed by the track.
Motion SlidingFit::prior_motion(const ClipRows& rows) const {
  const MatrixD root = ((rows.root_m * units_per_m_).rowwise() - assumed_.translation.transpose()) *
                       assumed_.camera_from_world;
  return decoded(rows.mean, skeleton_, assumed_, root);
}

/// @param answer the rows' prior_motion
ClipEvidence SlidingFit::evidence_of(const ClipRows& rows, const Motion& answer) const {
  const PoseFeatures& features = modalities_.pose_features;
  const MatrixD travelled_m =
      travelled_way(features.root_features(rows.mean).rightCols(3), modalities_.fps);
  ClipEvidence evidence(features, answer, units_per_m_ * travelled_m * assumed_.camera_from_world,
                        track_rays(names_, rows.track, assumed_), assumed_);
  evidence.set_unknowns(rows.prior, modalities_, body_unknown_, unknown_camera_, settings_);
  evidence.clip.mean_lean = rows.mean_lean;
  return evidence;
}

/// @param evidence of an unknown camera, else it stays as it is
void SlidingFit::expect_balance(ClipEvidence& evidence) const {
  if (evidence.clip.camera) evidence.clip.camera->balanced = evidence.balanced(stance(), settings_);
}

void SlidingFit::solve(const PosePrior& prior, const Track2d& track, double track_noise_px) {
  take_prior(prior);
  rows_.track = track;
  place_root();
  problem_.reset();
  evidence_ = std::make_unique<ClipEvidence>(evidence_of(rows_, prior_motion(rows_)));
  PosteriorClip& clip = evidence_->clip;
  if (point_.log_lengths.size() == 0) point_ = PosteriorPoint::zero(clip);
  extend_with_last_row(point_.turns, clip.frames(), point_.turns.cols());
  point_.shift = MatrixD::Zero(clip.frames(), 3);
  set_solution(point_);
  evidence_->find_planted(motion_);
  expect_balance(*evidence_);
  // From the solution before it would not leave a local minimum that few frames had led into.
  point_.turns.setZero();
  if (!past_) point_.ground_m = evidence_->ground(point_);
  clip.past = past_;
  SeenNoise noise(track_noise_px, assumed_, evidence_->usual_depth_m(), may_be_exact_, settings_,
                  lasting_noise_);
  rays_ = noise.rays();

  problem_ = std::make_unique<WindowProblem>(clip, rays_, settings_, point_, 0, clip.frames(),
                                             Unknowns::tracked);
  problem_->solve(!past_, kSmallGain, past_ ? kIterations : WindowProblem::kMostIterations);
  point_ = problem_->solution();
  rows_.root_m = clip.root + point_.shift;
  const bool other_noise = update_noise(noise);
  set_solution(point_);
  fade();
  if (other_noise) begin_fade();
  shown_ = project_motion(motion_, camera_);
}

/// The evidence of these rows, as a whole clip's fit begins with it.
ClipEvidence SlidingFit::evidence_of_past(const ClipRows& rows) const {
  const Motion answer = prior_motion(rows);
  ClipEvidence evidence = evidence_of(rows, answer);
  evidence.find_planted(answer);
  expect_balance(evidence);
  return evidence;
}

/// @return the prior's mean, with what all frames share as it is known by now
PosteriorPoint SlidingFit::start_of(const ClipEvidence& evidence) const {
  PosteriorPoint point = PosteriorPoint::zero(evidence.clip);
  point.take_shared(point_);
  return point;
}

/// Finds body, ground and camera in the last seconds, by a whole clip's rough solution, while other
/// frames come.
void SlidingFit::start_past_solution() {
  ClipRows rows = past_rows_;
  rows.append(rows_);
  auto evidence = std::make_shared<const ClipEvidence>(evidence_of_past(rows));
  PosteriorPoint point = start_of(*evidence);
  point.ground_m = evidence->ground(point);
  RayNoise rays = rays_;
  rays.steady = false;
  past_solution_ = std::async(std::launch::async, [=, settings = settings_] {
    // Who takes the result decides where to stop.
    const InterruptionDeferred until_the_end;
    return coarse_solution(evidence->clip, rays, settings, point);
  });
}

/// Waits for start_past_solution's result. The held frames' prior is computed anew from those
/// before them, with that body.
void SlidingFit::finish_past_solution() {
  if (!past_solution_.valid()) return;
  point_.take_shared(past_solution_.get());
  const Eigen::Index before = std::min(kBeforeHeld, past_rows_.frames());
  ClipRows rows = past_rows_;
  rows.drop_first(rows.frames() - before);
  rows.append(rows_);
  const ClipEvidence evidence = evidence_of_past(rows);
  WindowProblem window(evidence.clip, rays_, settings_, start_of(evidence), 0, rows.frames(),
                       Unknowns::tracked);
  window.solve(false, kSmallGain);
  past_ = window.without_first(before);
  begin_fade();
}

void SlidingFit::begin_fade() {
  fading_ = motion_.channels.bottomRows(motion_.frames() - held_);
  fading_frames_ = fading_.rows();
}

/// Frames that were open when a past solution was taken, or other noise was learned, turn from what
/// they were then to what they are now, the sooner they settle the less, so that what settles does
/// not jump.
void SlidingFit::fade() {
  const Eigen::Index rest = fading_.rows();
  for (Eigen::Index i = 0; i < rest; ++i) {
    const double part = static_cast<double>(fading_frames_ - rest + i + 1) /
                        static_cast<double>(fading_frames_ + 1);
    auto now = motion_.channels.row(held_ + i);
    now = interpolated_pose(motion_.skeleton, fading_.row(i), now, part, now);
  }
}

/// Learns the lasting noise from the residuals of the held frames, at most most_solutions − 1
/// times, as in a whole clip. Open frames are left out: with few or none behind them, they come
/// nearer to the rays than those of a whole clip.
/// @return whether the next solution is given other noise
bool SlidingFit::update_noise(SeenNoise& noise) {
  if (!past_ || learned_ + 1 >= settings_.most_solutions) return false;
  if (const double residual = evidence_->usual_residual(point_, held_); residual > 0)
    residuals_.push_back(residual);
  if (std::ssize(residuals_) < std::lround(kLearned_s * modalities_.fps)) return false;
  learned_ =
      noise.learn(upper_median(std::move(residuals_))) ? learned_ + 1 : settings_.most_solutions;
  lasting_noise_ = noise.share();
  residuals_.clear();
  return true;
}

void SlidingFit::set_solution(const PosteriorPoint& point) {
  auto [body, scale] = evidence_->body(point);
  body_ = std::move(body);
  if (!camera_known_)
    set_camera(point, scale * units_per_m_ *
                          (evidence_->clip.root.row(0) + point.shift.row(0)).transpose());
  motion_ = decoded(evidence_->turned(rows_.mean, point), body_, camera_,
                    evidence_->root(point, scale, camera_));
}

/// The world turns about the place where the first frame showed the root, which stays.
void SlidingFit::set_camera(const PosteriorPoint& point, const Eigen::Vector3d& first_root) {
  camera_lean_ = point.lean;
  camera_ = fitted_camera(point, assumed_);
  if (settled_ == 0) {
    first_root_ = first_root;
    first_height_ = evidence_->first_height(point).value_or(
        units_per_m_ * modalities_.pose_features.root_features(rows_.mean).col(0).mean());
  }
  camera_.translation = first_root_ - first_height_ * camera_.camera_from_world.col(1);
}

/// From the feet to the body's middle, the mean of all frames so far.
Stance SlidingFit::stance() const {
  return mean_stance(settled_stance_, static_cast<double>(settled_),
                     stance_in_camera(motion_, camera_),
                     static_cast<double>(motion_.frames() - held_));
}

Eigen::Index SlidingFit::settle(Eigen::Index frames) {
  settled_stance_ = mean_stance(settled_stance_, static_cast<double>(settled_),
                                stance_in_camera(motion_, camera_), static_cast<double>(frames));
  settled_ += frames;
  held_ += frames;
  drop_rows(fading_, frames);
  const Eigen::Index dropped = std::max<Eigen::Index>(0, held_ - kHeld);
  if (dropped == 0) return 0;
  past_ = problem_->without_first(dropped);
  held_ -= dropped;
  past_rows_.append(rows_.first(dropped));
  rows_.drop_first(dropped);
  for (MatrixD* rows :
       {&point_.turns, &motion_.channels, &shown_.x_px, &shown_.y_px, &shown_.confidence})
    drop_rows(*rows, dropped);
  const bool ended = motion_.frames() == held_;
  if (ended || settled_ < next_past_solution_) return dropped;
  const Eigen::Index kept = std::lround(kPastSolution_s * modalities_.fps);
  past_rows_.drop_first(std::max<Eigen::Index>(0, past_rows_.frames() - kept));
  finish_past_solution();
  start_past_solution();
  if (static_cast<double>(past_rows_.frames()) <= kWaitedFor_s * modalities_.fps)
    finish_past_solution();
  const long long most = std::lround(kPastSolutionEvery_s * modalities_.fps);
  next_past_solution_ =
      settled_ + std::clamp(settled_ / 2, kPastSolutionAfter, std::max(kPastSolutionAfter, most));
  return dropped;
}

}  // namespace mcdbn
