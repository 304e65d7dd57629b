#pragma once

#include "camera/track_rays.hpp"
#include "fitting/clip_posterior.hpp"
#include "mcdbn/features/pose_features.hpp"

namespace mcdbn {

/// A network's answer and the track that it is fitted to, as the posterior takes them.
class ClipEvidence {
 public:
  /// @param answer the prior's mean, where the camera sees it  @param travelled [frames x 3] world
  ///        axes, file units: the prior's velocity, summed up
  /// @param track of the answer's joints; those that it lacks are left out
  ClipEvidence(const PoseFeatures& features, const Motion& answer, const MatrixD& travelled,
               const TrackRays& track, const Camera& camera);

  PosteriorClip clip;  ///< deviations and planted feet still to be set

  /// Which feet stand in a motion of the same skeleton's joints, into `clip`: by how low and slow
  /// they are (kPlantedInAnswer), the ground being the lowest foot of the frame.
  void find_planted(const Motion& motion);

  /// How high the ground is under each kind of foot joint: the middle height of those that stand;
  /// as before where none does. @return as PosteriorPoint::ground_m
  Eigen::VectorXd ground(const PosteriorPoint& point) const;
  /// How the camera stands if the body's middle is, on average, straight above the feet.
  /// Who moves fast leans, and that is less certain.
  /// @param upright from feet to middle, camera axes, any length
  ExpectedLean balanced(const Eigen::Vector3d& upright, const TrackFitSettings& settings) const;

  /// The answer's features, turned. @return [frames x dimension] along the camera's axes
  MatrixD turned(MatrixD features, const PosteriorPoint& point) const;
  /// Its root. @param scale of distances from the camera  @param camera that sees it
  /// @return [frames x 3] world, file units
  MatrixD root(const PosteriorPoint& point, double scale, const Camera& camera) const;
  /// Its body. @return the answer's skeleton, bones as long as the point has them
  Skeleton body(const PosteriorPoint& point) const;

  /// How far from the rays the joints of the first frames are: 1.4826 times the median residual,
  /// x/z and y/z, times the root of its confidence; 0 where nothing is seen.
  double usual_residual(const PosteriorPoint& point, Eigen::Index frames) const;
  /// The root's usual distance from the camera, m on a 1.7 m body.
  double usual_depth_m() const;
  /// How far the root usually comes in a second, or in the whole clip.
  double usual_speed_m_s() const;

 private:
  Skeleton skeleton_;
  double units_per_m_;
  std::vector<int> feet_;        ///< joints of the skeleton, as clip.feet
  std::vector<int> turn_above_;  ///< by joint of the skeleton, what turns its bone, or −1
};

}  // namespace mcdbn
