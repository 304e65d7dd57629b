#include "corpus/augmented_views.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/interruption.hpp"
#include "base/missing_values.hpp"
#include "base/random_streams.hpp"
#include "corpus/clip_groups.hpp"
#include "corpus/pose_pool.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/features/standardizer.hpp"

namespace mcdbn {
namespace {

/// Fewer views of much data: it varies by itself, and all views are kept in memory.
std::size_t views_that_fit(double frames, const CorpusSettings& settings) {
  constexpr double kMostFrames = 200'000;
  const double fitting = std::max(1.0, std::floor(kMostFrames / std::max(frames, 1.0)));
  return std::min(settings.augment.views, static_cast<std::size_t>(fitting));
}

/// Of all clips at the model's rate.
double frames_of(const std::vector<LoadedClip>& clips, const CorpusSettings& settings) {
  double frames = 0;
  for (const LoadedClip& loaded : clips) {
    const Motion& raw = loaded.motion;
    frames += static_cast<double>(raw.frames()) * raw.frame_time_s * settings.fps;
  }
  return frames;
}

}  // namespace

double frames_of_views(double frames, const CorpusSettings& settings) {
  return frames * static_cast<double>(views_that_fit(frames, settings));
}

TrainingSet make_augmented_views(const std::vector<LoadedClip>& clips, const Modalities& modalities,
                                 const CorpusSettings& settings, std::uint64_t seed) {
  const std::size_t count = views_that_fit(frames_of(clips, settings), settings);
  TrainingSet views{modalities, {}, {}, {}, {}, {}};
  ClipGroups groups(clips);
  std::optional<PosePool> pool;
  if (settings.augment.new_poses()) pool.emplace(clips, settings.fps);
  RandomKey key{seed, 0, random_streams::kAugmentedViews, 0};
  for (const LoadedClip& loaded : clips) {
    const Motion& raw = loaded.motion;
    groups.add(loaded, count, views);
    for (std::size_t i = 0; i < count; ++i, ++key.step) {
      check_interruption();
      views.clips.push_back(loaded.clip);
      const AugmentedView view =
          augmented_view(raw, settings.fps, settings.camera, settings.augment, key, false,
                         pool ? &*pool : nullptr);
      // Limbs out of sight: as Mcdbn::fills_gaps says, and nothing is learnt from them.
      const MatrixF track = modalities.encode_track(view.track, view.camera);
      views.tracks_seen.emplace_back((!track.array().isNaN()).cast<float>().matrix());
      views.tracks.push_back(at_mean_where_unknown(track));
      views.poses.push_back(modalities.encode_pose(view.motion, view.camera.camera_from_world));
    }
  }
  const auto whole = [](const MatrixF& seen) { return (seen.array() == 1.0F).all(); };
  if (std::ranges::all_of(views.tracks_seen, whole)) views.tracks_seen.clear();
  return views;
}

}  // namespace mcdbn
