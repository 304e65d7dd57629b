#include "mcdbn/motion_model/clip_regeneration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera/shown_body.hpp"
#include "camera/track_resample.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion/body_root.hpp"
#include "motion/interpolated_pose.hpp"
#include "motion/joint_uncertainty.hpp"
#include "motion/resample.hpp"
#include "motion/retarget.hpp"
#include "motion_model/pose_priors.hpp"
#include "motion_model/recent_track.hpp"
#include "motion_model/track_parts.hpp"

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

bool has_joints_of(const Skeleton& own, const Skeleton& other) {
  return std::ranges::all_of(own.joints,
                             [&](const Joint& joint) { return other.find(joint.name) >= 0; });
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
  const Skeleton& own_;
  std::optional<HumanoidRig> target_;
  SkeletonRoles roles_;
};

/// A part as it was regenerated, once for each answer, at the track's rate.
struct RegeneratedPart {
  TrackPart part;
  std::vector<Motion> motions;
  std::vector<Skeleton> bodies;  ///< by answer, of the skeleton that is regenerated
  Camera camera;                 ///< that sees all of them
  MatrixD uncertainty;
  TrackFeatures::FillCount filled;
  std::vector<SideSwap> swaps;
  bool placed_by_size = false;
};

/// The body and the camera, where not given, are found in the part that shows a body in the most
/// frames, for all others.
class PartRegeneration {
 public:
  /// @param placement of the skeleton that is regenerated, which `other` moves to the wanted one
  PartRegeneration(const Modalities& modalities, Track2d track, ClipPlacement placement,
                   const OtherSkeleton& other, const PoseAnswer& single, const PoseAnswers& all)
      : modalities_(modalities),
        track_(std::move(track)),
        placement_(std::move(placement)),
        other_(other),
        single_(single),
        all_(all) {
    placement_.detected = !joined_by_name(track_, modalities.track_features);
  }

  std::vector<RegeneratedPart> regenerated(const std::vector<FrameRange>& stretches) {
    std::vector<SideSwap> swaps;
    std::vector<TrackPart> parts;
    const std::vector<bool> bodies = frames_of_a_body(track_);
    std::size_t reference = 0;
    std::ptrdiff_t most = -1;
    for (const FrameRange& stretch : stretches) {
      if (placement_.detected) put_sides_right(stretch, swaps);
      for (const TrackPart& part : parts_of(track_, stretch)) {
        const auto begin = bodies.begin() + part.range.first;
        if (const auto shown = std::count(begin, begin + part.range.frames, true); shown > most) {
          most = shown;
          reference = parts.size();
        }
        parts.push_back(part);
      }
    }
    std::vector<RegeneratedPart> done(parts.size());
    done[reference] = regenerated(parts[reference], nullptr);
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (i != reference) done[i] = regenerated(parts[i], &done[reference]);
    done.front().swaps.insert(done.front().swaps.begin(), swaps.begin(), swaps.end());
    return done;
  }

 private:
  /// Adds what was exchanged.
  void put_sides_right(const FrameRange& stretch, std::vector<SideSwap>& swaps) {
    Track2d part = some_frames(track_, stretch.first, stretch.frames);
    const std::vector<SideSwap> found = find_side_swaps(part);
    if (found.empty()) return;
    exchange_sides(part, found);
    replace_frames(track_, stretch.first, part);
    for (SideSwap swap : found) swaps.push_back(moved(std::move(swap), stretch.first));
  }

  RegeneratedPart regenerated(const TrackPart& part, const RegeneratedPart* reference) const {
    RegeneratedPart done{part, {}, {}, {}, {}, {}, {}};
    const FrameRange& range = part.range;
    SeenClip seen =
        see_clip(modalities_,
                 resample_track(some_frames(track_, range.first, range.frames), modalities_.fps),
                 placement_of(0, reference), single_);
    for (SideSwap& swap : seen.swaps) {
      for (int* frame : {&swap.first_frame, &swap.last_frame})
        *frame = std::min(range.frames - 1,
                          static_cast<int>(std::lround(*frame * track_.fps / modalities_.fps)));
      // What ends in frames that it shares was found in the part before.
      if (swap.last_frame >= part.shared) done.swaps.push_back(moved(std::move(swap), range.first));
    }
    done.filled = at_tracks_rate(std::move(seen.filled));
    for (const PosePrior& prior : all_(seen.features)) {
      const std::size_t answer = done.motions.size();
      ClipPlacement placement = placement_of(answer, reference);
      placement.found = seen.view;
      if (answer > 0) placement.camera = done.camera;  // one camera sees all answers
      const FittedClip clip =
          fit_to_track(prior, modalities_, seen.joints, placement, placement.fit,
                       answer == 0 ? placement.uncertainty_draws : PosteriorDraws{});
      done.motions.push_back(at_tracks_rate(clip.motion, range));
      done.bodies.push_back(clip.motion.skeleton);
      done.camera = clip.camera;
      done.placed_by_size = done.placed_by_size || clip.placed_by_size;
      if (clip.draws.empty()) continue;
      std::vector<Motion> draws;
      for (const Motion& draw : clip.draws) draws.push_back(at_tracks_rate(draw, range));
      const Motion& likeliest = done.motions.back();
      done.uncertainty = joint_uncertainty(likeliest, draws, body_root(likeliest.skeleton));
    }
    return done;
  }

