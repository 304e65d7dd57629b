#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mcdbn/camera/track.hpp"
#include "mcdbn/machines/regeneration.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "mcdbn/motion_model/seen_clip.hpp"

namespace mcdbn {

/// What was found out about a track on the way.
struct TrackFindings {
  TrackFeatures::FillCount filled;
  std::vector<SideSwap> swaps;  ///< that were put right
  Camera camera;  ///< that sees the first motion as the track shows it, in its file units
  /// How sure the first motion is (joint_uncertainty) [frames x 3·joints], at the track's rate and
  /// in its file units, if `uncertainty_draws` were asked for.
  MatrixD uncertainty;
};

/// 3D motion from a 2D track, `samples` times. The track is brought to the model's rate and the
/// motion back to the track's: as many frames as the track has. A detector's keypoints are put
/// right (find_side_swaps) and mapped to the model's joints (see_clip).
/// @throws InputError if the track shows too little of the model's joints
std::vector<Motion> regenerate_clip(const Model& model, const Track2d& track,
                                    const ClipPlacement& placement,
                                    const RegenerationOptions& options,
                                    TrackFindings* findings = nullptr);

/// Several answers.
using PoseAnswers = std::function<std::vector<PosePrior>(const MatrixF& features)>;

/// The same by any method. @param single says what the track itself does not show
std::vector<Motion> regenerate_clip(const Modalities& modalities, const Track2d& track,
                                    const ClipPlacement& placement, const PoseAnswer& single,
                                    const PoseAnswers& all, TrackFindings* findings = nullptr);

/// The other direction: a 2D track from 3D motion, `samples` times, one frame for each of the clip
/// at the model's rate. Everything in it is the network's answer, the root's place in the image and
/// the body's size too; nothing is fitted or projected.
/// @param clip any skeleton with the model's joint names, at any rate
/// @param camera whose axes the motion is seen along and whose image the pixels are of; unset: the
///        model's own view. Its place is not asked: the network knows one.
/// @return the root first, then the other joints of the model
/// @throws InputError if the clip lacks a joint of the model
std::vector<Track2d> regenerate_track(const Model& model, const Motion& clip,
                                      const RegenerationOptions& options,
                                      const std::optional<Camera>& camera = {});

}  // namespace mcdbn
