#include "motion/body_size.hpp"

#include <doctest/doctest.h>

#include "mcdbn/formats/bvh.hpp"
#include "motion/synthetic_motion.hpp"
#include "shared_data.hpp"

using namespace mcdbn;

TEST_CASE("body height comes from the legs, wherever the body stands and however it rests") {
  CHECK(body_height(test::small_body()) == doctest::Approx(83.5 / 0.491));
  CHECK(file_units_per_metre(test::small_body()) == doctest::Approx(83.5 / 0.491 / 1.7));
  // The still root's 400 units to the body are no bone.
  CHECK(body_height(test::small_body_below_still_root()) == doctest::Approx(83.5 / 0.491));
  Skeleton folded = test::small_body();
  for (Joint& joint : folded.joints) joint.offset = {joint.offset.norm(), 0, 0};
  CHECK(body_height(folded) == doctest::Approx(83.5 / 0.491));
}

TEST_CASE("a skeleton without a leg is as high as its rest pose, and a point has a finite unit") {
  Skeleton stick;
  stick.joints = {test::make_joint("Base", -1, {0, 0, 0}, {}),
                  test::make_joint("Tip", 0, {0, 0, 34}, {})};
  CHECK(body_height(stick) == doctest::Approx(34));
  CHECK(file_units_per_metre(stick) == doctest::Approx(20));
  stick.joints.pop_back();
  CHECK(file_units_per_metre(stick) == 1.0);
}

TEST_CASE("real skeletons have the heights of people") {
  struct Case {
    const char* file;
    double unit_cm;
  };
  for (const Case& c :
       {Case{"cmu/walk/02_01.bvh", 5.64}, Case{"cmu/walk/08_01.bvh", 5.64},
        Case{"cmu/walk/26_01.bvh", 5.64}, Case{"cmu/walk/32_01.bvh", 5.64},
        Case{"cmu/other/14_14.bvh", 5.64}, Case{"bvh_zoo/walk01.bvh", 1},
        Case{"bvh_zoo/bvh_test2.bvh", 1}, Case{"bvh_zoo/test_freebvh.bvh", 1},
        Case{"bandai/wave_both_hands/dataset-2_wave-both-hands_active_001.bvh", 1},
        Case{"bandai/wave_both_hands/dataset-2_wave-both-hands_normal_001.bvh", 1}}) {
    if (!test::have_shared_data(c.file, "heights of real skeletons")) continue;
    CAPTURE(c.file);
    const double height_cm =
        body_height(read_bvh(test::shared_data() / c.file).skeleton) * c.unit_cm;
    CHECK(height_cm > 155);
    CHECK(height_cm < 190);
  }
}
