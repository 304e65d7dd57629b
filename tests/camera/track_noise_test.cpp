#include "camera/track_noise.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "camera/keypoint_track.hpp"
#include "camera/role_body.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/camera.hpp"
#include "motion/synthetic_motion.hpp"

namespace track_noise_test {

using namespace mcdbn;

namespace {

Track2d track_of(int frames) {
  const Motion motion = test::swinging(test::small_body(), frames);
  return project_motion(motion, place_camera(motion, {}));
}

bool same(const Track2d& a, const Track2d& b) {
  const auto equal = [](const MatrixD& x, const MatrixD& y) {
    return ((x.array() == y.array()) || (x.array().isNaN() && y.array().isNaN())).all();
  };
  return equal(a.x_px, b.x_px) && equal(a.y_px, b.y_px) && equal(a.confidence, b.confidence);
}

}  // namespace

TEST_CASE("joints go missing in the share that was asked for, the same for the same seed") {
  const Track2d whole = track_of(200);
  Track2d track = whole, again = whole, other = whole;
  drop_joints(track, 0.2, 7);
  drop_joints(again, 0.2, 7);
  drop_joints(other, 0.2, 8);
  CHECK(same(track, again));
  CHECK(!same(track, other));
  const auto missing = (track.confidence.array() == 0).eval();
  CHECK((missing == track.x_px.array().isNaN()).all());
  CHECK((missing == track.y_px.array().isNaN()).all());
  // 2800 joint-frames: five deviations of the binomial distribution.
  const double count = static_cast<double>(whole.x_px.size());
  CHECK(std::abs(static_cast<double>(missing.count()) - 0.2 * count) <
        5 * std::sqrt(count * 0.2 * 0.8));
  track = whole;
  drop_joints(track, 0, 7);
  CHECK(same(track, whole));
  drop_joints(track, 1, 7);
  CHECK(track.confidence.isZero());
  for (const double share : {-0.1, 1.1, std::nan("")}) {
    CHECK_THROWS_AS(drop_joints(track, share, 7), ConfigError);
  }
}

TEST_CASE("limbs are hidden with all that hangs from them, at most a third of the joints") {
  const Skeleton body = test::small_body();
  const Track2d whole = track_of(240);
  std::set<int> seen_hidden;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Track2d track = whole, again = whole;
    hide_limbs(track, body, seed);
    hide_limbs(again, body, seed);
    CHECK(same(track, again));
    const auto hidden = (track.confidence.array() == 0).eval();
    CHECK((hidden == track.x_px.array().isNaN()).all());
    CHECK((hidden || track.x_px.array() == whole.x_px.array()).all());
    CHECK(!hidden.col(track.find(body.joints[0].name)).any());
    for (int j = 1; j < body.joint_count(); ++j) {
      const int column = track.find(body.joints[j].name),
                above = track.find(body.joints[body.joints[j].parent].name);
      if (column < 0) continue;
      if (hidden.col(column).any()) seen_hidden.insert(j);
      // What hangs from a hidden joint is hidden, too.
      if (above >= 0) CHECK((!hidden.col(above) || hidden.col(column)).all());
    }
  }
  CHECK(seen_hidden.size() > 4);
}

TEST_CASE("an arm is hidden from the shoulder's child down, in the middle of the clip") {
  const Skeleton body = test::small_body();
  std::set<std::vector<std::string>> arms;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Track2d track = track_of(100);
    const std::vector<std::string> hidden = hide_arm(track, body, 1, seed);
    arms.insert(hidden);
    for (int joint = 0; joint < track.joint_count(); ++joint) {
      const bool of_arm =
          std::find(hidden.begin(), hidden.end(), track.joint_names[joint]) != hidden.end();
      CAPTURE(track.joint_names[joint]);
      CHECK((track.confidence.col(joint).array() == 0).count() == (of_arm ? 30 : 0));
      if (of_arm) CHECK(track.x_px.col(joint).segment(35, 30).array().isNaN().all());
    }
  }
  CHECK(arms == std::set<std::vector<std::string>>{{"LHand"}, {"RHand"}});
  Track2d track = track_of(10);
  CHECK(hide_arm(track, body, 5, 1).size() == 1);  // longer than the clip
  CHECK(hide_arm(track, body, 0, 1).empty());
  Skeleton chain;
  chain.joints = {test::make_joint("A", -1, {0, 0, 0}, {}),
                  test::make_joint("B", 0, {0, 1, 0}, {})};
  CHECK(hide_arm(track, chain, 1, 1).empty());
  CHECK_THROWS_AS(hide_arm(track, body, -1, 1), ConfigError);
  CHECK_THROWS_AS(hide_arm(track, body, std::nan(""), 1), ConfigError);
}

TEST_CASE("an arm of a detector's track is hidden by the roles of its keypoints") {
  const Motion motion = test::standing_still(test::role_body(), 60);
  const Camera camera = place_camera(motion, {});
  const Track2d whole = test::keypoint_track(motion, camera, test::coco_keypoints());
  std::set<std::vector<std::string>> arms;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Track2d track = whole;
    const std::vector<std::string> hidden = hide_arm(track, motion.skeleton, 1, seed);
    arms.insert(hidden);
    for (int column = 0; column < track.joint_count(); ++column) {
      const bool of_arm = std::ranges::count(hidden, track.joint_names[column]) > 0;
      CAPTURE(track.joint_names[column]);
      CHECK((track.confidence.col(column).array() == 0).count() == (of_arm ? 30 : 0));
      if (of_arm) CHECK(track.x_px.col(column).segment(15, 30).array().isNaN().all());
    }
  }
  CHECK(arms == std::set<std::vector<std::string>>{{"left_elbow", "left_wrist"},
                                                   {"right_elbow", "right_wrist"}});
  // A detector of knees alone.
  std::vector<Keypoint> knees;
  test::add_sides(knees, "knee", JointRole::left_knee);
  Track2d track = test::keypoint_track(motion, camera, knees);
  track.keypoints[1].role.reset();  // a place of which nothing is known
  CHECK(hide_arm(track, motion.skeleton, 1, 1).empty());
  CHECK_THROWS_AS(damage_track(track, motion.skeleton, {.hidden_s = 1}, 1), InputError);
  damage_track(track, motion.skeleton, {.noise_px = 1}, 1);
}

TEST_CASE("damage follows the seed, and none changes nothing") {
  const Skeleton body = test::small_body();
  const Track2d whole = track_of(60);
  const auto damaged = [&](const TrackDamage& damage, std::uint64_t seed) {
    Track2d track = whole;
    damage_track(track, body, damage, seed);
    return track;
  };
  CHECK(same(damaged({}, 1), whole));
  CHECK(same(damaged({2, 0.1, 0.5}, 1), damaged({2, 0.1, 0.5}, 1)));
  CHECK(!same(damaged({2, 0.1, 0.5}, 1), damaged({2, 0.1, 0.5}, 2)));
  // What one kind of damage does it does beside the others too.
  const Track2d noise = damaged({2, 0, 0}, 1), both = damaged({2, 0.1, 0}, 1);
  CHECK((both.x_px.array().isNaN() || both.x_px.array() == noise.x_px.array()).all());
}

}  // namespace track_noise_test