  ClipPlacement placement_of(std::size_t answer, const RegeneratedPart* reference) const {
    ClipPlacement placement = placement_;
    if (reference == nullptr) return placement;
    placement.camera = reference->camera;
    // A body that was found is not exact.
    if (!placement.skeleton) placement.detected = placement.skeleton_found = true;
    placement.skeleton = reference->bodies[answer];
    return placement;
  }

  /// Counts of frames at the model's rate, as the track's frames.
  TrackFeatures::FillCount at_tracks_rate(TrackFeatures::FillCount filled) const {
    for (int* count : {&filled.interpolated, &filled.missing, &filled.outside})
      *count = static_cast<int>(std::lround(*count * track_.fps / modalities_.fps));
    return filled;
  }

  Motion at_tracks_rate(const Motion& motion, const FrameRange& range) const {
    return other_.moved(with_frames(resample(motion, track_.fps, 0, kSameRate), range.frames));
  }

  const Modalities& modalities_;
  Track2d track_;  ///< sides put right on the way
  ClipPlacement placement_;
  const OtherSkeleton& other_;
  const PoseAnswer& single_;
  const PoseAnswers& all_;
};

/// Counts of all parts together; frames that two parts share count twice.
TrackFeatures::FillCount filled_in(const std::vector<RegeneratedPart>& parts) {
  TrackFeatures::FillCount all{0, 0, 0, parts.front().filled.unseen};
  const auto unseen_in = [](const RegeneratedPart& part, const std::string& joint) {
    return std::ranges::find(part.filled.unseen, joint) != part.filled.unseen.end();
  };
  for (const RegeneratedPart& part : parts) {
    all.interpolated += part.filled.interpolated;
    all.missing += part.filled.missing;
    all.outside += part.filled.outside;
    std::erase_if(all.unseen, [&](const auto& joint) { return !unseen_in(part, joint); });
  }
  for (const RegeneratedPart& part : parts)
    all.missing +=
        part.part.range.frames * static_cast<int>(part.filled.unseen.size() - all.unseen.size());
  return all;
}

/// Adds whole turns to angles, by channel the same in all rows, so that the first row is as near as
/// possible to the one before.
/// @param rows [frames x channels], degrees  @param before [1 x channels]
void turn_on_from(const RowVectorD& before, const Skeleton& skeleton, MatrixD& rows) {
  Eigen::Index column = 0;
  for (const Joint& joint : skeleton.joints)
    for (const Channel channel : joint.channels) {
      if (is_rotation(channel))
        rows.col(column).array() += 360 * std::round((before[column] - rows(0, column)) / 360);
      ++column;
    }
}

/// Puts a part behind what stands; over the frames that both have it fades in.
void join(Motion& whole, const Motion& motion, const TrackPart& part) {
  if (part.shared == 0) {
    MatrixD rows = motion.channels;
    if (part.range.first > 0)
      turn_on_from(whole.channels.row(part.range.first - 1), whole.skeleton, rows);
    whole.channels.middleRows(part.range.first, part.range.frames) = rows;
    return;
  }
  for (int t = 0; t < part.range.frames; ++t) {
    const int frame = part.range.first + t;
    const RowVectorD own = motion.channels.row(t);
    const RowVectorD before = t < part.shared ? RowVectorD(whole.channels.row(frame)) : own;
    whole.channels.row(frame) = interpolated_pose(whole.skeleton, before, own, part.share(t),
                                                  whole.channels.row(frame - 1));
  }
}

void join(MatrixD& whole, const MatrixD& rows, const TrackPart& part) {
  for (int t = 0; t < part.range.frames; ++t) {
    auto stands = whole.row(part.range.first + t);
    stands = (1 - part.share(t)) * stands + part.share(t) * rows.row(t);
  }
}

}  // namespace

bool is_other_skeleton(const Modalities& modalities, const Skeleton& wanted) {
  return !has_joints_of(modalities.pose_features.skeleton(), wanted);
}

std::vector<Motion> regenerate_clip(const Modalities& modalities, const Track2d& track,
                                    const ClipPlacement& wanted, const PoseAnswer& single,
                                    const PoseAnswers& all, TrackFindings* findings) {
  const OtherSkeleton other(modalities.pose_features.skeleton(), wanted);
  TrackStretches found = find_stretches(track);
  Track2d steady = track;
  leave_out(steady, found.strays);
  PartRegeneration regeneration(modalities, std::move(steady), other.placement(wanted), other,
                                single, all);
  const std::vector<RegeneratedPart> parts = regeneration.regenerated(found.stretches);
  std::vector<Motion> motions;
  for (const Motion& first : parts.front().motions)
    motions.push_back(
        {first.skeleton, first.frame_time_s, MatrixD::Zero(track.frames(), first.channels.cols())});
  MatrixD uncertainty;
  if (const MatrixD& first = parts.front().uncertainty; first.size() > 0)
    uncertainty = MatrixD::Zero(track.frames(), first.cols());
  for (const RegeneratedPart& part : parts) {
    for (std::size_t i = 0; i < motions.size(); ++i) join(motions[i], part.motions[i], part.part);
    if (uncertainty.size() > 0) join(uncertainty, part.uncertainty, part.part);
  }
  if (!findings) return motions;
  *findings = {filled_in(parts),     {},
               parts.front().camera, std::move(uncertainty),
               std::move(found),     std::ranges::any_of(parts, &RegeneratedPart::placed_by_size)};
  for (const RegeneratedPart& part : parts)
    findings->swaps.insert(findings->swaps.end(), part.swaps.begin(), part.swaps.end());
  std::ranges::sort(findings->swaps, {}, &SideSwap::first_frame);
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
