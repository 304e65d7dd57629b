#include "corpus/people.hpp"

#include <doctest/doctest.h>

#include <string>

#include "mcdbn/formats/bvh.hpp"
#include "motion/synthetic_motion.hpp"
#include "shared_data.hpp"

using namespace mcdbn;

TEST_CASE("people are distinguished by their bones") {
  Motion tall;
  tall.skeleton.joints.resize(2);
  tall.skeleton.joints[1].offset = {0, 50, 0};
  Motion small = tall, turned = tall;
  small.skeleton.joints[1].offset = {0, 49, 0};
  turned.skeleton.joints[1].offset = {50, 0, 0};
  PeopleCount people;
  CHECK(people.number_of(tall.skeleton) == 0);
  CHECK(people.number_of(small.skeleton) == 1);
  CHECK(people.number_of(turned.skeleton) == 0);
  CHECK(people.number_of(tall.skeleton) == 0);
}

TEST_CASE("where a clip stands is no bone of the person") {
  for (const Skeleton& body : {test::small_body(), test::small_body_below_still_root()}) {
    CAPTURE(body.joints[0].name);
    const int hips = body.find("Hips");
    Skeleton elsewhere = body, longer = body;
    for (int j = 0; j <= hips; ++j)
      elsewhere.joints[static_cast<std::size_t>(j)].offset += Eigen::Vector3d(120, 0.5, -30);
    longer.joints[static_cast<std::size_t>(body.find("LShin"))].offset *= 1.01;
    PeopleCount people;
    CHECK(people.number_of(body) == 0);
    CHECK(people.number_of(elsewhere) == 0);
    CHECK(people.number_of(longer) == 1);
  }
  // The same person with a scene around.
  PeopleCount people;
  CHECK(people.number_of(test::small_body()) == 0);
  CHECK(people.number_of(test::small_body_below_still_root()) == 0);
}

TEST_CASE("Bandai's clips of set 1 are all on one body") {
  const std::string set = "bandai/set1/dataset-1_";
  if (!test::have_shared_data(set + "bow_active_001.bvh", "people in Bandai's clips")) return;
  PeopleCount people;
  for (const char* name : {"bow_active_001", "walk-back_normal_001", "dance-short_normal_001"}) {
    CAPTURE(name);
    CHECK(people.number_of(read_bvh(test::shared_data() / (set + name + ".bvh")).skeleton) == 0);
  }
}

TEST_CASE("a person is read off a clip's name, where it has one") {
  CHECK(person_of("cmu/walk/08_01.bvh") == "08");
  CHECK(person_of("13_13or19.bvh") == "13");
  CHECK(person_of("motion/walk_s02_01.bvh") == "s02");
  CHECK(person_of("motion/jumping-jacks_s12_03.bvh") == "s12");
  CHECK(person_of("dataset-2_wave-both-hands_active_001.bvh").empty());
  CHECK(person_of("my_clip.bvh").empty());
  CHECK(action_of("cmu/walk/08_01.bvh") == "walk");
  CHECK(action_of("motion/jumping-jacks_s12_03.bvh") == "jumping-jacks");
  CHECK(action_of("set1/dataset-1_bow_active_001.bvh") == "bow");
  CHECK(action_of("set2/dataset-2_raise-up-both-hands_happy_004.bvh") == "raise-up-both-hands");
}
