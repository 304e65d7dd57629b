#include "mcdbn/corpus/training_clips.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "base/scratch_folder.hpp"
#include "corpus/augmented_views.hpp"
#include "corpus/encoded_clip.hpp"
#include "corpus/training_files.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/motion/humanoid_rig.hpp"
#include "motion/humanoid_motion.hpp"
#include "motion/synthetic_motion.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Two of synthesized walking and one whose joints are called otherwise.
struct MixedFiles {
  ScratchFolder folder;
  TrainingFiles walks{{{1, 1}, {2, 1}}};
  std::filesystem::path other = folder / "other.bvh";

  MixedFiles() { write_bvh(other, moving_humanoid(40)); }
  std::vector<ListedClip> all() const { return {walks.files()[0], walks.files()[1], other}; }
};

}  // namespace

TEST_CASE("training clips: a skeleton that all share is learnt as it is") {
  const MixedFiles files;
  const std::vector<ListedClip> alike{files.walks.files()[0], files.walks.files()[1]};
  const auto clips = load_training_clips(alike, {});
  const auto plain = load_clips(files.walks.files());
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(clips[i].motion.channels == plain[i].motion.channels);
    CHECK(clips[i].clip.path == plain[i].clip.path);
    CHECK(clips[i].clip.person.empty());
  }
  CorpusSettings own;
  own.skeleton = SkeletonUse::own;
  CHECK(load_training_clips(alike, own)[0].motion.channels == plain[0].motion.channels);
  own.augment.leaning = 0.1;
  CHECK_THROWS_AS(load_training_clips(alike, own), ConfigError);
}

TEST_CASE("training clips: skeletons that differ are brought onto the humanoid, with a notice") {
  const MixedFiles files;
  std::vector<std::string> notices;
  const auto clips = load_training_clips(files.all(), {}, &notices);
  for (const LoadedClip& clip : clips) CHECK(is_humanoid(clip.motion.skeleton));
  const Motion raw = load_clips(files.walks.files())[0].motion;
  CHECK(clips[0].motion.channels == HumanoidRig(raw).to_humanoid(raw).channels);
  CHECK(clips[0].clip.person != clips[1].clip.person);
  REQUIRE(notices.size() == 2);
  CHECK(notices[0].find(files.other.string() + " lacks the joint") != std::string::npos);
  CHECK(notices[1].find("2 clips brought onto the canonical humanoid") == 0);
  CHECK(notices[1].find("degrees") != std::string::npos);
  // The same where it is asked for, or where new poses are.
  CorpusSettings settings;
  settings.skeleton = SkeletonUse::humanoid;
  CHECK(is_humanoid(load_training_clips({files.walks.files()[0]}, settings)[0].motion.skeleton));
  settings.skeleton = SkeletonUse::shared;
  settings.augment.limbs_turned = 0.2;
  CHECK(is_humanoid(load_training_clips({files.walks.files()[0]}, settings)[0].motion.skeleton));
}

TEST_CASE("training clips: what cannot be learnt is refused by its file") {
  const MixedFiles files;
  CorpusSettings own;
  own.skeleton = SkeletonUse::own;
  CHECK_THROWS_WITH_AS(load_training_clips(files.all(), own),
                       doctest::Contains((files.other.string() + " lacks the joint").c_str()),
                       InputError);
  const std::filesystem::path stick = files.folder / "stick.bvh";
  write_bvh(stick, swinging(small_body(), 5));
  CHECK_THROWS_WITH_AS(load_training_clips({files.walks.files()[0], stick}, {}),
                       doctest::Contains((stick.string() + ": no joint is known to be").c_str()),
                       InputError);
}

