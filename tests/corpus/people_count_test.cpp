#include "corpus/people_count.hpp"

#include <doctest/doctest.h>

using namespace mcdbn;

TEST_CASE("people are told by their bones") {
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
