// Where limbs are seen again: which are followed depends on how long they were hidden.

#include "camera/limb_spells.hpp"

#include <doctest/doctest.h>

#include "camera/keypoint_track.hpp"

namespace limb_spells_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Two seconds of a detector that sees a whole person.
Track2d all_seen() {
  Track2d track;
  track.keypoints = coco_keypoints();
  for (const Keypoint& place : track.keypoints) track.joint_names.push_back(place.name);
  track.fps = 30;
  track.x_px = track.y_px = MatrixD::Zero(60, std::ssize(track.keypoints));
  track.confidence = MatrixD::Ones(60, std::ssize(track.keypoints));
  return track;
}

void hide(Track2d& track, const std::string& side, const std::vector<std::string>& places,
          int first, int count) {
  for (const std::string& place : places)
    track.confidence.col(track.find(side + "_" + place)).segment(first, count).setZero();
}

}  // namespace

TEST_CASE("limb spells: only limbs that are hidden for longer than joints are followed") {
  CHECK(limb_spells(all_seen()).empty());
  Track2d track = all_seen();
  for (const char* side : {"left", "right"}) hide(track, side, {"knee", "ankle"}, 20, 6);
  CHECK(limb_spells(track).empty());  // 0.2 s
  hide(track, "left", {"knee", "ankle"}, 20, 20);
  CHECK(limb_spells(track).empty());  // one leg
  hide(track, "right", {"knee", "ankle"}, 20, 7);
  const auto spells = limb_spells(track);
  REQUIRE(spells.size() == 2);
  CHECK(described(spells) == "legs swapped in frames 0-19, 27-59");
  // Hips, knees and ankles.
  for (const SideSwap& spell : spells) {
    REQUIRE(spell.left.size() == 3);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(track.keypoints[spell.right[k]].role ==
            other_side(*track.keypoints[spell.left[k]].role));
  }
}

TEST_CASE("limb spells: arms and legs by themselves, the clip's ends are none") {
  Track2d track = all_seen();
  for (const char* side : {"left", "right"}) {
    hide(track, side, {"knee", "ankle"}, 0, 15);
    hide(track, side, {"elbow", "wrist"}, 10, 10);
    hide(track, side, {"elbow", "wrist"}, 30, 10);
  }
  CHECK(described(limb_spells(track)) == "arms swapped in frames 0-9, 20-29, 40-59");
  track.keypoints.clear();
  CHECK(limb_spells(track).empty());
}

}  // namespace limb_spells_test
