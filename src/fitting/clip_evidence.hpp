#pragma once

#include <optional>
#include <vector>

#include "camera/track_rays.hpp"
#include "fitting/clip_posterior.hpp"
#include "fitting/stance.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/fitting/pose_prior.hpp"

namespace mcdbn {

/// The assumed camera with the point's lean and focal length. Its place stays.
Camera fitted_camera(const PosteriorPoint& point, Camera assumed);

/// A body of 1.7 m, as the camera's metres are meant. A single camera does not determine the scale:
/// with distances from the camera multiplied by `scale` the body looks as the point has it.
struct FittedBody {
  Skeleton skeleton;
  double scale = 1;
};

/// A network's answer and the track that it is fitted to, as the posterior takes them.
class ClipEvidence {
 public:
  /// @param answer the prior's mean, where the camera sees it  @param travelled [frames x 3] world
  ///        axes, file units: the prior's velocity, summed up
  /// @param track of the answer's joints; those that it lacks are left out
  ClipEvidence(const PoseFeatures& features, const Motion& answer, const MatrixD& travelled,
               const TrackRays& track, const Camera& camera);

  PosteriorClip clip;  ///< unknowns and planted feet still to be set

  /// How far the prior may be off, and what is not known besides, into `clip`.
  void set_unknowns(const PosePrior& prior, const Modalities& modalities, bool body_unknown,
                    const std::optional<UnknownCamera>& camera, const TrackFitSettings& settings);
  /// Which feet stand in a motion of the same skeleton's joints, into `clip`: by how low and slow
  /// they are (kPlantedInAnswer), the ground being the lowest foot of the frame.
  void find_planted(const Motion& motion);

  /// How high the ground is under each kind of foot joint: the middle height of those that stand;
  /// as before where none does. @return as PosteriorPoint::ground_m
  Eigen::VectorXd ground(const PosteriorPoint& point) const;
  /// How high the first frame's root is above the ground that ankles stand on, in file units of
  /// body(point): where they stand, ankles are 0.039 of stature high (Drillis and Contini). Unset
  /// where none stands.
  std::optional<double> first_height(const PosteriorPoint& point) const;
  /// How the camera stands if the body's middle is, on average, straight above the feet.
  /// This is less certain where the person moves fast, and so leans, and where they sit or squat.
  ExpectedLean balanced(const Stance& stance, const TrackFitSettings& settings) const;

  /// The answer's features, turned. @return [frames x dimension] along the camera's axes
  MatrixD turned(MatrixD features, const PosteriorPoint& point) const;
  /// Its root. @param scale of distances from the camera  @param camera that sees it
  /// @return [frames x 3] world, file units
  MatrixD root(const PosteriorPoint& point, double scale, const Camera& camera) const;
  /// Its body: the answer's skeleton, with the proportions that the point has.
  FittedBody body(const PosteriorPoint& point) const;

  /// How far from the rays the joints of the first frames are: 1.4826 times the median residual,
  /// x/z and y/z, times the root of its confidence; 0 where nothing is seen.
  double usual_residual(const PosteriorPoint& point, Eigen::Index frames) const;
  /// The root's usual distance from the camera, m on a 1.7 m body.
  double usual_depth_m() const;
  /// How far the root usually comes in a second, or in the whole clip.
  double usual_speed_m_s() const;

 private:
  /// The middle height of those of some of clip.feet that stand, metres above the camera; unset
  /// where none does.
  std::optional<double> standing_height(const PosteriorPoint& point,
                                        const std::vector<std::size_t>& feet) const;
  bool is_ankle(std::size_t foot) const;

  Skeleton skeleton_;
  double units_per_m_;
  std::vector<int> feet_;        ///< joints of the skeleton, as clip.feet
  std::vector<int> turn_above_;  ///< by joint of the skeleton, what turns its bone, or −1
};

}  // namespace mcdbn
