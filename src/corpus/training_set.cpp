#include "mcdbn/corpus/training_set.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/interruption.hpp"
#include "base/random_streams.hpp"
#include "corpus/clip_groups.hpp"
#include "corpus/pose_pool.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "motion/resample.hpp"

namespace mcdbn {
namespace {

/// One view of one clip, before scaling.
struct Pair {
  MatrixD track, pose;
};

std::vector<Motion> resampled_phases(const Motion& raw, const CorpusSettings& settings) {
  // More grids than source frames in a target frame would only repeat the interpolation.
  const auto most =
      static_cast<std::size_t>(std::max(1.0, std::floor(raw.fps() / settings.fps + 1e-6)));
  const std::size_t phases = std::clamp<std::size_t>(settings.phases, 1, most);
  std::vector<Motion> clips;
  for (std::size_t i = 0; i < phases; ++i)
    clips.push_back(
        resample(raw, settings.fps, static_cast<double>(i) / static_cast<double>(phases)));
  return clips;
}

std::vector<const MatrixD*> members(const std::vector<Pair>& pairs, MatrixD Pair::*member) {
  std::vector<const MatrixD*> blocks;
  blocks.reserve(pairs.size());
  for (const Pair& pair : pairs) blocks.push_back(&(pair.*member));
  return blocks;
}

/// Views as fine-tuning will see them, for the scaling: what hardly moves in the clips may move
/// in their views (the left arm of somebody who waves with the right one, seen in a mirror), and
/// what counts for fifty deviations there hides everything else. So do a detector's errors in what
/// never moves: a spine that the skeleton puts on the pelvis.
void add_views(const Motion& raw, const CorpusSettings& settings, RandomKey& key,
               const PosePool* pool, std::vector<AugmentedView>& views) {
  constexpr std::size_t kViews = 4;  // with and without mirror
  for (std::size_t i = 0; i < std::min(kViews, settings.augment.views); ++i, ++key.step)
    views.push_back(
        augmented_view(raw, settings.fps, settings.camera, settings.augment, key, true, pool));
}

/// Of a humanoid the model's skeleton is nobody's in particular.
PoseFeatures fitted_features(const std::vector<const Motion*>& clips) {
  PoseFeatures features = PoseFeatures::fit(clips);
  if (!is_humanoid(features.skeleton())) return features;
  return PoseFeatures::restored(canonical_humanoid(), features.root(), features.joints(),
                                features.fixed_channels());
}

}  // namespace

std::size_t TrainingSet::frames() const {
  std::size_t sum = 0;
  for (const MatrixF& pose : poses) sum += static_cast<std::size_t>(pose.rows());
  return sum;
}

TrainingSet make_training_set(const std::vector<LoadedClip>& clips, const CorpusSettings& settings,
                              std::uint64_t seed, bool with_views) {
  if (clips.empty())
    throw InputError("no training clips; name BVH files or folders that hold some");
  std::vector<TrainingClip> recorded;
  std::vector<Motion> motions;
  std::vector<AugmentedView> views;
  std::optional<PosePool> pool;
  if (with_views && settings.augment.new_poses()) pool.emplace(clips, settings.fps);
  RandomKey key{seed, 0, random_streams::kScalingViews, 0};
  std::vector<std::size_t> phases;
  for (const LoadedClip& loaded : clips) {
    check_interruption();
    const std::size_t before = motions.size();
    for (Motion& motion : resampled_phases(loaded.motion, settings))
      motions.push_back(std::move(motion));
    phases.push_back(motions.size() - before);
    if (with_views) add_views(loaded.motion, settings, key, pool ? &*pool : nullptr, views);
    recorded.push_back(loaded.clip);
  }
  std::vector<const Motion*> all;
  all.reserve(motions.size());
  for (const Motion& motion : motions) all.push_back(&motion);
  PoseFeatures pose_features = fitted_features(all);
  TrackFeatures track_features =
      TrackFeatures::for_skeleton(pose_features.skeleton(), pose_features.root());
  TrainingSet set{{std::move(pose_features),
                   std::move(track_features),
                   {},
                   {},
                   settings.fps,
                   settings.camera,
                   true},
                  {},
                  {},
                  std::move(recorded),
                  {},
                  {}};
  ClipGroups groups(clips);
  for (std::size_t i = 0; i < clips.size(); ++i) groups.add(clips[i], phases[i], set);
  Modalities& modalities = set.modalities;
  std::vector<Pair> pairs;
  const auto add_pair = [&](const Motion& motion, const Track2d& track, const Camera& camera) {
    pairs.push_back({modalities.track_values(track, camera),
                     modalities.pose_values(motion, camera.camera_from_world)});
  };
  for (const Motion& motion : motions) {
    const Camera camera = place_camera(motion, settings.camera);
    add_pair(motion, project_motion(motion, camera), camera);
  }
  for (const AugmentedView& view : views) add_pair(view.motion, view.track, view.camera);
  modalities.pose_scale = Standardizer::fit(members(pairs, &Pair::pose));
  modalities.track_scale = Standardizer::fit(members(pairs, &Pair::track));
  pairs.resize(motions.size());  // without views
  for (const Pair& pair : pairs) {
    set.tracks.push_back(modalities.track_scale.apply(pair.track));
    set.poses.push_back(modalities.pose_scale.apply(pair.pose));
  }
  return set;
}

}  // namespace mcdbn
