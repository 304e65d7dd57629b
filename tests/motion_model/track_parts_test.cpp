// Long tracks are regenerated in parts that overlap.

#include "motion_model/track_parts.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "base/numbers.hpp"
#include "camera/show_only.hpp"
#include "features/clip_modalities.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion_model/recent_track.hpp"
#include "motion_model/several_answers.hpp"

namespace track_parts_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Two joints that every frame shows.
Track2d shown(int frames, double fps) {
  Track2d track;
  track.joint_names = {"a", "b"};
  track.fps = fps;
  for (MatrixD* values : {&track.x_px, &track.y_px, &track.confidence})
    *values = MatrixD::Ones(frames, 2);
  return track;
}

/// A walk in slow motion, a frame a second: it is two parts long, and quickly fitted. The walker
/// turns round and round, so that angles grow beyond 180 degrees.
struct SlowWalk {
  static constexpr int kFrames = 340, kFirstEnd = 302, kSecond = 298;
  static constexpr double kTurn_deg = 2;  ///< from frame to frame

  Motion clip = walk();
  Modalities modalities = modalities_of({clip}, {});
  Camera camera = place_camera(clip, {});
  Track2d track = project_motion(clip, camera);
  MatrixF pose = modalities.encode_pose(clip, camera.camera_from_world);

  static Motion walk() {
    Motion motion = synthesize({.seconds = (kFrames + 1) / 30.0});
    motion.channels.conservativeResize(kFrames, Eigen::NoChange);
    motion.frame_time_s = 1;
    const Joint& root = motion.skeleton.joints[0];
    for (int t = 0; t < kFrames; ++t) {
      double* const channels = motion.channels.row(t).data();
      const Eigen::AngleAxisd turn(t * kTurn_deg * kRadiansPerDegree, Eigen::Vector3d::UnitY());
      set_local_rotation(root, turn * local_rotation(root, channels),
                         t > 0 ? motion.channels.row(t - 1).data() : nullptr, channels);
    }
    return motion;
  }
  /// What is likely beforehand is what is true, or a little off.
  std::vector<Motion> regenerated(const Track2d& of, const ClipPlacement& placement,
                                  TrackFindings* findings = nullptr) const {
    const auto single = [&](const MatrixF& features) -> PosePrior {
      return features.rows() < kFirstEnd ? MatrixF(pose.bottomRows(features.rows()))
                                         : MatrixF(pose.topRows(features.rows()));
    };
    return regenerate_clip(modalities, of, placement, single, several(single, 2), findings);
  }
};

/// The farthest that a joint is from where it is in the other, centimetres.
double apart_cm(const Motion& one, const Motion& other) {
  return (joint_positions(one) - joint_positions(other)).cwiseAbs().maxCoeff();
}

Motion frames_of(Motion motion, int first, int count) {
  motion.channels = MatrixD(motion.channels.middleRows(first, count));
  return motion;
}

}  // namespace

