#pragma once

#include "fitting/clip_posterior.hpp"
#include "mcdbn/camera/camera.hpp"

namespace mcdbn {

/// The estimated noise of a track's rays. The part that is new in every frame is estimated from the
/// track itself. The part that lasts is at first a usual detector's, then estimated from the
/// residuals of solutions: smaller ones than the noise lets expect show that there is less of it,
/// the smaller, the less. So an exact projection of a known body is recognized in two solutions. A
/// body that is fitted itself comes near to any rays, which carries no information: there the part
/// that lasts only grows, and so it does of a detector's keypoints.
class SeenNoise {
 public:
  /// @param track_noise_px new in every frame, of x and y each
  /// @param depth_m of the person, on a 1.7 m body
  /// @param may_be_exact the body is known, and a detector need not have seen it
  /// @param share of a usual detector's lasting part, as it was estimated before
  SeenNoise(double track_noise_px, const Camera& camera, double depth_m, bool may_be_exact,
            const TrackFitSettings& settings, double share = 1);

  const RayNoise& rays() const { return rays_; }
  /// @param residual how far from the rays a solution's joints are, x/z and y/z each
  /// @return whether that makes another solution worth while
  bool learn(double residual);
  /// Once solutions no longer change the estimate: noise that shows in the track, and is no
  /// detector's, was measured, and less of it is taken as new in each frame
  /// (`TrackFitSettings::measured_noise_factor`).
  /// @return whether that makes another solution worth while
  bool measure();
  /// The lasting part as estimated so far, as a share of a usual detector's.
  double share() const { return rays_.lasting / usual_; }

 private:
  void set_lasting(double lasting);

  bool may_be_exact_;
  double of_track_, usual_, least_;  ///< on the rays: of the track, of detectors, of both parts
  double measured_white_;            ///< on the rays: of the track, once it was measured
  RayNoise rays_;
};

}  // namespace mcdbn
