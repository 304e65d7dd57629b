#include "mcdbn/corpus/training_set.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/interruption.hpp"
#include "base/random_streams.hpp"
#include "corpus/clip_groups.hpp"
#include "corpus/clip_pieces.hpp"
#include "corpus/pose_pool.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/humanoid.hpp"
#include "motion/mean_body.hpp"
#include "motion/mirror.hpp"
#include "motion/resample.hpp"

namespace mcdbn {
namespace {

/// One view of one clip, before scaling.
struct Pair {
  MatrixD track, pose;
};

std::vector<Motion> resampled_phases(const Motion& raw, double fps, std::size_t wanted) {
  // More grids than source frames in a target frame would only repeat the interpolation.
  const auto most = static_cast<std::size_t>(std::max(1.0, std::floor(raw.fps() / fps + 1e-6)));
  const std::size_t phases = std::clamp<std::size_t>(wanted, 1, most);
  std::vector<Motion> clips;
  for (std::size_t i = 0; i < phases; ++i)
    clips.push_back(resample(raw, fps, static_cast<double>(i) / static_cast<double>(phases)));
  return clips;
}

std::vector<const MatrixD*> members(const std::vector<Pair>& pairs, MatrixD Pair::*member) {
  std::vector<const MatrixD*> blocks;
  blocks.reserve(pairs.size());
  for (const Pair& pair : pairs) blocks.push_back(&(pair.*member));
  return blocks;
}

/// Views as fine-tuning will see them, for the scaling: what hardly moves in the clips may move
/// in their views (the left arm of a person who waves with the right one, seen in a mirror), and
/// what counts for fifty deviations there hides everything else. So do a detector's errors in what
/// never moves: a spine that the skeleton puts on the pelvis.
template <typename Use>
void for_each_view(const Motion& raw, const CorpusSettings& settings, RandomKey& key,
                   const PosePool* pool, const Use& use) {
  constexpr int kViews = 4;  // every other one in a mirror, as chance may leave that out
  AugmentationSettings not_by_chance = settings.augment;
  not_by_chance.mirror = false;
  std::optional<Motion> other;
  if (settings.augment.mirror) other = mirrored(raw);
  for (int i = 0; i < kViews; ++i, ++key.step)
    use(augmented_view(other && i % 2 == 1 ? *other : raw, settings.fps, settings.camera,
                       not_by_chance, key, true, pool));
}

Pair pair_of(const Motion& motion, const Track2d& track, const Camera& camera,
             const Modalities& modalities) {
  return {modalities.track_values(track, camera),
          modalities.pose_values(motion, camera.camera_from_world)};
}

/// Views of each motion by the model's camera from each of its directions, motion by motion.
std::vector<Pair> seen_pairs(const std::vector<Motion>& motions, const Modalities& modalities) {
  const auto placements = placements_around(modalities.camera, modalities.directions);
  std::vector<Pair> pairs;
  pairs.reserve(motions.size() * placements.size());
  for (const Motion& motion : motions)
    for (const CameraPlacement& placement : placements) {
      const Camera camera = place_camera(motion, placement);
      pairs.push_back(pair_of(motion, project_motion(motion, camera), camera, modalities));
    }
  return pairs;
}

void add_pairs(const std::vector<Pair>& pairs, TrainingSet& set) {
  for (const Pair& pair : pairs) {
    set.tracks.push_back(set.modalities.track_scale.apply(pair.track));
    set.poses.push_back(set.modalities.pose_scale.apply(pair.pose));
  }
}

std::vector<const Motion*> pointers(const std::vector<Motion>& motions) {
  std::vector<const Motion*> all;
  all.reserve(motions.size());
  for (const Motion& motion : motions) all.push_back(&motion);
  return all;
}

/// The pieces of the clips that are used, and their motion at the model's rate.
struct SampledClips {
  const ClipStore& clips;
  std::vector<ClipPiece> pieces;
  std::vector<Motion> motions;
  std::vector<std::size_t> phases;  ///< motions of each piece