TEST_CASE("track parts: five minutes and what they share with their neighbours") {
  const auto is = [](const TrackPart& part, const FrameRange& range, int shared) {
    CHECK(part.range.first == range.first);
    CHECK(part.range.frames == range.frames);
    CHECK(part.shared == shared);
  };
  const Track2d track = shown(25'000, 30);
  const auto parts = parts_of(track, {1'000, 24'000});
  REQUIRE(parts.size() == 3);
  is(parts[0], {1'000, 9'060}, 0);
  is(parts[1], {9'940, 9'120}, 120);
  is(parts[2], {18'940, 6'060}, 120);
  REQUIRE(parts_of(track, {0, 9'060}).size() ==
          1);  // what is left over is not longer than a margin
  is(parts_of(track, {0, 9'060})[0], {0, 9'060}, 0);
  is(parts_of(track, {0, 9'061}).at(1), {8'940, 121}, 120);
  REQUIRE(parts_of(track, {7, 1}).size() == 1);
  is(parts_of(track, {7, 1})[0], {7, 1}, 0);
  // A part is never of no frames, however slow a track is.
  CHECK(parts_of(shown(100, 0.001), {0, 100}).size() == 100);
  CHECK(parts[1].share(0) == doctest::Approx(1.0 / 121));
  CHECK(parts[1].share(119) == doctest::Approx(120.0 / 121));
  CHECK(parts[1].share(120) == 1);
  CHECK(parts[0].share(0) == 1);
}

TEST_CASE("track parts: where no person is seen a part is one with its neighbour") {
  const auto sizes = [](const Track2d& track) {
    std::vector<int> frames;
    for (const TrackPart& part : parts_of(track, {0, track.frames()}))
      frames.push_back(part.range.frames);
    return frames;
  };
  Track2d track = shown(1'500, 1);
  CHECK(sizes(track) == std::vector<int>{302, 304, 304, 304, 302});
  track.confidence.middleRows(600, 300).setZero();
  CHECK(sizes(track) == std::vector<int>{302, 604, 304, 302});
  track.confidence(700, 1) = 0.1;  // half of the joints, once
  CHECK(sizes(track) == std::vector<int>{302, 304, 304, 304, 302});
  track.confidence.topRows(300).setZero();
  CHECK(sizes(track) == std::vector<int>{602, 304, 304, 302});
  track.confidence.setZero();
  CHECK(sizes(track) == std::vector<int>{1'500});
  // What a detector never sees does not make its frames empty.
  Track2d upper = shown(1'500, 1);
  for (const char* never : {"c", "d", "e"}) upper.joint_names.emplace_back(never);
  for (MatrixD* values : {&upper.x_px, &upper.y_px, &upper.confidence}) {
    values->conservativeResize(Eigen::NoChange, 5);
    values->rightCols(3).setZero();
  }
  CHECK(sizes(upper) == std::vector<int>{302, 304, 304, 304, 302});
}

TEST_CASE("track parts: each is as if it were alone, and fades into the next") {
  const SlowWalk scene;
  ClipPlacement known{{scene.camera, scene.clip.skeleton}};
  known.uncertainty_draws.count = 2;
  TrackFindings found, of_first, of_second;
  const auto got = scene.regenerated(scene.track, known, &found);
  const auto part = [&](int first, int frames, TrackFindings& findings) {
    return scene.regenerated(some_frames(scene.track, first, frames), known, &findings);
  };
  const auto before = part(0, SlowWalk::kFirstEnd, of_first);
  const int rest = SlowWalk::kFrames - SlowWalk::kFirstEnd, shared = 4;
  const auto after = part(SlowWalk::kSecond, shared + rest, of_second);
  REQUIRE(got.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(got[i].channels.topRows(SlowWalk::kSecond) ==
          before[i].channels.topRows(SlowWalk::kSecond));
    CHECK(apart_cm(frames_of(got[i], SlowWalk::kFirstEnd, rest),
                   frames_of(after[i], shared, rest)) < 1e-9);
    // In the middle of what they share, the middle of both: nearer to each than they are.
    const auto middle = [&](const Motion& motion, int first) {
      return frames_of(motion, SlowWalk::kSecond + 1 - first, 2);
    };
    const double both = apart_cm(middle(before[i], 0), middle(after[i], SlowWalk::kSecond));
    REQUIRE(both > 1e-6);
    CHECK(apart_cm(middle(got[i], 0), middle(before[i], 0)) < both);
    CHECK(apart_cm(middle(got[i], 0), middle(after[i], SlowWalk::kSecond)) < both);
    const MatrixD steps = got[i].channels.bottomRows(SlowWalk::kFrames - 1) -
                          got[i].channels.topRows(SlowWalk::kFrames - 1);
    CHECK(steps.cwiseAbs().maxCoeff() < 180);
  }
  REQUIRE(found.uncertainty.rows() == SlowWalk::kFrames);
  CHECK(found.uncertainty.topRows(SlowWalk::kSecond) ==
        of_first.uncertainty.topRows(SlowWalk::kSecond));
  CHECK(found.uncertainty.bottomRows(rest) == of_second.uncertainty.bottomRows(rest));
  for (int t = 0; t < shared; ++t) {
    const double share = (t + 1.0) / (shared + 1.0);
    CHECK(found.uncertainty.row(SlowWalk::kSecond + t)
              .isApprox((1 - share) * of_first.uncertainty.row(SlowWalk::kSecond + t) +
                        share * of_second.uncertainty.row(t)));
  }
}

TEST_CASE("track parts: they have the body and the camera of the one that shows most of a body") {
  const SlowWalk scene;
  constexpr int kSeen = 20, kLast = SlowWalk::kFrames - SlowWalk::kSecond,
                kRest = SlowWalk::kFrames - SlowWalk::kFirstEnd;
  Track2d late = scene.track;
  show_only(late, kSeen, SlowWalk::kSecond - kSeen, {});
  TrackFindings found, of_last;
  const auto got = scene.regenerated(late, {}, &found);
  REQUIRE(found.stretches.stretches == std::vector<FrameRange>{{0, SlowWalk::kFrames}});
  const auto last = scene.regenerated(some_frames(late, SlowWalk::kSecond, kLast), {}, &of_last);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(apart_cm(frames_of(got[i], SlowWalk::kFirstEnd, kRest),
                   frames_of(last[i], kLast - kRest, kRest)) < 1e-9);
    for (std::size_t joint = 0; joint < got[i].skeleton.joints.size(); ++joint)
      CHECK(got[i].skeleton.joints[joint].offset == last[i].skeleton.joints[joint].offset);
  }
  CHECK(found.camera.fx_px == of_last.camera.fx_px);
  CHECK(found.camera.translation == of_last.camera.translation);
}

TEST_CASE("track parts: where all show a body, its camera and body are those of the longest") {
  const SlowWalk scene;
  TrackFindings found, of_first;
  const auto got = scene.regenerated(scene.track, {}, &found);
  const auto first =
      scene.regenerated(some_frames(scene.track, 0, SlowWalk::kFirstEnd), {}, &of_first);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(got[i].channels.topRows(SlowWalk::kSecond) ==
          first[i].channels.topRows(SlowWalk::kSecond));
    for (std::size_t joint = 0; joint < got[i].skeleton.joints.size(); ++joint)
      CHECK(got[i].skeleton.joints[joint].offset == first[i].skeleton.joints[joint].offset);
  }
  CHECK(found.camera.fx_px == of_first.camera.fx_px);
  CHECK(found.camera.translation == of_first.camera.translation);
  const Track2d seen = project_motion(got[0], found.camera);
  const double limit_px = 0.1 * scene.track.height_px;
  CHECK((seen.x_px - scene.track.x_px).cwiseAbs().maxCoeff() < limit_px);
  CHECK((seen.y_px - scene.track.y_px).cwiseAbs().maxCoeff() < limit_px);
}

}  // namespace track_parts_test
