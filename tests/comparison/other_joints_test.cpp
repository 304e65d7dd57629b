// Test clips whose joints stand in another order than the model's, or are more: an answer to a
// detector's track stands on the model's skeleton.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "comparison/clip_files.hpp"
#include "comparison/comparison_run.hpp"
#include "comparison/limb_keypoints.hpp"
#include "comparison/report_clips.hpp"
#include "device/every_device.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"

namespace other_joints_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// The same motion, its joints in that order. @param order indices of the joints, parents first
Motion reordered(const Motion& motion, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    place[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  Motion result{{}, motion.frame_time_s, MatrixD(motion.frames(), motion.channels.cols())};
  for (const int joint : order) {
    const int column = result.skeleton.channel_count();
    result.skeleton.joints.push_back(motion.skeleton.joints[static_cast<std::size_t>(joint)]);
    Joint& moved = result.skeleton.joints.back();
    if (moved.parent >= 0) moved.parent = place[static_cast<std::size_t>(moved.parent)];
    const auto channels = static_cast<Eigen::Index>(moved.channels.size());
    result.channels.middleCols(column, channels) =
        motion.channels.middleCols(motion.skeleton.first_channel(joint), channels);
  }
  return result;
}

/// The same motion with one joint more, below `parent` and right after `before`.
/// @param turns whether it has channels, by which it turns from frame to frame
Motion with_prop(const Motion& motion, const char* parent, const char* before, bool turns,
                 const Eigen::Vector3d& offset) {
  Motion result = motion;
  const int at = motion.skeleton.find(before) + 1;
  for (Joint& joint : result.skeleton.joints)
    if (joint.parent >= at) ++joint.parent;
  Joint prop = make_joint("Prop", motion.skeleton.find(parent), offset, {});
  if (turns) prop.channels = {z_rotation, x_rotation, y_rotation};
  prop.end_sites = {{0, -5, 0}};
  result.skeleton.joints.insert(result.skeleton.joints.begin() + at, prop);
  const int column = result.skeleton.first_channel(at);
  const auto more = static_cast<Eigen::Index>(prop.channels.size());
  result.channels = MatrixD(motion.frames(), motion.channels.cols() + more);
  const Eigen::Index rest = motion.channels.cols() - column;
  result.channels.leftCols(column) = motion.channels.leftCols(column);
  if (turns)
    result.channels.middleCols(column, more).colwise() =
        Eigen::VectorXd::LinSpaced(motion.frames(), 10, 100);
  result.channels.rightCols(rest) = motion.channels.rightCols(rest);
  return result;
}

/// The same motion with a joint above its root that does not move.
Motion below_world(Motion motion) {
  for (Joint& joint : motion.skeleton.joints) ++joint.parent;
  motion.skeleton.joints.insert(motion.skeleton.joints.begin(),
                                make_joint("World", -1, {0, 0, 0}, {}));
  return motion;
}

EncodedClip truth_of(const Motion& motion) {
  EncodedClip clip;
  clip.file = "clip.bvh";
  clip.motion = motion;
  clip.camera = place_camera(motion, {50, 20, std::nullopt, 45, 800, 600});
  clip.track = project_motion(motion, clip.camera);
  clip.root_position = path_of(motion, "Hips");
  return clip;
}

/// Its legs stand still, so that its feet are planted in every frame.
Motion standing(int frames) {
  Motion motion = swinging(small_body(), frames, 30,
                           {"LHip", "LLeg", "LShin", "LFoot", "RLeg", "RShin", "RFoot"});
  motion.channels.leftCols(6) = motion.channels.row(0).leftCols(6).replicate(frames, 1).eval();
  return motion;
}

/// Of small_body(): the right leg before the left one.
const std::vector<int> kLegsSwapped{0, 5, 6, 7, 1, 2, 3, 4, 8, 9, 10, 11, 12, 13};

void check_same(const ClipScore& score, const ClipScore& wanted) {
  for (const ScoreFigure& figure : score_figures()) {
    CAPTURE(figure.name);
    if (std::isnan(figure.of(wanted)))
      CHECK(std::isnan(figure.of(score)));
    else
      CHECK(figure.of(score) == doctest::Approx(figure.of(wanted)));
  }
  CHECK(score.foot_slide.planted == wanted.foot_slide.planted);
}

/// @return [frames x 3] of the point of that name
MatrixD point_of(const ReportClip& clip, const MatrixD& points, const std::string& name) {
  const auto found = std::ranges::find(clip.point_names, name);
  REQUIRE(found != clip.point_names.end());
  return points.middleCols(3 * (found - clip.point_names.begin()), 3);
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a clip's score: joints are matched by name, whatever their order") {
  const Motion truth = standing(40), answer = swinging(small_body(), 40);
  const ClipScore wanted = score_clip(truth_of(truth), answer, "Hips");
  CHECK(wanted.foot_slide.planted == 2 * 39);
  CHECK(wanted.foot_slide.regenerated_mm_s > 100);
  const Motion swapped = reordered(truth, kLegsSwapped), other = reordered(answer, kLegsSwapped);
  CHECK(joint_positions(swapped).middleCols(9, 3) == joint_positions(truth).middleCols(21, 3));
  check_same(score_clip(truth_of(swapped), answer, "Hips"), wanted);
  check_same(score_clip(truth_of(truth), other, "Hips"), wanted);
  check_same(score_clip(truth_of(swapped), other, "Hips"), wanted);
  // The root stands elsewhere among the joints, too.
  check_same(score_clip(truth_of(below_world(truth)), other, "Hips"), wanted);
}

TEST_CASE("a clip's score: joints that the answer lacks are not judged") {
  const Motion truth = standing(40), answer = swinging(small_body(), 40);
  const ClipScore wanted = score_clip(truth_of(truth), answer, "Hips");
  for (const bool turns : {false, true})
    for (const char* parent : {"LHand", "LFoot"}) {
      CAPTURE(turns);
      CAPTURE(parent);
      Motion more = with_prop(truth, parent, parent, turns, {0, -5, 0});
      check_same(score_clip(truth_of(more), answer, "Hips"), wanted);
      // As a foot it would be planted.
      more.skeleton.joints[static_cast<std::size_t>(more.skeleton.find("Prop"))].name = "LToe";
      check_same(score_clip(truth_of(more), answer, "Hips"), wanted);
    }
}

TEST_CASE("a report shows an answer's joints by name, and no end of a joint that it lacks") {
  const Motion motion = swinging(small_body(), 6);
  const Motion truth =
      with_prop(reordered(motion, kLegsSwapped), "RHand", "RHand", true, {0, -5, 0});
  // The answer is another motion, on the model's skeleton, in other units.
  Motion answer = standing(6);
  for (Joint& joint : answer.skeleton.joints) joint.offset *= 10;
  answer.channels.leftCols(3) *= 10;
  on_every_device([&](Device& device) {
    const Modalities modalities = modalities_of({motion}, {});
    const Model model{random_network(device, modalities), modalities, {}, {}};
    ClipResult result;
    result.truth = truth_of(truth);
    result.seen.joints = result.truth.track;
    result.samples = {{answer, {}}};
    const ReportClip clip = report_clips(model, {result}, false).at(0);
    CHECK(std::ranges::count(clip.point_names, "Prop end") == 0);
    const double mm = 1000.0 / file_units_per_metre(answer.skeleton),
                 true_mm = 1000.0 / file_units_per_metre(truth.skeleton);
    CHECK(true_mm == doctest::Approx(10 * mm));
    for (const char* name : {"Hips", "LLeg", "LFoot", "RLeg", "RFoot", "Chest", "LHand", "RHand"}) {
      CAPTURE(name);
      CHECK(largest(point_of(clip, clip.truth_mm, name) - true_mm * path_of(truth, name)) < 1e-6);
      CHECK(largest(point_of(clip, clip.samples[0].points_mm, name) - mm * path_of(answer, name)) <
            1e-6);
    }
    for (const MatrixD& points : {clip.truth_mm, clip.samples[0].points_mm}) {
      const MatrixD end = point_of(clip, points, "Neck end") - point_of(clip, points, "Neck");
      CHECK(largest(end.rowwise().norm().array() - 20 * true_mm) < 1e-6);
    }
    // An answer on the clip's own skeleton has them all.
    result.samples = {{truth, {}}};
    const ReportClip own = report_clips(model, {result}, false).at(0);
    CHECK(std::ranges::count(own.point_names, "Prop end") == 1);
    CHECK(largest(own.samples[0].points_mm - own.truth_mm) < 1e-9);
  });
}

namespace {

constexpr double kFps = 30;

/// On a skeleton that is not the canonical humanoid: clips are not brought onto another.
Motion walk(int subject) {
  SynthesisOptions options;
  options.subject = subject;
  options.seconds = 1.0;
  options.fps = kFps;
  return synthesize(options);
}

/// The legs, its last eight joints, the other way round.
Motion legs_swapped(const Motion& motion) {
  std::vector<int> order(motion.skeleton.joints.size());
  std::iota(order.begin(), order.end(), 0);
  std::rotate(order.end() - 8, order.end() - 4, order.end());
  return reordered(motion, order);
}

/// NaN, where a keypoint is not seen, in the same places.
bool alike(const MatrixD& a, const MatrixD& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         ((a - b).array().abs() < 1e-9 || (a.array().isNaN() && b.array().isNaN())).all();
}

struct Scene : ClipFiles {
  Scene()
      : ClipFiles({{"walk_s01_01.bvh", walk(1)}, {"walk_s02_01.bvh", walk(2)}},
                  {{"as_it_is.bvh", walk(3)},
                   {"legs_swapped.bvh", legs_swapped(walk(3))},
                   {"prop.bvh", with_prop(walk(3), "LeftHand", "LeftHand", true, {0, 0, 0})}},
                  {}) {}
};

}  // namespace

TEST_CASE("a detector's test run judges a clip alike, whatever the order of its joints and more") {
  const Scene scene;
  on_every_device([&](Device& device) {
    TestRunOptions options;
    options.baselines.clear();
    options.regeneration.run_in = 4;
    options.uncertainty_draws = {4, 7};
    // The clip's own body: others are drawn by the joints' order.
    options.detector = DetectorViews{limb_keypoints(), detectors().front().noise, {}, {0, 0}};
    const Model model = scene.model(device);
    // Each by itself: a clip's noise depends on its place in the run.
    const auto result_of = [&](std::size_t i) {
      return std::move(run_test(model, {scene.tests[i]}, options).at(0));
    };
    const ClipResult wanted = result_of(0);
    CHECK(wanted.samples.at(0).score.foot_slide.planted > 0);
    const ReportClip shown = report_clips(model, {wanted}, false).at(0);
    for (const std::size_t i : {1U, 2U}) {
      CAPTURE(scene.tests[i].filename().string());
      const ClipResult result = result_of(i);
      REQUIRE(alike(result.truth.track.x_px, wanted.truth.track.x_px));
      check_same(result.samples.at(0).score, wanted.samples.at(0).score);
      CHECK(result.joints.overall().all == wanted.joints.overall().all);
      CHECK(result.joints.overall().share() == doctest::Approx(wanted.joints.overall().share()));
      const ReportClip clip = report_clips(model, {result}, false).at(0);
      CHECK(clip.point_names.size() == shown.point_names.size());
      for (const std::string& name : shown.point_names) {
        CAPTURE(name);
        CHECK(largest(point_of(clip, clip.samples[0].points_mm, name) -
                      point_of(shown, shown.samples[0].points_mm, name)) < 1e-3);
      }
    }
  });
}

}  // namespace other_joints_test
