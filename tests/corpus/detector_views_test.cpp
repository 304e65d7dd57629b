// Training views as a detector sees them.
#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "corpus/no_augmentation.hpp"
#include "mcdbn/corpus/augmentation.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"

namespace detector_views_test {

using namespace mcdbn;
using test::nothing;

namespace {

constexpr double kFps = 30;

const Motion& walk() {
  static const Motion motion = synthesize({.fps = kFps, .seconds = 1.5});
  return motion;
}

AugmentedView view_of(double share, std::uint32_t step, bool hide_no_limb = false) {
  AugmentationSettings settings = nothing();
  settings.detector = share;
  return augmented_view(walk(), kFps, {}, settings, RandomKey{3, step, 0, 0}, hide_no_limb);
}

/// All of a skeleton's joints: no detector shows these.
bool is_exact(const AugmentedView& view) {
  return view.track.joint_count() == view.motion.skeleton.joint_count();
}

Eigen::Vector3d centre(const Camera& camera) {
  return -camera.camera_from_world.transpose() * camera.translation;
}

/// Pixels between the joints of the track that are seen, or one of them, and the true ones, sorted.
std::vector<double> distances_px(const AugmentedView& view, const std::string& only = {}) {
  const Track2d exact = project_motion(view.motion, view.camera);
  std::vector<double> distances;
  for (int joint = 0; joint < view.track.joint_count(); ++joint) {
    if (!only.empty() && view.track.joint_names[static_cast<std::size_t>(joint)] != only) continue;
    const int there = exact.find(view.track.joint_names[static_cast<std::size_t>(joint)]);
    REQUIRE(there >= 0);
    for (int frame = 0; frame < view.track.frames(); ++frame)
      if (view.track.confidence(frame, joint) > 0)
        distances.push_back(std::hypot(view.track.x_px(frame, joint) - exact.x_px(frame, there),
                                       view.track.y_px(frame, joint) - exact.y_px(frame, there)));
  }
  std::ranges::sort(distances);
  return distances;
}

/// The body's height on the image where it stands in the middle of the clip.
double height_px(const AugmentedView& view) {
  const Eigen::Vector3d root = joint_positions(view.motion).row(20).head<3>().transpose();
  const double depth = (view.camera.camera_from_world * root + view.camera.translation).z();
  return view.camera.fy_px * body_height(view.motion.skeleton) / depth;
}

}  // namespace

TEST_CASE("detector views: the share that was asked for, the same for the same key") {
  int detected = 0;
  for (std::uint32_t step = 0; step < 200; ++step) detected += is_exact(view_of(0.3, step)) ? 0 : 1;
  CHECK(detected > 40);
  CHECK(detected < 80);
  for (std::uint32_t step = 0; step < 20; ++step) {
    CHECK(is_exact(view_of(0, step)));
    CHECK_FALSE(is_exact(view_of(1, step)));
  }
  const AugmentedView view = view_of(1, 7), again = view_of(1, 7);
  CHECK(view.track.confidence == again.track.confidence);
  CHECK(view.camera.translation == again.camera.translation);
  CHECK(view.motion.channels == again.motion.channels);
}

TEST_CASE("detector views: every detector comes, through cameras from all around") {
  int with_feet = 0, with_head_alone = 0, behind = 0, left = 0;
  std::set<double> heights;
  constexpr int kViews = 60;
  for (std::uint32_t step = 0; step < kViews; ++step) {
    const AugmentedView view = view_of(1, step);
    CHECK(view.track.frames() == view.motion.frames());
    // OpenPose and MediaPipe show feet, COCO none; OpenPose alone loses joints for longer.
    const bool feet = view.track.find("LeftToeBase") >= 0;
    (feet ? with_feet : with_head_alone) += 1;
    if (!feet) {  // RTMPose loses no joint and is surer than OpenPose: 0.85, hidden 0.73
      CHECK((view.track.confidence.array() > 0).all());
      CHECK(view.track.confidence.mean() > 0.75);
    }
    const Eigen::Vector3d at =
        centre(view.camera) -
        joint_positions(view.motion).row(view.motion.frames() / 2).head<3>().transpose();
    behind += at.z() < 0 ? 1 : 0;
    left += at.x() > 0 ? 1 : 0;
    heights.insert(at.y());
  }
  CHECK(with_feet > kViews / 2);
  CHECK(with_head_alone > kViews / 8);
  for (const int side : {behind, left}) {
    CHECK(side > kViews / 4);
    CHECK(side < 3 * kViews / 4);
  }
  CHECK(heights.size() == kViews);
}

TEST_CASE("detector views: joints are off as a detector's are, no more, and not all are seen") {
  int unseen = 0;
  double head_off = 0;
  std::set<double> confidences;
  for (std::uint32_t step = 0; step < 30; ++step) {
    CAPTURE(step);
    const AugmentedView view = view_of(1, step);
    const std::vector<double> off = distances_px(view);
    REQUIRE(off.size() > 100);
    const double median = off[off.size() / 2] / height_px(view);
    CHECK(median > 0.002);
    CHECK(median < 0.03);
    const std::vector<double> head = distances_px(view, "Head");
    head_off += head.empty() ? 0 : head[head.size() / 2] / height_px(view) / 30;
    confidences.insert(view.track.confidence(0, 0));
    unseen += (view.track.confidence.array() == 0).any() ? 1 : 0;
  }
  CHECK(unseen > 0);
  // What lies between face and head joint, up to 0.075 of the height, is taken off.
  CHECK(head_off < 0.009);
  // Each view has noise of its own.
  CHECK(confidences.size() > 15);
}

TEST_CASE("detector views: no limb is hidden where none is to be, errors stay") {
  for (std::uint32_t step = 0; step < 5; ++step) {
    const AugmentedView scaling = view_of(1, step, true), view = view_of(1, step);
    CHECK(scaling.track.confidence == view.track.confidence);
    CHECK(scaling.camera.translation == view.camera.translation);
    CHECK(distances_px(scaling) == distances_px(view));
    CHECK(distances_px(scaling).back() > 1);
  }
}

}  // namespace detector_views_test
