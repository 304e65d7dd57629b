#include "corpus/fresh_views.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "corpus/humanoid_clips.hpp"
#include "corpus/no_augmentation.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr std::uint64_t kSeed = 11;

LoadedClip clip_of(const std::string& person, const std::string& action, int frames,
                   double heading_deg) {
  LoadedClip clip = humanoid_clip(20 + heading_deg, 30, heading_deg, frames);
  clip.clip.path = person + action;
  clip.clip.person = person;
  clip.clip.action = action;
  return clip;
}

/// 90 and 30 frames of one person's two actions, 60 of another's, at the humanoid's 30 a second.
ClipStore three_clips() {
  return ClipStore(
      {clip_of("a", "walk", 90, 0), clip_of("a", "wave", 30, 40), clip_of("b", "walk", 60, 80)});
}

CorpusSettings settings() {
  CorpusSettings settings;
  settings.augment.missing = 0.5;
  settings.augment.limbs_exchanged = settings.augment.limbs_turned = 0.5;
  settings.augment.detector = 0.5;
  return settings;
}

FreshViews views(const CorpusSettings& with, const PieceChoice& choice,
                 std::uint64_t seed = kSeed) {
  static const Modalities modalities =
      make_training_set(three_clips(), settings(), kSeed, true).modalities;
  return {three_clips(), modalities, with, pose_pool_for(three_clips(), with), seed, choice};
}

bool same(const EncodedView& x, const EncodedView& y) {
  return x.clip == y.clip && x.pose.rows() == y.pose.rows() && x.pose == y.pose &&
         x.track == y.track && x.track_seen == y.track_seen;
}

/// Share of each clip's frames among those of many views.
std::map<std::size_t, double> shares(const PieceChoice& choice) {
  CorpusSettings plain;
  plain.augment = nothing();
  const FreshViews some = views(plain, choice);
  std::map<std::size_t, double> frames;
  double all = 0;
  for (std::size_t n = 0; n < 1500; ++n) {
    const EncodedView view = some.make(n);
    frames[view.clip] += static_cast<double>(view.pose.rows());
    all += static_cast<double>(view.pose.rows());
  }
  for (auto& [clip, share] : frames) share /= all;
  return frames;
}

}  // namespace

TEST_CASE("a view hangs on its number and the seed alone, and several threads make the same") {
  const FreshViews some = views(settings(), {.frames = 40});
  const TrainingSet set = some.make_set(5, 12);
  REQUIRE(set.poses.size() == 12);
  const ClipGroups groups(three_clips());
  for (std::size_t i = 0; i < 12; ++i) {
    const EncodedView view = views(settings(), {.frames = 40}).make(5 + i);
    CHECK(set.poses[i] == view.pose);
    CHECK(set.tracks[i] == view.track);
    CHECK(set.tracks_seen[i] == view.track_seen);
    CHECK(set.people[i] == groups.people()[view.clip]);
    CHECK(set.groups[i] == groups.groups()[view.clip]);
    CHECK(set.clips[i].path == three_clips().record(view.clip).clip.path);
    CHECK_FALSE(same(view, views(settings(), {.frames = 40}, kSeed + 1).make(5 + i)));
    for (std::size_t j = 0; j < i; ++j)
      CHECK((set.poses[i].rows() != set.poses[j].rows() || set.poses[i] != set.poses[j]));
  }
}

TEST_CASE("a view is a piece of a clip from anywhere in it, seen as the settings specify") {
  CorpusSettings plain;
  plain.augment = nothing();
  const FreshViews some = views(plain, {.frames = 40});
  const ClipStore clips = three_clips();
  // Where in the first clip a view begins: at the frame of a view of all of it that is nearest.
  const FreshViews whole = views(plain, {.frames = 1000});
  std::size_t number = 0;
  while (whole.make(number).clip != 0) ++number;
  const MatrixF all = whole.make(number).pose;
  std::map<std::size_t, std::vector<Eigen::Index>> firsts;
  for (std::size_t n = 0; n < 60; ++n) {
    const EncodedView view = some.make(n);
    const int frames = clips.record(view.clip).frames;
    CHECK(view.track.rows() == view.pose.rows());
    CHECK((view.track_seen.array() == 1.0F).all());
    // All of a shorter clip; the phase may leave the last frame out.
    const int want = std::min(40, frames);
    CHECK(view.pose.rows() >= want - 1);
    CHECK(view.pose.rows() <= want);
    Eigen::Index nearest = 0;
    if (view.clip == 0) (all.rowwise() - view.pose.row(0)).rowwise().norm().minCoeff(&nearest);
    firsts[view.clip].push_back(nearest);
  }
  CHECK(firsts.size() == 3);
  const auto [first, last] = std::ranges::minmax(firsts[0]);
  CHECK(first < 8);
  CHECK(last > 40);
  // With new poses and with what a detector loses they are others.
  bool unseen = false, other = false;
  const FreshViews changed = views(settings(), {.frames = 40});
  for (std::size_t n = 0; n < 20; ++n) {
    unseen = unseen || (changed.make(n).track_seen.array() == 0.0F).any();
    other = other || !same(changed.make(n), some.make(n));
  }
  CHECK(unseen);
  CHECK(other);
}

TEST_CASE("people and actions come as their frames to the power; one person may be left out") {
  const auto near = [](double got, double want) { return std::abs(got - want) < 0.06; };
  auto share = shares({.frames = 20, .groups_power = 1});
  CHECK(near(share[0], 90.0 / 180));
  CHECK(near(share[1], 30.0 / 180));
  CHECK(near(share[2], 60.0 / 180));
  share = shares({.frames = 20, .groups_power = 0});
  for (std::size_t clip = 0; clip < 3; ++clip) CHECK(near(share[clip], 1.0 / 3));
  share = shares({.frames = 20, .groups_power = 1, .people = {.without = 0, .only = {}}});
  CHECK(share.size() == 1);
  CHECK(share.count(2) == 1);
  share = shares({.frames = 20, .groups_power = 1, .people = {.without = {}, .only = 0}});
  CHECK(share.size() == 2);
  CHECK(near(share[0], 0.75));
}
