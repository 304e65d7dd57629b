#include "comparison/known_people.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "comparison/clip_files.hpp"
#include "comparison/comparison_run.hpp"
#include "device/every_device.hpp"
#include "mcdbn/base/errors.hpp"

namespace known_people_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A clip of the small body, so much larger.
std::filesystem::path write(const ScratchFolder& folder, const std::string& name, double larger) {
  Motion motion = swinging(small_body(), 2);
  for (Joint& joint : motion.skeleton.joints) joint.offset *= larger;
  write_bvh(folder / name, motion);
  return folder / name;
}

TrainingClip training_clip(const std::filesystem::path& path, const std::string& person = {}) {
  return {.path = path.string(), .fingerprint = {}, .former_fingerprint = {}, .person = person};
}

}  // namespace

TEST_CASE("people who were trained on are known by their bones, whatever the names") {
  const ScratchFolder folder;
  KnownPeople people({training_clip(write(folder, "take.bvh", 1)),
                      training_clip(write(folder, "walk_s02_01.bvh", 1.1)),
                      training_clip(write(folder, "third.bvh", 1.2), "ann")});
  CHECK(people.find(write(folder, "a.bvh", 1)) == "take.bvh");
  CHECK(people.find(write(folder, "b.bvh", 1.1001)) == "s02");
  CHECK(people.find(write(folder, "c.bvh", 1.2)) == "ann");
  const auto other = write(folder, "walk_s02_09.bvh", 1.3);
  CHECK(people.find(other) == "");
  CHECK(people.find(other) == "");  // none of the test clips counts as trained on
  CHECK_THROWS_AS(people.find(folder / "absent.bvh"), InputError);
}

TEST_CASE("where training clips are gone people are known by names, or it is not known") {
  const ScratchFolder folder;
  const auto still_there = write(folder, "08_01.bvh", 1);
  for (const auto& gone : {folder / "gone.bvh", folder.write("spoilt.bvh", "no motion")}) {
    CAPTURE(gone.string());
    KnownPeople people({training_clip(still_there), training_clip(gone, "s07")});
    CHECK(people.find("08_02.bvh") == "08");
    CHECK(people.find("walk_s07_02.bvh") == "s07");
    CHECK(people.find("09_01.bvh") == "");
    CHECK_FALSE(people.find("take.bvh").has_value());
  }
}

TEST_CASE("a test run tells of each clip whether its person was trained on") {
  const ClipFiles scene(
      {{"08_01.bvh", paced_clip(14, 1)}, {"walk_s02_01.bvh", paced_clip(9, 1.4)}},
      {{"take.bvh", paced_clip(12, 0.9)}, {"jump_s02_07.bvh", paced_clip(9, 1.1)}},
      {35, 12, std::nullopt, 45, 1920, 1080});
  Motion stranger = paced_clip(12, 0.8);
  for (Joint& joint : stranger.skeleton.joints) joint.offset *= 1.01;
  const auto other = scene.write("08_77.bvh", stranger);
  TestRunOptions options;
  options.camera = scene.model_view;
  options.baselines.clear();
  options.fit.reset();
  on_every_device([&](Device& device) {
    Model model = scene.model(device);
    const auto by_bones = run_test(model, {scene.tests[0], other}, options);
    CHECK(by_bones[0].known_person == "08");
    CHECK(by_bones[1].known_person == "");
    model.training_clips[1].path = (scene.folder / "gone_s02_01.bvh").string();
    const auto by_names = run_test(model, {scene.tests[0], other, scene.tests[1]}, options);
    CHECK_FALSE(by_names[0].known_person.has_value());
    CHECK(by_names[1].known_person == "08");
    CHECK(by_names[2].known_person == "s02");
  });
}

}  // namespace known_people_test
