#include "formats/person_choice.hpp"

#include <doctest/doctest.h>

using namespace mcdbn;

namespace person_choice_test {
namespace {

constexpr double kPatience = 45;

/// Four joints in a square of this size around x.
SeenPerson person_at(double x, double size_px, std::optional<long long> id = {}) {
  SeenPerson person;
  for (int joint = 0; joint < 4; ++joint) {
    person.x_px.push_back(x + (joint % 2 == 0 ? -0.5 : 0.5) * size_px);
    person.y_px.push_back(joint < 2 ? 0 : size_px);
    person.confidence.push_back(1);
  }
  person.id = id;
  return person;
}

}  // namespace

TEST_CASE("formats/a person is followed by the number, however far they went") {
  for (const bool number_first : {true, false}) {
    CAPTURE(number_first);
    PersonChoice choice("largest");
    REQUIRE(choice.choose({person_at(0, 100, 7)}, kPatience) == 0);
    // One without a number stands where the person was, the person is out of reach.
    std::vector<SeenPerson> people{person_at(2000, 100, 7), person_at(5, 100)};
    if (!number_first) std::swap(people[0], people[1]);
    CHECK(choice.choose(people, kPatience) == (number_first ? 0 : 1));
  }
}

TEST_CASE("formats/another number is another person; without numbers the nearest is followed") {
  PersonChoice numbered("largest");
  REQUIRE(numbered.choose({person_at(0, 100, 7)}, kPatience) == 0);
  CHECK(!numbered.choose({person_at(0, 100, 8)}, kPatience));
  CHECK(numbered.choose({person_at(0, 100, 8), person_at(9, 100), person_at(4, 100)}, kPatience) ==
        2);
  PersonChoice unnumbered("2");
  REQUIRE(unnumbered.choose({person_at(0, 90), person_at(500, 100)}, kPatience) == 0);
  CHECK(unnumbered.choose({person_at(490, 100), person_at(10, 90)}, kPatience) == 1);
  CHECK(!unnumbered.choose({person_at(490, 100)}, kPatience));
}

}  // namespace person_choice_test
