#include "mcdbn/training/training_set.hpp"

#include <algorithm>
#include <cmath>

#include "mcdbn/errors.hpp"
#include "mcdbn/motion/clip.hpp"
#include "mcdbn/motion/resample.hpp"

namespace mcdbn {
namespace {

/// One view of one clip, before scaling.
struct Pair {
  MatrixD track, pose;
};

std::vector<Motion> resampled_phases(const Motion& raw, const TrainingConfig& config) {
  // More grids than source frames in a target frame would only repeat the interpolation.
  const auto most =
      static_cast<std::size_t>(std::max(1.0, std::floor(raw.fps() / config.fps + 1e-6)));
  const std::size_t phases = std::clamp<std::size_t>(config.phases, 1, most);
  std::vector<Motion> clips;
  for (std::size_t i = 0; i < phases; ++i)
    clips.push_back(
        resample(raw, config.fps, static_cast<double>(i) / static_cast<double>(phases)));
  return clips;
}

std::vector<const MatrixD*> members(const std::vector<Pair>& pairs, MatrixD Pair::*member) {
  std::vector<const MatrixD*> blocks;
  for (const Pair& pair : pairs) blocks.push_back(&(pair.*member));
  return blocks;
}

constexpr std::uint16_t kStream = 196;  // of random numbers

/// Views as the joint stage will see them, for the scaling: what hardly moves in the clips may move
/// in their views (the left arm of somebody who waves with the right one, seen in a mirror), and
/// what counts for fifty deviations there hides everything else.
void add_views(const Motion& raw, const TrainingConfig& config, RandomKey& key,
               std::vector<AugmentedView>& views) {
  if (config.joint.steps == 0) return;
  constexpr std::size_t kViews = 4;  // with and without mirror
  AugmentationSettings all_in_sight = config.augment;
  all_in_sight.missing = 0;
  for (std::size_t i = 0; i < std::min(kViews, config.augment.views); ++i, ++key.step)
    views.push_back(augmented_view(raw, config.fps, config.camera, all_in_sight, key));
}

}  // namespace

std::size_t TrainingSet::frames() const {
  std::size_t sum = 0;
  for (const MatrixF& pose : poses) sum += static_cast<std::size_t>(pose.rows());
  return sum;
}

TrainingSet make_training_set(const std::vector<std::filesystem::path>& files,
                              const TrainingConfig& config, std::vector<std::string>* notices) {
  if (files.empty())
    throw InputError("no training clips; name BVH files or folders that hold some");
  std::vector<TrainingClip> recorded;
  std::vector<Motion> motions;
  std::vector<AugmentedView> views;
  RandomKey key{config.seed, 0, kStream, 0};
  for (const auto& file : files) {
    const Motion raw =
        load_clip(file, {.fps = 0, .keep_first_frame = config.keep_first_frame}, notices);
    for (Motion& motion : resampled_phases(raw, config)) motions.push_back(std::move(motion));
    add_views(raw, config, key, views);
    recorded.push_back(identify_clip(file));
  }
  std::vector<const Motion*> all;
  for (const Motion& motion : motions) all.push_back(&motion);
  PoseFeatures pose_features = PoseFeatures::fit(all);
  TrackFeatures track_features =
      TrackFeatures::for_skeleton(pose_features.skeleton(), pose_features.root());
  std::vector<Pair> pairs;
  for (const Motion& motion : motions) {
    const Camera camera = place_camera(motion, config.camera);
    pairs.push_back({track_features.encode(project_motion(motion, camera)),
                     pose_features.encode(motion, camera.camera_from_world)});
  }
  const std::size_t clips = pairs.size();
  for (const AugmentedView& view : views)
    pairs.push_back({track_features.encode(view.track),
                     pose_features.encode(view.motion, view.camera.camera_from_world)});
  TrainingSet set{{std::move(pose_features), std::move(track_features),
                   Standardizer::fit(members(pairs, &Pair::pose)),
                   Standardizer::fit(members(pairs, &Pair::track)), config.fps, config.camera},
                  {},
                  {},
                  std::move(recorded),
                  {}};
  pairs.resize(clips);
  for (const Pair& pair : pairs) {
    set.tracks.push_back(set.modalities.track_scale.apply(pair.track));
    set.poses.push_back(set.modalities.pose_scale.apply(pair.pose));
  }
  return set;
}

}  // namespace mcdbn
