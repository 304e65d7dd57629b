#include "mcdbn/motion_model/clip_regeneration.hpp"

#include <algorithm>

#include "camera/track_resample.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion/joint_uncertainty.hpp"
#include "motion/resample.hpp"
#include "motion/retarget.hpp"
#include "motion_model/pose_priors.hpp"

namespace mcdbn {
namespace {

Motion with_frames(Motion motion, Eigen::Index frames) {
  const Eigen::Index have = motion.channels.rows();
  MatrixD channels(frames, motion.channels.cols());
  for (Eigen::Index t = 0; t < frames; ++t)
    channels.row(t) = motion.channels.row(std::min(t, have - 1));
  motion.channels = std::move(channels);
  return motion;
}

/// A skeleton that is wanted and has other joints than the model: the model's own is regenerated
/// with its limbs, the humanoid with all its bones, and the motion put on it by roles.
class OtherSkeleton {
 public:
  OtherSkeleton(const Skeleton& own, const ClipPlacement& wanted) : own_(own) {
    if (!wanted.skeleton || has_joints_of(own, *wanted.skeleton)) return;
    roles_ = skeleton_roles(own);
    target_.emplace(Motion{*wanted.skeleton, 1.0, wanted.skeleton_channels},
                    skeleton_roles(*wanted.skeleton, wanted.joint_map));
  }

  ClipPlacement placement(ClipPlacement wanted) const {
    if (!target_) return wanted;
    wanted.skeleton = is_humanoid(own_)
                          ? target_->body()
                          : with_limbs_of(own_, roles_, target_->skeleton(), target_->roles());
    wanted.joint_map.clear();  // it was the other's
    return wanted;
  }

  Motion moved(const Motion& motion) const {
    return target_ ? retargeted(motion, roles_, *target_) : motion;
  }

 private:
  static bool has_joints_of(const Skeleton& own, const Skeleton& other) {
    return std::ranges::all_of(own.joints,
                               [&](const Joint& joint) { return other.find(joint.name) >= 0; });
  }

  const Skeleton& own_;
  std::optional<HumanoidRig> target_;
  SkeletonRoles roles_;
};

}  // namespace

std::vector<Motion> regenerate_clip(const Modalities& modalities, const Track2d& track,
                                    const ClipPlacement& wanted, const PoseAnswer& single,
                                    const PoseAnswers& all, TrackFindings* findings) {
  const OtherSkeleton other(modalities.pose_features.skeleton(), wanted);
  ClipPlacement placement = other.placement(wanted);
  Track2d sides = track;
  std::vector<SideSwap> swaps;
  placement.detected = !joined_by_name(track, modalities.track_features);
  if (placement.detected) {
    swaps = find_side_swaps(track);
    exchange_sides(sides, swaps);
  }
  SeenClip seen = see_clip(modalities, resample_track(sides, modalities.fps), placement, single);
  placement.found = seen.view;
  const auto as_track = [&](const Motion& motion) {
    return other.moved(with_frames(resample(motion, track.fps), track.frames()));
  };
  std::vector<Motion> motions;
  Camera camera;
  MatrixD uncertainty;
  for (const PosePrior& prior : all(seen.features)) {
    const bool first = motions.empty();
    FittedClip clip = fit_to_track(prior, modalities, seen.joints, placement, placement.fit,
                                   first ? placement.uncertainty_draws : PosteriorDraws{});
    motions.push_back(as_track(clip.motion));
    if (!first) continue;
    camera = clip.camera;
    if (clip.draws.empty()) continue;
    for (Motion& draw : clip.draws) draw = as_track(draw);
    uncertainty = joint_uncertainty(motions.front(), clip.draws);
  }
  if (findings)
    *findings = {std::move(seen.filled), std::move(swaps), std::move(camera),
                 std::move(uncertainty)};
  return motions;
}

std::vector<Motion> regenerate_clip(const Model& model, const Track2d& track,
                                    const ClipPlacement& placement,
                                    const RegenerationOptions& options, TrackFindings* findings) {
  return regenerate_clip(
      model.modalities, track, placement,
      [&](const MatrixF& features) { return pose_prior(model.network, features); },
      [&](const MatrixF& features) { return pose_priors(model.network, {features}, options); },
      findings);
}

std::vector<Track2d> regenerate_track(const Model& model, const Motion& clip,
                                      const RegenerationOptions& options,
                                      const std::optional<Camera>& camera) {
  const Modalities& modalities = model.modalities;
  const Motion taken = for_skeleton(clip, modalities.pose_features.skeleton());
  const Camera seen_by = camera.value_or(camera_at_origin(modalities.camera));
  const MatrixF pose =
      modalities.encode_pose(resample(taken, modalities.fps), seen_by.camera_from_world);
  std::vector<std::vector<MatrixF>> present(model.network.modality_count());
  present[kPose] = {pose};
  std::vector<Track2d> tracks;
  for (const MatrixF& track : regenerate(model.network, present, kTrack, options))
    tracks.push_back(modalities.decode_track(track, seen_by));
  return tracks;
}

}  // namespace mcdbn
