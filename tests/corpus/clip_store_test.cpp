// Clips in memory and in a mapped file, and the pieces that stand for many of them.
#include "mcdbn/corpus/clip_store.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "base/scratch_folder.hpp"
#include "corpus/clip_cache.hpp"
#include "corpus/clip_pieces.hpp"
#include "corpus/humanoid_clips.hpp"
#include "corpus/training_files.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/corpus/training_clips.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

bool same_skeleton(const Skeleton& x, const Skeleton& y) {
  return std::ranges::equal(x.joints, y.joints, [](const Joint& a, const Joint& b) {
    return a.name == b.name && a.parent == b.parent && a.offset == b.offset &&
           a.channels == b.channels && a.end_sites == b.end_sites;
  });
}

void check_same(const ClipStore& x, const ClipStore& y) {
  REQUIRE(x.count() == y.count());
  for (std::size_t i = 0; i < x.count(); ++i) {
    const ClipRecord &a = x.record(i), &b = y.record(i);
    CHECK(a.clip.path == b.clip.path);
    CHECK(a.clip.fingerprint == b.clip.fingerprint);
    CHECK(a.clip.former_fingerprint == b.clip.former_fingerprint);
    CHECK(a.clip.person == b.clip.person);
    CHECK(a.clip.action == b.clip.action);
    CHECK(a.frame_time_s == b.frame_time_s);
    CHECK(a.frames == b.frames);
    CHECK(same_skeleton(a.skeleton, b.skeleton));
    CHECK(x.motion(i).channels == y.motion(i).channels);
  }
}

std::vector<std::string> notices_of(const std::vector<ListedClip>& files,
                                    const CorpusSettings& settings,
                                    const std::filesystem::path& cache) {
  std::vector<std::string> notices;
  cached_training_clips(files, settings, cache, &notices);
  return notices;
}

}  // namespace

TEST_CASE("a store gives pieces of its clips") {
  const ClipStore store({humanoid_clip(10, 20, 0), humanoid_clip(60, 40, 120, 30)});
  CHECK(store.count() == 2);
  CHECK(store.record(1).frames == 30);
  const Motion whole = store.motion(1), piece = store.piece(1, 7, 5);
  CHECK(piece.channels == whole.channels.middleRows(7, 5));
  CHECK(piece.frame_time_s == whole.frame_time_s);
  CHECK(store.frames_at(15) == doctest::Approx(120 * whole.frame_time_s * 15));
}

TEST_CASE(
    "clips come back from a mapped file as they were, bit for bit, without being read again") {
  const TrainingFiles walks({{1, 1, 60.0}, {2, 1, 30.0}, {1, 2, 48.0}});
  const std::vector<ListedClip> files{
      {walks.files()[0], "somebody", "walk"}, {walks.files()[1]}, {walks.files()[2], "other"}};
  const ScratchFolder folder;
  for (const SkeletonUse use : {SkeletonUse::shared, SkeletonUse::humanoid}) {
    CorpusSettings settings;
    settings.skeleton = use;
    const auto cache = folder / fmt::format("{}.cache", static_cast<int>(use));
    const ClipStore in_memory = load_training_clips(files, settings);
    check_same(cached_training_clips(files, settings, cache), in_memory);
    const auto written = std::filesystem::last_write_time(cache);
    check_same(cached_training_clips(files, settings, cache), in_memory);
    CHECK(std::filesystem::last_write_time(cache) == written);
    CHECK(notices_of(files, settings, cache).empty());
  }
  CHECK(entries_of(folder / "").size() == 2);  // nothing is left beside them
}

TEST_CASE("all that is known of a clip comes back, the hash by which earlier models know it too") {
  const ScratchFolder folder;
  LoadedClip clip = humanoid_clip(10, 20, 0, 5);
  clip.clip = {"/walks/01.amc", "of amc and asf", "of the amc alone", "somebody", "walk"};
  ClipCacheWriter cache(folder / "clips.cache", "key");
  cache.add(clip);
  check_same(cache.finish(), ClipStore(std::vector<LoadedClip>{clip}));
}

TEST_CASE("a cache belongs to the joint map, the skeleton and the new poses of its training") {
  const TrainingFiles walks({{1, 1}});
  const std::vector<ListedClip> files{{walks.files()[0]}};
  const ScratchFolder folder;
  const auto cache = folder / "clips.cache";
  CorpusSettings settings;
  REQUIRE(notices_of(files, settings, cache).empty());
  const auto check_made_anew = [&] {
    const auto notices = notices_of(files, settings, cache);
    REQUIRE(!notices.empty());
    CHECK(notices.front().find("other clips or settings") != std::string::npos);
    CHECK(notices_of(files, settings, cache).empty());
  };
  settings.joint_map = {{JointRole::head, "Head"}};
  check_made_anew();
  settings.joint_map = {{JointRole::head, "Neck"}};
  check_made_anew();
  settings.skeleton = SkeletonUse::humanoid;
  check_made_anew();
  settings.augment.limbs_turned = 0.5;
  check_made_anew();
}

