#include "corpus/people.hpp"

#include <doctest/doctest.h>

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
