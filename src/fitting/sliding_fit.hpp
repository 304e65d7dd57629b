#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fitting/clip_evidence.hpp"
#include "fitting/clip_rows.hpp"
#include "fitting/seen_noise.hpp"
#include "fitting/window_problem.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/fitting/known_of_clip.hpp"
#include "mcdbn/fitting/pose_prior.hpp"
#include "mcdbn/fitting/track_fit_settings.hpp"

namespace mcdbn {

/// The fit of a clip that is still growing: fit_to_track's problem for its last frames, solved anew
/// with every frame, from the prior's mean. Its newest frames are open; of those before, which have
/// settled, the last are held: they are solved, too, but not given out again. The information that
/// still earlier frames carry on these is kept as a normal distribution (MarginalPrior).
/// Body, ground and camera are found by looking back: the last seconds are solved again as
/// fit_to_track first solves a clip, beside the frames that come, on a thread of its own. When the
/// result is taken depends on frame numbers alone.
class SlidingFit {
 public:
  /// Settled frames that the problem holds at most. They are at least those that a dropped frame
  /// has terms in common with.
  static constexpr Eigen::Index kHeld = 4;

  /// @param modalities has to outlive this  @param known as for fit_to_track
  /// @param like a track of the same image
  SlidingFit(const Modalities& modalities, const KnownOfClip& known, const Track2d& like,
             const TrackFitSettings& settings);

  /// Some steps towards the likeliest motion of the held and the open frames.
  /// @param prior of the open frames, as fit_to_track takes it, seen by camera()
  /// @param track of the held and the open frames: those of the solution before that were not
  ///        dropped, and new ones behind them  @param track_noise_px new in every frame
  /// @throws InputError if no person is seen well enough to be placed, until one was
  void solve(const PosePrior& prior, const Track2d& track, double track_noise_px);

  /// The first of the open frames settle.
  /// @return how many frames are not held any more: the next solution is not of them
  Eigen::Index settle(Eigen::Index frames);
  /// Frames of the last solution that are settled and held.
  Eigen::Index held() const { return held_; }
  /// Motion of the last solution: held and open frames, on the body as it is estimated by now.
  const Motion& motion() const { return motion_; }
  /// Its joints as the camera sees them.
  const Track2d& shown() const { return shown_; }
  /// In the skeleton's file units. An unknown one is as found by now, above the first frame's root.
  const Camera& camera() const { return camera_; }
  const Skeleton& body() const { return body_; }

 private:
  Motion decoded(const MatrixD& features, const Skeleton& skeleton, const Camera& camera,
                 const MatrixD& root) const;
  void take_prior(const PosePrior& prior);
  Motion prior_motion(const ClipRows& rows) const;
  void expect_balance(ClipEvidence& evidence) const;
  ClipEvidence evidence_of(const ClipRows& rows, const Motion& answer) const;
  void place_root();
  MatrixD placed_root(const MatrixD& velocity_m_s) const;
  bool update_noise(SeenNoise& noise);
  void set_solution(const PosteriorPoint& point);
  ClipEvidence evidence_of_past(const ClipRows& rows) const;
  PosteriorPoint start_of(const ClipEvidence& evidence) const;
  void start_past_solution();
  void finish_past_solution();
  void begin_fade();
  void fade();
  void set_camera(const PosteriorPoint& point, const Eigen::Vector3d& first_root);
  Stance stance() const;

  const Modalities& modalities_;
  TrackFitSettings settings_;
  Skeleton skeleton_, body_;  ///< as it was given, and as it is estimated
  bool body_unknown_, may_be_exact_, camera_known_;
  double units_per_m_;
  Camera assumed_, camera_;               ///< at first, and as it was found
  Eigen::Vector3d camera_lean_{0, 0, 0};  ///< of camera_; PosteriorPoint::lean may have gone on
  std::optional<UnknownCamera> unknown_camera_;
  std::vector<std::string> names_;
  double lasting_noise_ = 1;       ///< as a share of a usual detector's
  std::size_t learned_ = 0;        ///< how often it was estimated
  std::vector<double> residuals_;  ///< what solutions since left
  // Frames of the last solution, held and open:
  Eigen::Index held_ = 0;
  ClipRows rows_;
  RayNoise rays_;
  PosteriorPoint point_;
  std::unique_ptr<ClipEvidence> evidence_;
  std::unique_ptr<WindowProblem> problem_;
  // Frames before these:
  std::optional<MarginalPrior> past_;
  ClipRows past_rows_;                         ///< of the last seconds
  long long next_past_solution_ = 0;           ///< when so many frames have settled
  std::future<PosteriorPoint> past_solution_;  ///< only what all frames share is taken from it
  MatrixD fading_;  ///< channels of frames that were open when it began, as they were
  Eigen::Index fading_frames_ = 0;  ///< as many as they were
  // All frames that have settled:
  Stance settled_stance_;
  long long settled_ = 0;
  Eigen::Vector3d first_root_{0, 0, 0};
  double first_height_ = 0;  ///< of that root above the ground
  Motion motion_;
  Track2d shown_;
};

}  // namespace mcdbn