TEST_CASE("training clips: names of a joint map that no clip has are reported, others not") {
  const MixedFiles files;
  CorpusSettings settings;
  settings.joint_map = {{JointRole::head, "Neck"}, {JointRole::left_knee, "LeftLeggg"}};
  std::vector<std::string> notices;
  load_training_clips(files.all(), settings, &notices);
  const auto are_of_map = [](const std::string& notice) {
    return notice.find("joint map") != std::string::npos;
  };
  CHECK(std::ranges::count_if(notices, are_of_map) == 1);
  CHECK(std::ranges::count(notices,
                           "the joint map's left_knee is 'LeftLeggg', and no clip has a joint of "
                           "that name") == 1);
}

TEST_CASE("training clips: people are those that are given, else those of the bones") {
  const MixedFiles files;
  const auto people = [&](const std::vector<ListedClip>& listed, SkeletonUse use) {
    CorpusSettings settings;
    settings.skeleton = use;
    settings.augment.views = 1;
    const auto clips = load_training_clips(listed, settings);
    const TrainingSet set = make_training_set(clips, settings, 1, false);
    return make_augmented_views(clips, set.modalities, settings, 1).people;
  };
  const auto& walks = files.walks.files();
  using People = std::vector<std::size_t>;
  for (const SkeletonUse use : {SkeletonUse::shared, SkeletonUse::humanoid}) {
    CHECK(people({walks[0], walks[1]}, use) == People{0, 1});
    CHECK(people({{walks[0], "ann"}, {walks[1], "ann"}}, use) == People{0, 0});
  }
}

TEST_CASE("training clips: windows are drawn by people, and by actions where those are given") {
  const TrainingFiles walks({{1, 1}, {1, 2}, {2, 1}});
  const auto& files = walks.files();
  const auto groups = [&](const std::vector<ListedClip>& listed) {
    CorpusSettings settings;
    settings.augment.views = 2;
    const auto clips = load_training_clips(listed, settings);
    const TrainingSet set = make_training_set(clips, settings, 1, false);
    return make_augmented_views(clips, set.modalities, settings, 1).groups;
  };
  using Groups = std::vector<std::size_t>;
  CHECK(groups({files[0], files[1], files[2]}).empty());
  CHECK(groups({{files[0], "", "walk"}, {files[1], "", "stroll"}, {files[2], "", "walk"}}) ==
        Groups{0, 0, 1, 1, 2, 2});
  CHECK(groups({{files[0], "", "walk"}, {files[1], "", "walk"}, files[2]}) ==
        Groups{0, 0, 0, 0, 1, 1});
}

TEST_CASE("a test clip of the humanoid's model takes a joint map, and its error names the file") {
  const MixedFiles files;
  const TrainingSet set = make_training_set(load_training_clips(files.all(), {}), {}, 1, false);
  Motion unknown = load_clip(files.walks.files()[0], {.fps = 0});
  for (Joint& joint : unknown.skeleton.joints)
    if (joint.name == "LeftLeg") joint.name = "spam";
  const std::filesystem::path file = files.folder / "unknown.bvh";
  write_bvh(file, unknown);
  CHECK_THROWS_WITH_AS(encode_clip(file, set.modalities, {}),
                       doctest::Contains((file.string() + ": no joint is known to be").c_str()),
                       InputError);
  const EncodedClip mapped =
      encode_clip(file, set.modalities, {}, false, nullptr, {{JointRole::left_knee, "spam"}});
  const EncodedClip named = encode_clip(files.walks.files()[0], set.modalities, {});
  CHECK(mapped.pose_features == named.pose_features);
}

TEST_CASE("a model of the humanoid takes any skeleton's clips") {
  const MixedFiles files;
  const auto clips = load_training_clips(files.all(), {});
  const TrainingSet set = make_training_set(clips, {}, 1, false);
  const EncodedClip encoded = encode_clip(files.walks.files()[0], set.modalities, {});
  CHECK(is_humanoid(encoded.motion.skeleton));
  // Resampled before or after, it is the same pose.
  CHECK(encoded.pose_features.rows() == set.poses[0].rows());
  const Motion own = swinging(small_body(), 4);
  CHECK(for_skeleton(own, own.skeleton).channels == own.channels);
  CHECK_THROWS_AS(for_skeleton(own, canonical_humanoid()), InputError);
}