TEST_CASE("skeletons that differ go through the file onto the humanoid") {
  const TrainingFiles walks({{1, 1}, {2, 1}});
  const ScratchFolder folder;
  Motion renamed = load_clip(walks.files()[0], {.fps = 0});
  for (Joint& joint : renamed.skeleton.joints)
    if (joint.name == "Head") joint.name = "head";
  const auto other = folder / "other.bvh";
  write_bvh(other, renamed);
  const std::vector<ListedClip> files{{walks.files()[1]}, {other}};
  check_same(cached_training_clips(files, {}, folder / "clips.cache"),
             load_training_clips(files, {}));
}

TEST_CASE("clips that could not be brought onto the humanoid leave no file that looks complete") {
  const TrainingFiles walks({{1, 1}});
  const ScratchFolder folder, of_cache;
  const auto other = folder / "other.bvh";
  write_bvh(other, swinging(small_body(), 5));
  const auto cache = of_cache / "clips.cache";
  // They are read first as they are, and then the second is no person.
  const std::vector<ListedClip> files{{walks.files()[0]}, {other}};
  for (int again = 0; again < 2; ++again)
    CHECK_THROWS_WITH_AS(cached_training_clips(files, {}, cache),
                         doctest::Contains("no joint is known to be"), InputError);
  CHECK(entries_of(of_cache / "").empty());
}

TEST_CASE("a cache of other settings, other clips or other bytes is reported and made anew") {
  const TrainingFiles walks({{1, 1}, {2, 1}});
  const ScratchFolder folder;
  const auto cache = folder / "clips.cache";
  const auto copy = folder / "walk.bvh";
  std::filesystem::copy_file(walks.files()[0], copy);
  const std::vector<ListedClip> files{{copy}, {walks.files()[1]}};
  CorpusSettings settings;
  REQUIRE(notices_of(files, settings, cache).empty());
  const auto check_made_anew = [&](const std::string& why) {
    CAPTURE(why);
    const auto notices = notices_of(files, settings, cache);
    REQUIRE(!notices.empty());
    CHECK(notices.front().find(why) != std::string::npos);
    CHECK(notices.front().find("read again") != std::string::npos);
    CHECK(notices_of(files, settings, cache).empty());
    check_same(cached_training_clips(files, settings, cache), load_training_clips(files, settings));
  };
  settings.keep_first_frame = true;
  check_made_anew("other clips or settings");
  std::filesystem::copy_file(walks.files()[1], copy,
                             std::filesystem::copy_options::overwrite_existing);
  check_made_anew("has changed since");

  const auto size = static_cast<long>(std::filesystem::file_size(cache));
  // A number of the first clip and of the last, the words behind them, the very end.
  for (const long at : {9L, size / 2, size - 60, size - 3}) {
    CAPTURE(at);
    std::fstream file(cache, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(at);
    const char was = static_cast<char>(file.get());
    file.seekp(at);
    file.put(static_cast<char>(was ^ 1));
    file.close();
    check_made_anew("damaged");
  }
  for (const auto shorter : {size - 1, 20L, 0L}) {
    std::filesystem::resize_file(cache, static_cast<std::uintmax_t>(shorter));
    check_made_anew("damaged");
  }
  CHECK_THROWS_AS(open_clip_cache(folder / "absent", ""), InputError);
  CHECK_THROWS_AS(cached_training_clips(files, settings, folder / "absent" / "c"), InputError);
}

TEST_CASE("few clips are looked at whole, of many pieces all along them") {
  const auto clip = [](int frames) {
    return ClipRecord{{}, {}, 1.0 / 60.0, frames};  // two a frame of the model
  };
  const auto store = [](std::vector<ClipRecord> records) {
    return ClipStore(std::move(records), nullptr);
  };
  const auto whole = pieces_in_memory(store({clip(200'000), clip(40), clip(199'960)}), 30);
  REQUIRE(whole.size() == 3);
  CHECK(whole[2].frames == 199'960);
  CHECK(whole[2].first == 0);

  const ClipStore many = store({clip(400'000), clip(40), clip(1'600'000), clip(40)});
  const auto pieces = pieces_in_memory(many, 30);
  REQUIRE(pieces.size() == 400);
  double of_third = 0, sum = 0;
  for (const ClipPiece& piece : pieces) {
    CHECK(piece.frames == std::min(300, many.record(piece.clip).frames));
    CHECK(piece.first >= 0);
    CHECK(piece.first + piece.frames <= many.record(piece.clip).frames);
    if (piece.clip != 2) continue;
    ++of_third;
    sum += piece.first + 0.5 * piece.frames;
  }
  CHECK(of_third == 320);
  CHECK(std::abs(sum / of_third - 800'000) < 2'500);
}