  /// @param with_views one phase is enough: what is learnt from are views of the clips themselves
  SampledClips(const ClipStore& from, const CorpusSettings& settings, bool with_views)
      : clips(from) {
    if (clips.count() == 0)
      throw InputError("no training clips; name BVH files or folders that hold some");
    pieces = pieces_in_memory(clips, settings.fps);
    for (const ClipPiece& piece : pieces) {
      check_interruption();
      const std::size_t before = motions.size();
      for (Motion& motion : resampled_phases(clips.piece(piece.clip, piece.first, piece.frames),
                                             settings.fps, with_views ? 1 : settings.phases))
        motions.push_back(std::move(motion));
      phases.push_back(motions.size() - before);
    }
  }

  /// Without tracks and poses.
  TrainingSet set(Modalities modalities) const {
    TrainingSet set{std::move(modalities), {}, {}, {}, {}, {}};
    for (const ClipRecord& record : clips.records()) set.clips.push_back(record.clip);
    const ClipGroups groups(clips);
    for (std::size_t i = 0; i < pieces.size(); ++i)
      groups.add(pieces[i].clip, phases[i] * set.modalities.directions, set);
    return set;
  }
};

/// The first skeleton of each person.
std::vector<Skeleton> people_in(const ClipStore& clips) {
  const ClipGroups groups(clips);
  std::vector<Skeleton> people;
  for (std::size_t i = 0; i < clips.count(); ++i)
    if (groups.people()[i] == people.size()) people.push_back(clips.record(i).skeleton);
  return people;
}

/// The model's skeleton is no single person's: an unknown person is most like the mean of the known
/// ones.
PoseFeatures fitted_features(const std::vector<const Motion*>& motions, const ClipStore& clips) {
  const PoseFeatures features = PoseFeatures::fit(motions);
  Skeleton skeleton =
      is_humanoid(features.skeleton()) ? canonical_humanoid() : mean_body(people_in(clips));
  return PoseFeatures::restored(std::move(skeleton), features.root(), features.joints(),
                                features.fixed_channels());
}

}  // namespace

std::size_t TrainingSet::frames() const {
  std::size_t sum = 0;
  for (const MatrixF& pose : poses) sum += static_cast<std::size_t>(pose.rows());
  return sum;
}

TrainingSet make_training_set(const ClipStore& clips, const CorpusSettings& settings,
                              std::uint64_t seed, bool with_views,
                              std::optional<std::size_t> held_out) {
  const SampledClips sampled(clips, settings, with_views);
  PoseFeatures pose_features = fitted_features(pointers(sampled.motions), clips);
  TrackFeatures track_features =
      TrackFeatures::for_skeleton(pose_features.skeleton(), pose_features.root());
  TrainingSet set = sampled.set({std::move(pose_features),
                                 std::move(track_features),
                                 {},
                                 {},
                                 settings.fps,
                                 settings.camera,
                                 with_views ? 1 : settings.directions,
                                 true});
  if (with_views) set.new_poses = pose_pool_for(clips, settings, {.without = held_out});
  Modalities& modalities = set.modalities;
  std::vector<Pair> pairs = seen_pairs(sampled.motions, modalities);
  const std::size_t of_clips = pairs.size();
  RandomKey key{seed, 0, random_streams::kScalingViews, 0};
  for (const ClipPiece& piece : sampled.pieces) {
    if (!with_views) break;
    check_interruption();
    for_each_view(clips.piece(piece.clip, piece.first, piece.frames), settings, key,
                  set.new_poses.get(), [&](const AugmentedView& view) {
                    pairs.push_back(pair_of(view.motion, view.track, view.camera, modalities));
                  });
  }
  modalities.pose_scale = Standardizer::fit(members(pairs, &Pair::pose));
  modalities.track_scale = Standardizer::fit(members(pairs, &Pair::track));
  pairs.resize(of_clips);  // without views
  add_pairs(pairs, set);
  return set;
}

TrainingSet encoded_training_set(const ClipStore& clips, const Modalities& modalities,
                                 const CorpusSettings& settings, bool with_views,
                                 std::optional<std::size_t> held_out) {
  const SampledClips sampled(clips, settings, with_views);
  TrainingSet set = sampled.set(modalities);
  if (with_views) set.new_poses = pose_pool_for(clips, settings, {.without = held_out});
  add_pairs(seen_pairs(sampled.motions, modalities), set);
  return set;
}

}  // namespace mcdbn
