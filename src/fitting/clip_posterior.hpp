#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "fitting/clip_windows.hpp"
#include "fitting/lever.hpp"
#include "fitting/marginal_prior.hpp"
#include "fitting/unknown_camera.hpp"
#include "mcdbn/base/matrices.hpp"
#include "mcdbn/fitting/track_fit_settings.hpp"

namespace mcdbn {

/// One joint as one frame saw it, along `ray` (x/z and y/z).
struct SeenJoint {
  std::vector<Lever> levers;  ///< root to joint, as the prior's mean has them
  Eigen::Vector2d ray{0, 0};
  double confidence = 0;  ///< the ray's variance is the track's over this; 0: not seen
};

/// Thighs and shanks, upper arms and forearms, and others.
enum class BoneKind { leg, arm, other };

/// The prior of a clip's motion, and its track. Metres of a 1.7 m body, camera axes.
struct PosteriorClip {
  std::vector<int> parents;                  ///< by orientation, an earlier one, or −1
  std::vector<int> lengths;                  ///< by orientation, which length its bones have
  std::vector<BoneKind> length_kinds;        ///< by length, what it is of; none: all of others
  MatrixD turn_deviation_rad;                ///< [frames x orientations] about each axis
  double root_m_s2 = 1;                      ///< deviation of the acceleration of the root's
                                             ///< difference from `travelled`
  MatrixD root;                              ///< [frames x 3] where it is at first
  MatrixD travelled;                         ///< [frames x 3] the prior's velocity, summed up
  std::vector<std::vector<SeenJoint>> seen;  ///< by frame and joint
  std::vector<std::size_t> feet;             ///< indices among the joints
  MatrixD planted;               ///< [frames x feet] confidence that each stands, 0…1, from
                                 ///< the frame before
  std::vector<int> grounds;      ///< by foot, which height it stands at: left and right the same
  Eigen::Vector3d up{0, -1, 0};  ///< against gravity, as the camera is assumed to stand
  std::optional<UnknownCamera> camera;  ///< unset: known
  MatrixD mean_lean;  ///< [frames x 3] how the camera leaned that the prior's mean was seen by;
                      ///< 0 x 0: as assumed
  std::optional<MarginalPrior> past;  ///< of frames before the first
  bool body_unknown = false;
  double frame_time_s = 1;

  Eigen::Index frames() const { return root.rows(); }
};

/// Deviation of a ray's error, x/z and y/z each.
struct RayNoise {
  double white = 0;       ///< of the part that is new in every frame
  double lasting = 0;     ///< of the part that lasts for about detector_noise_time
  bool exact = false;     ///< there is next to none compared with a usual detector's
  bool measured = false;  ///< there is some, and it is no detector's: all of it is estimated from
                          ///< the track and a solution
  bool steady = false;    ///< next to none of it is new in every frame, and it is no detector's
};

/// A motion as it differs from the prior's mean.
struct PosteriorPoint {
  MatrixD turns;                  ///< [frames x 3·orientations] radians, camera axes
  MatrixD shift;                  ///< [frames x 3] of the root
  Eigen::VectorXd log_lengths;    ///< by length, the body's over the skeleton's
  Eigen::VectorXd ground_m;       ///< heights that feet stand at, above the camera
  Eigen::Vector3d lean{0, 0, 0};  ///< turn of the world otherwise than the camera is assumed to
                                  ///< stand, radians, camera axes: about level_right and z
  double log_focal = 0;           ///< the camera's focal length over the assumed one
  double energy = 0;              ///< −log of how likely the solution is, but for a constant

  static PosteriorPoint zero(const PosteriorClip& clip);
  /// Body, ground and camera become the other's.
  void take_shared(const PosteriorPoint& other);
};

/// The gain at which a solution of all frames stops.
inline constexpr double kSmallGainOfAll = 2e-3;
/// The gain at which a solution of a detector's track stops. It starts from a rough solution:
/// further steps follow the track's errors as much as the motion. Chosen on 37 clips of training
/// people, tracks like OpenPose's.
inline constexpr double kSmallGainOfDetector = 1e-2;

/// What all frames share: body, ground and camera.
enum class SharedUnknowns {
  to_be_found,  ///< by one of several windows (most_seen), which the others then wait for
  as_found,     ///< a clip of several windows takes them as they stand; a single window finds them
};

/// The window that determines what all frames share: the one in whose frames the most joints are
/// seen; of several, the one nearest to the middle of the clip.
/// @param windows of the clip, one at least  @return which of them
std::size_t most_seen(const PosteriorClip& clip, const std::vector<ClipWindow>& windows);

/// The likeliest motion given prior and track (maximum a posteriori): nonlinear least squares over
/// all frames at once, of the costs in terms/. Long clips are solved in windows that overlap.
/// @param from where to start
/// @param small_gain a step that lowers the energy by less than this share is the last one
PosteriorPoint map_solution(const PosteriorClip& clip, const RayNoise& noise,
                            const TrackFitSettings& settings, PosteriorPoint from,
                            SharedUnknowns shared = SharedUnknowns::to_be_found,
                            double small_gain = kSmallGainOfAll,
                            const WindowSizes& sizes = kAllFrames);

/// The gain at which coarse_solution stops.
inline constexpr double kSmallGainOfCoarse = 1e-2;

/// About map_solution(), from a frame every TrackFitSettings::first_solution_step_s, in a fraction
/// of the time: the motion's difference from the prior's mean changes slowly, and is interpolated
/// between those frames.
PosteriorPoint coarse_solution(const PosteriorClip& clip, const RayNoise& noise,
                               const TrackFitSettings& settings, PosteriorPoint from);

/// Where the joint is. @return camera axes
Eigen::Vector3d place_of(const PosteriorClip& clip, const PosteriorPoint& point, Eigen::Index frame,
                         std::size_t joint);

}  // namespace mcdbn
