#include "mcdbn/motion_model/seen_clip.hpp"

#include <algorithm>

#include "base/fill_gap.hpp"
#include "camera/agreeing_joints.hpp"
#include "camera/confidence_weights.hpp"
#include "camera/cut_off.hpp"
#include "fitting/track_smoothing.hpp"
#include "motion_model/keypoint_columns.hpp"
#include "motion_model/returned_sides.hpp"

namespace mcdbn {
namespace {

/// More rounds change next to nothing: with an arm hidden for a second held-out walkers are off by
/// 8.9, 7.8, 7.6 and 7.5 mm after 0, 1, 2 and 4, with all joints visible by 6.5. A third makes
/// detector-like tracks of training people no better either, whether the camera is known or to be
/// found.
constexpr int kRounds = 2;

/// Between the frames that a round solves for: it needs to know about where joints are. With frames
/// of every tenth of a second detector-like tracks of training people end 0.1 mm better, in a tenth
/// more time.
constexpr double kOfRounds_s = 0.2;

/// @param every_s between the frames that are solved for
ClipPlacement roughly(ClipPlacement placement, double every_s = kOfRounds_s) {
  if (placement.fit) {
    placement.fit->most_solutions = 0;
    placement.fit->first_solution_step_s = every_s;
  }
  return placement;
}

/// Frames of which nothing is known lie on the straight line between the nearest ones of which
/// something is, and are held at the ends. At the training mean the network's answer would be its
/// mean pose, which looks the same way in every camera: a walker whom something hides for half a
/// second would turn to it and back.
MatrixF bridged(MatrixF features) {
  const Eigen::Index frames = features.rows();
  const auto is_unknown = [&](Eigen::Index t) { return features.row(t).array().isNaN().all(); };
  for (Eigen::Index first = 0; first < frames; ++first) {
    if (!is_unknown(first)) continue;
    Eigen::Index last = first;
    while (last < frames && is_unknown(last)) ++last;
    if (last - first < frames) fill_gap(features, first, last);
    first = last;
  }
  return features;
}

}  // namespace

MatrixF where_known(const MatrixF& features, const MatrixF& otherwise) {
  return features.array().isNaN().select(otherwise, features);
}

std::vector<Keypoint> keypoints_of_columns(const Track2d& track) {
  if (!track.keypoints.empty()) return track.keypoints;
  Skeleton named;
  for (const std::string& name : track.joint_names) {
    named.joints.emplace_back();
    named.joints.back().name = name;
    named.joints.back().parent = named.joint_count() > 1 ? 0 : -1;
  }
  const SkeletonRoles roles = skeleton_roles(named);
  std::vector<Keypoint> keypoints;
  for (int column = 0; column < track.joint_count(); ++column) {
    keypoints.emplace_back();
    keypoints.back().name = track.joint_names[static_cast<std::size_t>(column)];
    keypoints.back().role = roles.role_of(column);
  }
  return keypoints;
}

MatrixF fill_gaps(const Modalities& modalities, const MatrixF& features, const Track2d& track,
                  const ClipPlacement& placement, const PoseAnswer& answer) {
  if (!features.array().isNaN().any()) return features;
  const Camera camera = placement.camera_of(track, modalities);
  MatrixF filled = bridged(features);
  const ClipPlacement rough = roughly(placement);
  for (int round = 0; round < kRounds; ++round) {
    const Track2d shown = fit_to_track(answer(filled), modalities, track, rough, rough.fit).shown;
    filled = where_known(features, modalities.encode_track(shown, camera));
  }
  return filled;
}

bool finds_view(const Modalities& modalities, const KnownOfClip& known) {
  return modalities.level_view && !known.camera &&
         !(known.view.pitch_deg && known.view.roll_deg && known.view.field_of_view_deg);
}

bool joined_by_name(const Track2d& track, const TrackFeatures& features) {
  const auto found = std::ranges::count_if(
      features.joint_names(), [&](const std::string& name) { return track.find(name) >= 0; });
  return track.find(features.root_name()) >= 0 &&
         found >= std::min<std::ptrdiff_t>(2, std::ssize(features.joint_names()));
}

std::optional<KeypointMap> keypoint_map_of(const Modalities& modalities, const Track2d& track,
                                           const ClipPlacement& placement) {
  if (joined_by_name(track, modalities.track_features)) return {};
  const Skeleton& skeleton =
      placement.skeleton ? *placement.skeleton : modalities.pose_features.skeleton();
  return KeypointMap(keypoints_of_columns(track), skeleton,
                     skeleton_roles(skeleton, placement.joint_map));
}

namespace {

/// The model's joints, by name.
SeenClip see_joints(const Modalities& modalities, const Track2d& track,
                    const ClipPlacement& placement, const PoseAnswer& answer) {
  SeenClip seen;
  seen.joints = track;
  const Track2d smooth = smooth_track(track);
  ClipPlacement rough = roughly(placement);
  const auto look = [&] {
    const Camera camera = rough.camera_of(track, modalities);
    seen.features = modalities.encode_track(smooth, camera, &seen.filled);
    seen.features = fill_gaps(modalities, seen.features, track, rough, answer);
  };
  look();
  for (int round = 0; finds_view(modalities, placement) && round < kRounds; ++round) {
    rough.found = fit_to_track(answer(seen.features), modalities, track, rough, rough.fit).view;
    look();
  }
  seen.view = rough.assumed();
  return seen;
}

}  // namespace

SeenClip see_clip(const Modalities& modalities, const Track2d& track,
                  const ClipPlacement& placement, const PoseAnswer& answer) {
  const std::optional<KeypointMap> map = keypoint_map_of(modalities, track, placement);
  if (!map) return see_joints(modalities, track, placement, answer);
  SeenClip seen;
  ClipPlacement rough = roughly(placement);
  const auto features_of = [&](const Track2d& joints) {
    return modalities.encode_track(smooth_track(joints), rough.camera_of(track, modalities));
  };
  Track2d weighted = without_cut_off(weighted_by_confidence(track));
  if (placement.fit) {
    // A spell lasts for some frames.
    const ClipPlacement finer = roughly(placement, placement.fit->first_solution_step_s);
    seen.swaps = swapped_spells(weighted, [&](const Track2d& some) {
      const Track2d joints = map->joints_of(some);
      return fit_to_track(answer(bridged(features_of(joints))), modalities, map->evidence(joints),
                          finer, finer.fit)
          .energy;
    });
    exchange_sides(weighted, seen.swaps);
  }
  Track2d joints = map->joints_of(weighted);
  seen.features = bridged(features_of(joints));
  for (int round = 0; round < kRounds; ++round) {
    const FittedClip clip =
        fit_to_track(answer(seen.features), modalities, map->evidence(joints), rough, rough.fit);
    joints = map->joints_of(weighted, clip.motion, clip.camera);
    if (finds_view(modalities, placement)) rough.found = clip.view;
    seen.features =
        where_known(features_of(placement.fit ? agreeing_joints(joints, clip.shown) : joints),
                    modalities.encode_track(clip.shown, rough.camera_of(track, modalities)));
  }
  modalities.encode_track(joints, rough.camera_of(track, modalities), &seen.filled);
  seen.joints = map->evidence(joints);
  seen.view = rough.assumed();
  return seen;
}

}  // namespace mcdbn
