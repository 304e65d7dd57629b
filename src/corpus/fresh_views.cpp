#include "corpus/fresh_views.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/made_ahead.hpp"
#include "base/missing_values.hpp"
#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

EncodedView encode_view(const Modalities& modalities, const AugmentedView& view, std::size_t clip) {
  // Hidden limbs are left at their mean (Mcdbn::fills_gaps), and nothing is learnt from them.
  const MatrixF track = modalities.encode_track(view.track, view.camera);
  return {at_mean_where_unknown(track),
          modalities.encode_pose(view.motion, view.camera.camera_from_world),
          (!track.array().isNaN()).cast<float>().matrix(), clip};
}

void add_view(EncodedView view, const ClipStore& clips, const ClipGroups& groups,
              TrainingSet& views) {
  views.tracks_seen.push_back(std::move(view.track_seen));
  views.tracks.push_back(std::move(view.track));
  views.poses.push_back(std::move(view.pose));
  views.clips.push_back(clips.record(view.clip).clip);
  groups.add(view.clip, 1, views);
}

FreshViews::FreshViews(ClipStore clips, Modalities modalities, CorpusSettings settings,
                       std::shared_ptr<const PosePool> pool, std::uint64_t seed,
                       const PieceChoice& choice)
    : clips_(std::move(clips)),
      groups_(clips_),
      modalities_(std::move(modalities)),
      settings_(std::move(settings)),
      pool_(std::move(pool)),
      seed_(seed),
      choice_(choice) {
  const auto counts = [&](std::size_t clip) {
    return choice_.people.holds(groups_.people()[clip]);
  };
  bool has_clips = false;
  for (std::size_t i = 0; i < clips_.count(); ++i) {
    const std::size_t group = groups_.groups()[i];
    group_frames_.resize(std::max(group_frames_.size(), group + 1));
    if (!counts(i)) continue;
    group_frames_[group] += clips_.record(i).seconds() * settings_.fps;
    has_clips = true;
  }
  if (!has_clips) throw InputError("no clips are left to learn from");
  double end = 0;
  for (std::size_t i = 0; i < clips_.count(); ++i) {
    // A long clip has as many pieces as fit; windows are drawn from views as their frames.
    const double frames = clips_.record(i).seconds() * settings_.fps;
    if (counts(i))
      end += std::max(1.0, frames / choice_.frames) *
             std::pow(group_frames_[groups_.groups()[i]], choice_.groups_power - 1);
    ends_.push_back(end);
  }
}

EncodedView FreshViews::make(std::size_t number) const {
  const RandomKey key{seed_, static_cast<std::uint32_t>(number), random_streams::kFreshViews, 0};
  RandomSequence random(mixed_seed({key.seed, key.step, key.stream}));
  const auto found = std::ranges::upper_bound(ends_, random.uniform() * ends_.back());
  const auto clip =
      std::min<std::size_t>(static_cast<std::size_t>(found - ends_.begin()), clips_.count() - 1);
  const ClipRecord& record = clips_.record(clip);
  const int wanted =
      static_cast<int>(std::ceil(choice_.frames / (settings_.fps * record.frame_time_s)));
  const int frames = std::min(wanted, record.frames);
  const auto first =
      static_cast<int>(random.below(static_cast<std::size_t>(record.frames - frames) + 1));
  return encode_view(modalities_,
                     augmented_view(clips_.piece(clip, first, frames), settings_.fps,
                                    settings_.camera, settings_.augment, key, false, pool_.get()),
                     clip);
}

TrainingSet FreshViews::make_set(std::size_t first, std::size_t count) const {
  TrainingSet views{modalities_, {}, {}, {}, {}, {}};
  MadeAhead<EncodedView> made([this](std::size_t number) { return make(number); }, first,
                              first + count, usual_threads(), 4 * usual_threads());
  for (std::size_t i = 0; i < count; ++i) add_view(made.next(), clips_, groups_, views);
  return views;
}

}  // namespace mcdbn
