// A track that jumps to another place: each stretch is a clip of its own, of one body.

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/numbers.hpp"
#include "camera/projected_keypoints.hpp"
#include "camera/show_only.hpp"
#include "features/clip_modalities.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion_model/recent_track.hpp"
#include "motion_model/several_answers.hpp"

namespace regenerate_stretches_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr int kFirst = 50, kFrames = 80;

/// A walk whose track goes on elsewhere after 50 frames, and poses that nothing is known of.
struct Scene {
  Motion clip = walk();
  Modalities modalities = modalities_of({clip}, {});
  Camera camera = place_camera(clip, {});
  Track2d track = jumping(project_motion(clip, camera));
  ClipPlacement known{{camera, clip.skeleton}};

  static Motion walk() {
    SynthesisOptions options;
    options.seconds = (kFrames + 1) / 30.0;
    options.fps = 30;
    Motion motion = synthesize(options);
    motion.channels.conservativeResize(kFrames, Eigen::NoChange);
    return motion;
  }
  static Track2d jumping(Track2d track) {
    track.x_px.bottomRows(kFrames - kFirst).array() += 2 * track.height_px;
    return track;
  }
  Track2d keypoints() const {
    return jumping(project_keypoints(clip, skeleton_roles(clip.skeleton),
                                     joint_set("COCO_17").keypoints, camera));
  }
  std::vector<Motion> regenerated(const Track2d& of, const ClipPlacement& placement,
                                  TrackFindings* findings = nullptr,
                                  std::size_t answers = 1) const {
    const auto single = [&](const MatrixF& features) -> PosePrior {
      return MatrixF(MatrixF::Zero(features.rows(), modalities.pose_scale.output_dimension()));
    };
    return regenerate_clip(modalities, of, placement, single, several(single, answers), findings);
  }
};

