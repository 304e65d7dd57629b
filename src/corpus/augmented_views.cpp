#include "corpus/augmented_views.hpp"

#include <algorithm>
#include <cmath>

#include "base/interruption.hpp"
#include "base/random_streams.hpp"
#include "corpus/clip_groups.hpp"
#include "corpus/clip_pieces.hpp"
#include "corpus/fresh_views.hpp"
#include "corpus/pose_pool.hpp"

namespace mcdbn {
namespace {

/// Fewer views of much data: it varies by itself, and all views are kept in memory.
std::size_t views_that_fit(double frames, const CorpusSettings& settings) {
  const double fitting = std::max(1.0, std::floor(kMostFramesInMemory / std::max(frames, 1.0)));
  return std::min(settings.augment.views, static_cast<std::size_t>(fitting));
}

}  // namespace

double frames_of_views(double frames, const CorpusSettings& settings) {
  return frames * static_cast<double>(views_that_fit(frames, settings));
}

TrainingSet make_augmented_views(const ClipStore& clips, const Modalities& modalities,
                                 const CorpusSettings& settings, std::uint64_t seed,
                                 std::shared_ptr<const PosePool> pool,
                                 std::optional<std::size_t> held_out) {
  if (!pool) pool = pose_pool_for(clips, settings, {.without = held_out});
  std::shared_ptr<const PosePool> pool_of_held_out;
  if (held_out) pool_of_held_out = pose_pool_for(clips, settings, {.only = held_out});
  TrainingSet views{modalities, {}, {}, {}, {}, {}};
  const ClipGroups groups(clips);
  const std::size_t count = views_that_fit(clips.frames_at(settings.fps), settings);
  RandomKey key{seed, 0, random_streams::kAugmentedViews, 0};
  for (std::size_t clip = 0; clip < clips.count(); ++clip) {
    const Motion raw = clips.motion(clip);
    const bool is_held_out = groups.people()[clip] == held_out;
    const PosePool* own = is_held_out ? pool_of_held_out.get() : pool.get();
    for (std::size_t i = 0; i < count; ++i, ++key.step) {
      check_interruption();
      const AugmentedView view =
          augmented_view(raw, settings.fps, settings.camera, settings.augment, key, false, own);
      add_view(encode_view(modalities, view, clip), clips, groups, views);
    }
  }
  const auto whole = [](const MatrixF& seen) { return (seen.array() == 1.0F).all(); };
  if (std::ranges::all_of(views.tracks_seen, whole)) views.tracks_seen.clear();
  return views;
}

}  // namespace mcdbn
