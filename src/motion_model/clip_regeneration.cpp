#include "mcdbn/motion_model/clip_regeneration.hpp"

#include <algorithm>
#include <cmath>

#include "camera/track_resample.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion/joint_uncertainty.hpp"
#include "motion/resample.hpp"
#include "motion/retarget.hpp"
#include "motion_model/pose_priors.hpp"
#include "motion_model/recent_track.hpp"

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

/// Frames of a clip as they were regenerated, once for each answer.
struct Stretch {
  FrameRange range;
  std::vector<FittedClip> clips;
  TrackFeatures::FillCount filled;
  std::vector<SideSwap> swaps;
};

/// The longest stretch tells of which body and camera the others are, if nobody says it.
class StretchRegeneration {
 public:
  StretchRegeneration(const Modalities& modalities, const Track2d& track,
                      const ClipPlacement& placement, const PoseAnswer& single,
                      const PoseAnswers& all)
      : modalities_(modalities), track_(track), placement_(placement), single_(single), all_(all) {
    placement_.detected = !joined_by_name(track, modalities.track_features);
  }

  std::vector<Stretch> regenerated(const std::vector<FrameRange>& ranges) const {
    std::vector<Stretch> stretches(ranges.size());
    const auto longest = static_cast<std::size_t>(
        std::ranges::max_element(ranges, {}, &FrameRange::frames) - ranges.begin());
    stretches[longest] = regenerated(ranges[longest], nullptr);
    for (std::size_t i = 0; i < ranges.size(); ++i)
      if (i != longest) stretches[i] = regenerated(ranges[i], &stretches[longest]);
    return stretches;
  }

 private:
  Stretch regenerated(const FrameRange& range, const Stretch* told) const {
    Stretch stretch{range, {}, {}, {}};
    Track2d track = some_frames(track_, range.first, range.frames);
    if (placement_.detected) {
      stretch.swaps = find_side_swaps(track);
      exchange_sides(track, stretch.swaps);
    }
    SeenClip seen = see_clip(modalities_, resample_track(track, modalities_.fps),
                             placement_of(0, told), single_);
    for (SideSwap& swap : seen.swaps) {
      for (int* frame : {&swap.first_frame, &swap.last_frame})
        *frame = std::min(range.frames - 1,
                          static_cast<int>(std::lround(*frame * track.fps / modalities_.fps)));
      stretch.swaps.push_back(std::move(swap));
    }
    for (SideSwap& swap : stretch.swaps) {
      swap.first_frame += range.first;
      swap.last_frame += range.first;
    }
    stretch.filled = std::move(seen.filled);
    for (const PosePrior& prior : all_(seen.features)) {
      const std::size_t answer = stretch.clips.size();
      ClipPlacement placement = placement_of(answer, told);
      placement.found = seen.view;
      stretch.clips.push_back(
          fit_to_track(prior, modalities_, seen.joints, placement, placement.fit,
                       answer == 0 ? placement.uncertainty_draws : PosteriorDraws{}));
    }
    return stretch;
  }

  ClipPlacement placement_of(std::size_t answer, const Stretch* told) const {
    ClipPlacement placement = placement_;
    if (told == nullptr) return placement;
    const FittedClip& clip = told->clips[answer];
    placement.camera = clip.camera;
    if (!placement.skeleton) placement.detected = true;  // a body that was found is not exact
    placement.skeleton = clip.motion.skeleton;
    return placement;
  }

  const Modalities& modalities_;
  const Track2d& track_;
  ClipPlacement placement_;
  const PoseAnswer& single_;
  const PoseAnswers& all_;
};

/// Of all stretches together.
TrackFeatures::FillCount filled_in(const std::vector<Stretch>& stretches) {
  TrackFeatures::FillCount all{0, 0, stretches.front().filled.unseen};
  const auto unseen_in = [](const Stretch& stretch, const std::string& joint) {
    return std::ranges::find(stretch.filled.unseen, joint) != stretch.filled.unseen.end();
  };
  for (const Stretch& stretch : stretches) {
    all.interpolated += stretch.filled.interpolated;
    all.missing += stretch.filled.missing;
    std::erase_if(all.unseen, [&](const auto& joint) { return !unseen_in(stretch, joint); });
  }
  for (const Stretch& stretch : stretches)
    all.missing +=
        stretch.range.frames * static_cast<int>(stretch.filled.unseen.size() - all.unseen.size());
  return all;
}

MatrixD stacked(MatrixD above, const MatrixD& below) {
  if (above.rows() == 0) return below;
  const Eigen::Index rows = above.rows();
  above.conservativeResize(rows + below.rows(), Eigen::NoChange);
  above.bottomRows(below.rows()) = below;
  return above;
}

}  // namespace

std::vector<Motion> regenerate_clip(const Modalities& modalities, const Track2d& track,
                                    const ClipPlacement& wanted, const PoseAnswer& single,
                                    const PoseAnswers& all, TrackFindings* findings) {
  const OtherSkeleton other(modalities.pose_features.skeleton(), wanted);
  TrackStretches found = find_stretches(track);
  Track2d steady = track;
  leave_out(steady, found.strays);
  const StretchRegeneration regeneration(modalities, steady, other.placement(wanted), single, all);
  const std::vector<Stretch> stretches = regeneration.regenerated(found.stretches);
  std::vector<Motion> motions;
  MatrixD uncertainty;
  for (const Stretch& stretch : stretches) {
    const auto as_track = [&](const Motion& motion) {
      return other.moved(with_frames(resample(motion, track.fps), stretch.range.frames));
    };
    for (std::size_t i = 0; i < stretch.clips.size(); ++i) {
      Motion motion = as_track(stretch.clips[i].motion);
      if (i == 0 && !stretch.clips[i].draws.empty()) {
        std::vector<Motion> draws;
        for (const Motion& draw : stretch.clips[i].draws) draws.push_back(as_track(draw));
        uncertainty = stacked(std::move(uncertainty), joint_uncertainty(motion, draws));
      }
      if (i < motions.size())
        motions[i].channels = stacked(std::move(motions[i].channels), motion.channels);
      else
        motions.push_back(std::move(motion));
    }
  }
  if (!findings) return motions;
  *findings = {filled_in(stretches),
               {},
               stretches.front().clips.front().camera,
               std::move(uncertainty),
               std::move(found)};
  for (const Stretch& stretch : stretches)
    findings->swaps.insert(findings->swaps.end(), stretch.swaps.begin(), stretch.swaps.end());
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
