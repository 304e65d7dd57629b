#pragma once

#include <string>
#include <vector>

#include "camera/track_rays.hpp"
#include "fitting/clip_posterior.hpp"
#include "mcdbn/fitting/track_fit.hpp"

namespace mcdbn {

/// The fit of a clip that is still growing: fit_to_track's problem for its last frames, solved anew
/// with every frame. The newest frames are open. Of those
/// before, which have settled, the last are held: they are solved with the open ones, so that these
/// go on from them as they would in the whole clip, but nobody asks for them again. Of the body, if
/// it is not known, every frame tells something, and what earlier frames told is kept as a normal
/// distribution.
class SlidingFit {
 public:
  /// Settled frames that the problem holds at most, somewhat longer than a prior's errors last.
  static constexpr Eigen::Index kHeld = 8;

  /// @param modalities has to outlive this  @param camera that sees the track, of any unit
  SlidingFit(const Modalities& modalities, const std::optional<Skeleton>& skeleton,
             const Camera& camera, const TrackFitSettings& settings);

  /// Some steps towards the likeliest motion of the held and the open frames.
  /// @param prior, track of these frames, as fit_to_track takes them: those of the solution before
  ///        that are not dropped, and new ones behind them
  /// @param track_noise_px new in every frame (track_noise_px)
  /// @throws InputError if nobody is seen well enough to be placed, until somebody was
  void solve(const PosePrior& prior, const Track2d& track, double track_noise_px);

  /// The first of the open frames are not asked for any more.
  /// @return how many frames are not held any more: the next solution is not of them
  Eigen::Index settle(Eigen::Index frames);
  /// Frames of the last solution that are settled and held.
  Eigen::Index held() const { return held_; }
  /// Of the last solution: held and open frames, on the body as it is told now.
  const Motion& motion() const { return motion_; }
  /// Its joints as the camera sees them.
  const Track2d& shown() const { return shown_; }
  const Camera& camera() const { return camera_; }  ///< in the skeleton's file units
  const Skeleton& body() const { return body_; }
  /// The same is seen by another camera: the world turns and moves, frames stay where the camera
  /// has them. @param camera in the skeleton's file units
  void set_camera(const Camera& camera);

 private:
  MatrixD world_path(const MatrixD& root_m) const;
  MatrixD camera_path(const MatrixD& world) const;
  Motion decoded(const MatrixD& features, const Skeleton& skeleton) const;
  void start(const MatrixD& mean, const TrackRays& rays, const MatrixD& velocity_m_s,
             double velocity_error_m_s2);
  void tell_of_body(const PosteriorClip& clip, const RayNoise& noise, const PosteriorPoint& point);

  const Modalities& modalities_;
  TrackFitSettings settings_;
  Skeleton skeleton_, body_;  ///< as it was given, and as it is told
  bool body_unknown_;
  double units_per_m_;
  Camera camera_;
  std::vector<std::string> names_;
  Eigen::Index held_ = 0;
  MatrixD root_m_;  ///< [frames x 3] camera axes, metres of a 1.7 m body
  ToldBody told_;
  Eigen::VectorXd log_lengths_;
  Eigen::Index untold_ = 0;  ///< frames that have settled since the body was told last
  double log_residual_ = 0;  ///< what solutions leave, the mean of its logarithm
  int residuals_ = 0;
  MatrixD features_;  ///< along the camera's axes, of the last solution
  Motion motion_;
  Track2d shown_;
};

}  // namespace mcdbn
