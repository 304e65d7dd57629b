#include "mcdbn/motion_model/training_sources.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/made_ahead.hpp"
#include "corpus/augmented_views.hpp"
#include "corpus/fresh_views.hpp"
#include "corpus/held_out_person.hpp"
#include "corpus/pose_pool.hpp"

namespace mcdbn {
namespace {

/// How many windows are drawn from a view before a fresh one replaces it, where the settings do not
/// say so: the corpus is too large to keep all its views.
constexpr std::size_t kUsesOfMany = 16;

PieceChoice pieces_of(const TrainingConfig& config) {
  return {.frames = frames_of_pieces(config), .groups_power = config.fine_tuning.people_power};
}

/// Users' seeds are small numbers: no other views are drawn with this one.
std::uint64_t held_out_seed(const TrainingConfig& config) {
  return config.seed + (1ULL << 32U);
}

}  // namespace

int frames_of_pieces(const TrainingConfig& config) {
  const std::size_t window = config.layers * config.order + config.fine_tuning.settle_frames +
                             config.fine_tuning.window_frames + config.look_ahead;
  return std::max(kPieceFrames, static_cast<int>(3 * window));
}

ViewSource::ViewSource(ClipStore clips, const TrainingSet& data, TrainingConfig config)
    : clips_(std::move(clips)),
      data_(data),
      config_(std::move(config)),
      held_out_(person_to_hold_out(clips_, config_.hold_out_among)) {}

const ViewSource::Views& ViewSource::made() const {
  if (views_) return *views_;
  TrainingSet all = make_augmented_views(clips_, data_.modalities, config_, config_.seed,
                                         data_.new_poses, held_out_);
  if (held_out_)
    views_ = Views{views_without(all, *held_out_), views_of(all, *held_out_)};
  else
    views_ = Views{std::move(all), {}};
  return *views_;
}

bool learns_from_fresh_views(const ClipStore& clips, const TrainingConfig& config) {
  return config.fine_tuning.steps > 0 &&
         (config.fine_tuning.view_uses > 0 || clips.frames_at(config.fps) > kMostFramesInMemory);
}

std::size_t fresh_views_at_once(const ClipStore& clips, const TrainingConfig& config) {
  const int frames = frames_of_pieces(config);
  double pieces = 0;
  for (const ClipRecord& record : clips.records())
    pieces += std::max(1.0, record.seconds() * config.fps / frames);
  return static_cast<std::size_t>(std::clamp(
      std::ceil(static_cast<double>(config.augment.views) * pieces), 1.0, kSomeFrames / frames));
}

TrainingSet some_fresh_views(const ClipStore& clips, const Modalities& modalities,
                             const TrainingConfig& config) {
  PieceChoice pieces = pieces_of(config);
  pieces.people.without = person_to_hold_out(clips, config.hold_out_among);
  return FreshViews(clips, modalities, config, pose_pool_for(clips, config, pieces.people),
                    config.seed, pieces)
      .make_set(0, static_cast<std::size_t>(kMostFramesInMemory / pieces.frames));
}

/// The views in use, `count` at a time: view n is in place n mod count until view n + count
/// replaces it.
class ViewLoader {
 public:
  ViewLoader(FreshViews views, std::size_t count, const FineTuningSettings& settings)
      : views_(std::move(views)),
        fresh_a_step_(
            static_cast<double>(settings.windows) /
            static_cast<double>(settings.view_uses > 0 ? settings.view_uses : kUsesOfMany)),
        tracks_(count),
        poses_(count),
        seen_(count),
        groups_(count) {
    fill(0);
  }

  SynchronizedClips sequences() const {
    return {{{kModalityNames[kTrack], tracks_, VisibleKind::gaussian, seen_},
             {kModalityNames[kPose], poses_}},
            groups_,
            views_.group_frames(),
            views_.groups_power()};
  }
  bool renew(std::size_t step) {
    const auto first = static_cast<std::size_t>(static_cast<double>(step) * fresh_a_step_);
    if (first == first_) return false;
    fill(first);
    return true;
  }
  std::size_t lifetime() const {
    return static_cast<std::size_t>(static_cast<double>(tracks_.size()) / fresh_a_step_) + 1;
  }

 private:
  /// Puts the views from `first` on in place.
  void fill(std::size_t first) {
    const std::size_t count = tracks_.size(), end = first_ + count;
    if (!ahead_ || first < first_ || first >= end) {
      constexpr std::size_t kMostAhead = 64;
      // One thread less than the machine has, which drives the device.
      const std::size_t threads = std::max<std::size_t>(usual_threads(), 2) - 1;
      ahead_.emplace([this](std::size_t number) { return views_.make(number); }, first,
                     std::numeric_limits<std::size_t>::max(), threads, kMostAhead);
      for (std::size_t i = 0; i < count; ++i) take(first + i);
    } else {
      for (std::size_t number = end; number < first + count; ++number) take(number);
    }
    first_ = first;
  }
  void take(std::size_t number) {
    EncodedView view = ahead_->next();
    const std::size_t place = number % tracks_.size();
    groups_[place] = views_.group_of(view);
    tracks_[place] = std::move(view.track);
    poses_[place] = std::move(view.pose);
    seen_[place] = std::move(view.track_seen);
  }

  FreshViews views_;
  double fresh_a_step_;
  std::vector<MatrixF> tracks_, poses_, seen_;
  std::vector<std::size_t> groups_;
  std::size_t first_ = 0;
  std::optional<MadeAhead<EncodedView>> ahead_;  // last: its threads use what is above
};

FreshViewSource::FreshViewSource(const ClipStore& clips, const TrainingSet& data,
                                 const TrainingConfig& config) {
  PieceChoice pieces = pieces_of(config);
  pieces.people.without = person_to_hold_out(clips, config.hold_out_among);
  loader_ = std::make_unique<ViewLoader>(
      FreshViews(clips, data.modalities, config, data.new_poses, config.seed, pieces),
      fresh_views_at_once(clips, config), config.fine_tuning);
  if (!pieces.people.without) return;
  constexpr std::size_t kHeldOutViews = 24;
  pieces.people = {.without = {}, .only = pieces.people.without};
  held_out_views_ =
      FreshViews(clips, data.modalities, config, pose_pool_for(clips, config, pieces.people),
                 held_out_seed(config), pieces)
          .make_set(0, kHeldOutViews);
  held_out_views_->groups.clear();  // the person's actions are drawn as they weigh already
}

FreshViewSource::~FreshViewSource() = default;

SynchronizedClips FreshViewSource::sequences() const {
  return loader_->sequences();
}

bool FreshViewSource::renew(std::size_t step) const {
  return loader_->renew(step);
}

std::size_t FreshViewSource::lifetime() const {
  return loader_->lifetime();
}

}  // namespace mcdbn
