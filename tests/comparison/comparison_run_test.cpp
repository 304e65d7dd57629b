#include "comparison/comparison_run.hpp"

#include <doctest/doctest.h>

namespace mcdbn {

TEST_CASE("person_of reads the person off a clip's name, where it tells") {
  CHECK(person_of("cmu/walk/08_01.bvh") == "08");
  CHECK(person_of("13_13or19.bvh") == "13");
  CHECK(person_of("motion/walk_s02_01.bvh") == "s02");
  CHECK(person_of("motion/jumping-jacks_s12_03.bvh") == "s12");
  CHECK(person_of("dataset-2_wave-both-hands_active_001.bvh").empty());
  CHECK(person_of("my_clip.bvh").empty());
}

}  // namespace mcdbn
