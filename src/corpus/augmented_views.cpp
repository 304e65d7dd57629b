#include "corpus/augmented_views.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/missing_values.hpp"
#include "base/random_streams.hpp"
#include "corpus/people.hpp"
#include "corpus/pose_pool.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/features/standardizer.hpp"

namespace mcdbn {
namespace {

/// Fewer views of much data: it varies by itself, and all views are kept in memory.
std::size_t views_that_fit(const std::vector<LoadedClip>& clips, const CorpusSettings& settings) {
  constexpr double kMostFrames = 200'000;
  double frames = 0;
  for (const LoadedClip& loaded : clips) {
    const Motion& raw = loaded.motion;
    frames += static_cast<double>(raw.frames()) * raw.frame_time_s * settings.fps;
  }
  const double fitting = std::max(1.0, std::floor(kMostFrames / std::max(frames, 1.0)));
  return std::min(settings.augment.views, static_cast<std::size_t>(fitting));
}

}  // namespace

TrainingSet make_augmented_views(const std::vector<LoadedClip>& clips, const Modalities& modalities,
                                 const CorpusSettings& settings, std::uint64_t seed) {
  const std::size_t count = views_that_fit(clips, settings);
  TrainingSet views{modalities, {}, {}, {}, {}, {}};
  PeopleCount people;
  std::map<std::pair<std::size_t, std::string>, std::size_t> groups;
  const bool actions_said =
      std::ranges::any_of(clips, [](const LoadedClip& loaded) { return !loaded.action.empty(); });
  std::optional<PosePool> pool;
  if (settings.augment.new_poses()) pool.emplace(clips, settings.fps);
  RandomKey key{seed, 0, random_streams::kAugmentedViews, 0};
  for (const LoadedClip& loaded : clips) {
    const Motion& raw = loaded.motion;
    const std::size_t person = people.number_of(raw.skeleton, loaded.person);
    const std::size_t group =
        groups.try_emplace(std::pair{person, loaded.action}, groups.size()).first->second;
    for (std::size_t i = 0; i < count; ++i, ++key.step) {
      views.people.push_back(person);
      if (actions_said) views.groups.push_back(group);
      views.clips.push_back(loaded.clip);
      const AugmentedView view =
          augmented_view(raw, settings.fps, settings.camera, settings.augment, key, false,
                         pool ? &*pool : nullptr);
      // Limbs out of sight: as Mcdbn::fills_gaps says, and nothing is learnt from them.
      const MatrixF track = modalities.encode_track(view.track, view.camera);
      views.tracks_seen.push_back((!track.array().isNaN()).cast<float>().matrix());
      views.tracks.push_back(at_mean_where_unknown(track));
      views.poses.push_back(modalities.encode_pose(view.motion, view.camera.camera_from_world));
    }
  }
  const auto whole = [](const MatrixF& seen) { return (seen.array() == 1.0F).all(); };
  if (std::ranges::all_of(views.tracks_seen, whole)) views.tracks_seen.clear();
  return views;
}

}  // namespace mcdbn