/// The farthest that a joint is seen from where the track has it.
double off_px(const Motion& motion, const Camera& camera, const Track2d& track) {
  const Track2d seen = project_motion(motion, camera);
  return std::max((seen.x_px - track.x_px).cwiseAbs().maxCoeff(),
                  (seen.y_px - track.y_px).cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("regenerate stretches: each is as if it were alone") {
  const Scene scene;
  TrackFindings found;
  const auto got = scene.regenerated(scene.track, scene.known, &found, 2);
  CHECK(found.stretches.stretches == std::vector<FrameRange>{{0, kFirst}, {kFirst, 30}});
  REQUIRE(got.size() == 2);
  for (const FrameRange& range : found.stretches.stretches) {
    const auto alone = scene.regenerated(some_frames(scene.track, range.first, range.frames),
                                         scene.known, nullptr, 2);
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(got[i].channels.middleRows(range.first, range.frames) == alone[i].channels);
  }
  CHECK(got[0].channels != got[1].channels);
}

TEST_CASE("regenerate stretches: angles go on from the nearest turn of the frame before") {
  constexpr double kTurn_deg = 9;  // from frame to frame: more than a whole turn before the jump
  Scene scene;
  const Joint& root = scene.clip.skeleton.joints[0];
  for (int t = 0; t < kFrames; ++t) {
    double* const channels = scene.clip.channels.row(t).data();
    const Eigen::AngleAxisd turn(t * kTurn_deg * kRadiansPerDegree, Eigen::Vector3d::UnitY());
    set_local_rotation(root, turn * local_rotation(root, channels),
                       t > 0 ? scene.clip.channels.row(t - 1).data() : nullptr, channels);
  }
  scene.modalities = modalities_of({scene.clip}, {});
  scene.track = Scene::jumping(project_motion(scene.clip, scene.camera));
  scene.known.fit.reset();  // the answer as it is: the truth
  const MatrixF pose = scene.modalities.encode_pose(scene.clip, scene.camera.camera_from_world);
  const auto regenerated = [&](int first, int frames, TrackFindings* findings = nullptr) {
    const auto single = [&](const MatrixF& features) -> PosePrior {
      return MatrixF(features.rows() == kFirst ? pose.topRows(kFirst)
                                               : pose.bottomRows(features.rows()));
    };
    return regenerate_clip(scene.modalities, some_frames(scene.track, first, frames), scene.known,
                           single, several(single, 1), findings)
        .front();
  };
  TrackFindings found;
  const Motion got = regenerated(0, kFrames, &found),
               second = regenerated(kFirst, kFrames - kFirst);
  REQUIRE(found.stretches.stretches == std::vector<FrameRange>{{0, kFirst}, {kFirst, 30}});
  const auto angles = [](const Motion& motion, int frame, int frames) {
    return motion.channels.block(frame, 3, frames, motion.channels.cols() - 3).array().eval();
  };
  CHECK(angles(got, 0, kFirst).abs().maxCoeff() > 360);
  CHECK((angles(got, kFirst, 1) - angles(got, kFirst - 1, 1)).abs().maxCoeff() <= 180);
  const auto more = (angles(got, kFirst, 30) - angles(second, 0, 30)).eval();
  CHECK(more.abs().maxCoeff() > 359);
  for (Eigen::Index t = 0; t < more.rows(); ++t)
    for (Eigen::Index c = 0; c < more.cols(); ++c)
      CHECK(std::abs(std::remainder(more(t, c), 360)) < 1e-9);
}

TEST_CASE("regenerate stretches: they have the body and the camera of the longest") {
  const Scene scene;
  const ClipPlacement nothing_known;
  for (const bool backwards : {false, true}) {
    CAPTURE(backwards);
    Track2d track = scene.track;
    if (backwards)
      for (MatrixD* values : {&track.x_px, &track.y_px, &track.confidence})
        *values = MatrixD(values->colwise().reverse());
    TrackFindings found, of_longest;
    const auto got = scene.regenerated(track, nothing_known, &found, 2);
    const FrameRange longest = found.stretches.stretches.at(backwards ? 1 : 0);
    REQUIRE(longest.frames == kFirst);
    const auto alone = scene.regenerated(some_frames(track, longest.first, longest.frames),
                                         nothing_known, &of_longest, 2);
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(got[i].channels.middleRows(longest.first, kFirst) == alone[i].channels);
      for (std::size_t joint = 0; joint < got[i].skeleton.joints.size(); ++joint)
        CHECK(got[i].skeleton.joints[joint].offset == alone[i].skeleton.joints[joint].offset);
    }
    CHECK(found.camera.fx_px == of_longest.camera.fx_px);
    CHECK(found.camera.translation == of_longest.camera.translation);
    CHECK(off_px(got[0], found.camera, track) < 100);  // the jump is 2160
  }
}

TEST_CASE("regenerate stretches: the longest does not count if it hardly shows a body") {
  const Scene scene;
  const ClipPlacement nothing_known;
  Track2d track = scene.track;
  const std::vector<std::string> arm{"LeftArm", "LeftForeArm", "LeftHand"};
  for (const std::string& joint : arm) REQUIRE(track.find(joint) >= 0);
  show_only(track, 20, kFirst - 20, arm);
  TrackFindings found, of_second;
  const auto got = scene.regenerated(track, nothing_known, &found);
  REQUIRE(found.stretches.stretches == std::vector<FrameRange>{{0, kFirst}, {kFirst, 30}});
  const auto alone = scene.regenerated(some_frames(track, kFirst, 30), nothing_known, &of_second);
  CHECK(got.front().channels.bottomRows(30) == alone.front().channels);
  for (std::size_t joint = 0; joint < got.front().skeleton.joints.size(); ++joint)
    CHECK(got.front().skeleton.joints[joint].offset == alone.front().skeleton.joints[joint].offset);
  CHECK(found.camera.translation == of_second.camera.translation);
}

TEST_CASE("regenerate stretches: a part of a leg elsewhere is left out, and refuses no clip") {
  const Scene scene;
  constexpr int kFrom = 60, kLeg = 15;
  Track2d track = project_keypoints(scene.clip, skeleton_roles(scene.clip.skeleton),
                                    joint_set("BODY_25").keypoints, scene.camera);
  show_only(track, kFrom, kLeg, {"RKnee", "RAnkle", "RHeel"});
  track.x_px.middleRows(kFrom, kLeg).array() -= 2 * track.width_px;
  TrackFindings found;
  const auto got = scene.regenerated(track, scene.known, &found);
  CHECK(found.stretches.stretches == std::vector<FrameRange>{{0, kFrames}});
  CHECK(found.stretches.strays == std::vector<FrameRange>{{kFrom, kLeg}});
  leave_out(track, found.stretches.strays);
  CHECK(scene.regenerated(track, scene.known).front().channels == got.front().channels);
}

TEST_CASE("regenerate stretches: a body that was found is as little known in all of them") {
  const Scene scene;
  ClipPlacement placement;
  placement.camera = scene.camera;
  placement.uncertainty_draws = {20, 3};
  const Eigen::Index height = 3 * scene.clip.skeleton.find("Head") + 1;
  REQUIRE(height > 0);
  for (const bool fitted : {false, true}) {
    CAPTURE(fitted);
    if (!fitted) placement.fit.reset();
    if (fitted) placement.fit.emplace();
    TrackFindings found;
    scene.regenerated(scene.track, placement, &found);
    const auto width = [&](int first, int frames) {
      return found.uncertainty.block(first, height, frames, 1).norm() / std::sqrt(frames);
    };
    const double part = width(kFirst, kFrames - kFirst) / width(0, kFirst);
    CHECK(part > 0.7);
    CHECK(part < 3);  // it is shorter
  }
}

TEST_CASE(
    "regenerate stretches: deviations are from the body's root, below a node that stands still") {
  const auto deviations = [](const Motion& clip) {
    Scene scene;
    scene.modalities = modalities_of({clip}, {});
    ClipPlacement placement;
    placement.camera = scene.camera;
    placement.uncertainty_draws = {40, 3};
    TrackFindings found;
    scene.regenerated(project_motion(clip, scene.camera), placement, &found);
    return found.uncertainty;
  };
  const Motion plain = Scene::walk();
  Motion below = plain;
  Skeleton& skeleton = below.skeleton;
  skeleton.joints.insert(skeleton.joints.begin(),
                         {"Node", -1, {0, 0, 0}, {Channel::x_position}, {}});
  for (std::size_t joint = 1; joint < skeleton.joints.size(); ++joint)
    ++skeleton.joints[joint].parent;
  below.channels.resize(plain.channels.rows(), plain.channels.cols() + 1);
  below.channels << Eigen::VectorXd::Zero(plain.frames()), plain.channels;
  const MatrixD wanted = deviations(plain), got = deviations(below);
  REQUIRE(got.cols() == wanted.cols() + 3);
  // Draws differ, as one more joint turns; a distance counted in would make hands three times as
  // uncertain.
  for (Eigen::Index joint = 0; joint < wanted.cols(); joint += 3) {
    CAPTURE(skeleton.joints[static_cast<std::size_t>(joint / 3 + 1)].name);
    const double width = wanted.middleCols<3>(joint).norm();
    CHECK(got.middleCols<3>(joint + 3).norm() > 0.6 * width);
    CHECK(got.middleCols<3>(joint + 3).norm() < 1.6 * width);
  }
}

TEST_CASE("regenerate stretches: strays are left out, and findings are of the whole track") {
  Scene scene;
  scene.known.uncertainty_draws.count = 2;
  Track2d track = scene.keypoints();
  const auto exchange = [](Track2d& of, int first, int frames) {
    for (const std::string joint : {"hip", "knee", "ankle"})
      for (MatrixD* values : {&of.x_px, &of.y_px})
        for (int t = first; t < first + frames; ++t)
          std::swap((*values)(t, of.find("left_" + joint)),
                    (*values)(t, of.find("right_" + joint)));
  };
  track.y_px.middleRows(20, 3).array() += 3 * track.height_px;
  const auto as_it_was = scene.regenerated(track, scene.known);
  exchange(track, 65, 4);
  TrackFindings found;
  const auto got = scene.regenerated(track, scene.known, &found);
  CHECK(found.stretches.strays == std::vector<FrameRange>{{20, 3}});
  REQUIRE(found.swaps.size() == 1);
  CHECK(found.swaps[0].first_frame == 65);
  CHECK(found.swaps[0].last_frame == 68);
  CHECK(got.front().channels == as_it_was.front().channels);
  CHECK(found.uncertainty.rows() == kFrames);
  CHECK(found.uncertainty.cwiseAbs().minCoeff() >= 0);
  leave_out(track, found.stretches.strays);
  CHECK(scene.regenerated(track, scene.known).front().channels == got.front().channels);
}

}  // namespace regenerate_stretches_test
