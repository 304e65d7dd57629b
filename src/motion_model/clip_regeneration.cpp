#include "mcdbn/motion_model/clip_regeneration.hpp"

#include <algorithm>

#include "camera/track_resample.hpp"
#include "mcdbn/motion_model/training_sources.hpp"
#include "motion/resample.hpp"

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

}  // namespace

std::vector<Motion> regenerate_clip(const Modalities& modalities, const Track2d& track,
                                    const ClipPlacement& placement, const PoseAnswer& single,
                                    const PoseAnswers& all, TrackFindings* findings) {
  Track2d sides = track;
  std::vector<SideSwap> swaps;
  if (!joined_by_name(track, modalities.track_features)) {
    swaps = find_side_swaps(track);
    exchange_sides(sides, swaps);
  }
  SeenClip seen = see_clip(modalities, resample_track(sides, modalities.fps), placement, single);
  std::vector<Motion> motions;
  Camera camera;
  for (const MatrixF& pose : all(seen.features)) {
    const FittedClip clip =
        fit_to_track(PosePrior::around(pose), modalities, seen.joints, placement, placement.fit);
    if (motions.empty()) camera = clip.camera;
    motions.push_back(with_frames(resample(clip.motion, track.fps), track.frames()));
  }
  if (findings) *findings = {std::move(seen.filled), std::move(swaps), std::move(camera)};
  return motions;
}

std::vector<Motion> regenerate_clip(const Model& model, const Track2d& track,
                                    const ClipPlacement& placement,
                                    const RegenerationOptions& options, TrackFindings* findings) {
  return regenerate_clip(
      model.modalities, track, placement,
      [&](const MatrixF& features) { return single_answer(model.network, features); },
      [&](const MatrixF& features) { return regenerate(model.network, {features}, options); },
      findings);
}

std::vector<Track2d> regenerate_track(const Model& model, const Motion& clip,
                                      const RegenerationOptions& options,
                                      const std::optional<Camera>& camera) {
  const Modalities& modalities = model.modalities;
  const Camera seen_by = camera.value_or(camera_at_origin(modalities.camera));
  const MatrixF pose =
      modalities.encode_pose(resample(clip, modalities.fps), seen_by.camera_from_world);
  std::vector<std::vector<MatrixF>> present(model.network.modality_count());
  present[kPose] = {pose};
  std::vector<Track2d> tracks;
  for (const MatrixF& track : regenerate(model.network, present, kTrack, options))
    tracks.push_back(modalities.decode_track(track, seen_by));
  return tracks;
}

}  // namespace mcdbn
