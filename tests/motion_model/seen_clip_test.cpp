// What a model sees of tracks whose columns are not its own joints.

#include "mcdbn/motion_model/seen_clip.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/capture_bound.hpp"
#include "camera/keypoint_pairs.hpp"
#include "camera/keypoint_track.hpp"
#include "camera/track_columns.hpp"
#include "features/clip_modalities.hpp"
#include "fitting/track_smoothing.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/resample.hpp"

namespace seen_clip_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

struct Scene {
  Motion truth = synthesize({.seconds = 2});
  CameraPlacement view{60, 5, std::nullopt, 45, 1920, 1080};
  Modalities modalities = modalities_of({truth}, view);
  Camera camera = place_camera(truth, view);
  MatrixF pose = modalities.encode_pose(truth, camera.camera_from_world);
  Track2d exact = project_motion(truth, camera);
  ClipPlacement placement{{camera, truth.skeleton}};
  int asked = 0;

  Track2d seen(const std::vector<Keypoint>& keypoints) const {
    return keypoint_track(truth, camera, keypoints);
  }
  SeenClip see(const Track2d& track) {
    return see_clip(modalities, track, placement, [&](const MatrixF& features) -> MatrixF {
      CHECK(features.cols() == modalities.track_scale.output_dimension());
      ++asked;
      return pose;
    });
  }
  /// The farthest that a joint is from where it is, in pixels.
  double off_px(const Track2d& joints, const std::string& name) const {
    const int here = joints.find(name), there = exact.find(name);
    REQUIRE(here >= 0);
    return std::max((joints.x_px.col(here) - exact.x_px.col(there)).cwiseAbs().maxCoeff(),
                    (joints.y_px.col(here) - exact.y_px.col(there)).cwiseAbs().maxCoeff());
  }
};

}  // namespace

TEST_CASE("seen clips: a track of the model's joints is taken as it is") {
  Scene scene;
  Track2d track = scene.exact;
  track.confidence.col(track.find(scene.truth.skeleton.joints[3].name)).segment(10, 20).setZero();
  const MatrixF features = scene.modalities.encode_track(smooth_track(track), scene.camera);
  const SeenClip seen = scene.see(track);
  const auto answer = [&](const MatrixF&) { return scene.pose; };
  CHECK(seen.features == fill_gaps(scene.modalities, features, track, scene.placement, answer));
  CHECK(seen.joints.x_px.col(0) == track.x_px.col(0));
  CHECK(seen.filled.missing == 20);
  CHECK(seen.filled.unseen.empty());
  // Whatever else its columns are given as.
  track.keypoints = {keypoint("Hips", JointRole::head)};
  CHECK(scene.see(track).features == seen.features);
}

TEST_CASE("seen clips: frames that show nobody lie between those around them, not at the mean") {
  Scene scene;
  scene.placement.fit.reset();
  // Longer than what is interpolated joint by joint, and at the end.
  const int first = 20, frames = 12, last = 48;
  for (const bool keypoints : {false, true}) {
    CAPTURE(keypoints);
    Track2d track = keypoints ? scene.seen(coco_keypoints()) : scene.exact;
    track.confidence.middleRows(first, frames).setZero();
    track.confidence.bottomRows(track.frames() - last).setZero();
    std::vector<MatrixF> asked;
    see_clip(scene.modalities, track, scene.placement, [&](const MatrixF& features) -> MatrixF {
      asked.push_back(features);
      return scene.pose;
    });
    REQUIRE_FALSE(asked.empty());
    // Joints that no keypoint shows stay unknown.
    const MatrixF seen = asked.front().array().isNaN().select(0.0F, asked.front());
    const auto before = seen.row(first - 1), after = seen.row(first + frames);
    CHECK(asked.front().row(first).array().isNaN().cast<int>().sum() < asked.front().cols() / 2);
    CHECK((before - after).norm() > 0.5F);
    for (int t = first; t < first + frames; ++t) {
      const float share = static_cast<float>(t - first + 1) / (frames + 1);
      CHECK(seen.row(t).isApprox((1 - share) * before + share * after, 1e-5F));
    }
    for (int t = last; t < track.frames(); ++t) CHECK(seen.row(t) == seen.row(last - 1));
  }
}

TEST_CASE("seen clips: a detector's keypoints, the answer's own pose takes off what lies between") {
  Scene scene;
  for (const auto& keypoints : {coco_keypoints(), body_25_keypoints()}) {
    scene.asked = 0;
    const SeenClip seen = scene.see(scene.seen(keypoints));
    CHECK(scene.asked == 2);
    for (const std::string& name : seen.joints.joint_names) {
      CAPTURE(name);
      // Pelvis and neck follow from hips and shoulders: they are nothing new to the fit.
      const bool derived = name == "Hips" || name == "Neck";
      CHECK((seen.joints.confidence.col(seen.joints.find(name)).array() == 0).all() == derived);
      // Of a figure some 900 px tall; the fit stands between the true answer and the joints.
      if (!derived) CHECK(scene.off_px(seen.joints, name) < 4);
    }
    CHECK_FALSE(seen.features.array().isNaN().any());
    CHECK(std::ranges::count(seen.filled.unseen, "LeftLeg") == 0);
    const MatrixF whole = scene.modalities.encode_track(scene.exact, scene.camera);
    const Standardizer& scale = scene.modalities.track_scale;
    CHECK((scale.invert(seen.features) - scale.invert(whole)).cwiseAbs().maxCoeff() < 0.05);
    const bool feet = keypoints.size() > 17;
    CHECK((std::ranges::count(seen.filled.unseen, "LeftToeBase") == 0) == feet);
    CHECK(std::ranges::count(seen.filled.unseen, "Spine") == 1);
  }
}

TEST_CASE("seen clips: a keypoint's confidence counts by the track's usual one") {
  Scene scene;
  Track2d track = scene.seen(coco_keypoints());
  track.confidence.setConstant(0.6);
  track.confidence.col(track.find("left_wrist")).segment(20, 10).setConstant(0.3);
  const SeenClip seen = scene.see(track);
  const auto hand = seen.joints.confidence.col(seen.joints.find("LeftHand"));
  for (Eigen::Index t = 0; t < track.frames(); ++t)
    CHECK(hand[t] == doctest::Approx(t >= 20 && t < 30 ? std::pow(0.5, 2.5) : 1));
}

TEST_CASE("seen clips: roles given by hand are used") {
  Scene scene;
  const Track2d track = scene.seen(coco_keypoints());
  scene.placement.joint_map = {{JointRole::left_knee, "LeftFoot"}};
  const SeenClip seen = scene.see(track);
  CHECK(seen.joints.find("LeftLeg") < 0);
  CHECK(scene.off_px(seen.joints, "LeftFoot") > 50);
}

TEST_CASE("seen clips: the columns of another skeleton, by its names") {
  Scene scene;
  Track2d track = scene.exact;
  for (std::string& name : track.joint_names) {
    for (const auto& [own, other] :
         {std::pair{"LeftUpLeg", "UpperLeg_L"}, std::pair{"RightUpLeg", "UpperLeg_R"},
          std::pair{"LeftLeg", "LowerLeg_L"}, std::pair{"RightLeg", "LowerLeg_R"},
          std::pair{"LeftArm", "UpperArm_L"}, std::pair{"RightArm", "UpperArm_R"},
          std::pair{"Hips", "Pelvis"}})
      if (name == own) {
        name = other;
        break;
      }
  }
  for (std::string& name : track.joint_names)
    if (scene.truth.skeleton.find(name) >= 0) name = "unknown " + name;
  const SeenClip seen = scene.see(track);
  CHECK(seen.joints.joint_count() == 8);  // and the neck, from the shoulders
  for (const char* name : {"LeftUpLeg", "RightLeg", "LeftArm", "Hips", "RightArm"}) {
    CAPTURE(name);
    CHECK(scene.off_px(seen.joints, name) < 1e-6);
  }
}

TEST_CASE("seen clips: the view of an unknown camera is found as the clip is seen") {
  Scene scene;
  scene.truth = synthesize({.seconds = 4});
  scene.view = {60, 14, std::nullopt, 45, 1920, 1080};
  scene.camera = place_camera(scene.truth, scene.view);
  scene.exact = project_motion(scene.truth, scene.camera);
  scene.placement.camera.reset();
  scene.placement.view.field_of_view_deg = 45;
  for (const bool level : {false, true}) {
    scene.modalities.level_view = level;
    scene.pose = scene.modalities.encode_pose(scene.truth, scene.camera.camera_from_world);
    for (const Track2d& track : {scene.exact, scene.seen(body_25_keypoints())}) {
      scene.placement.view.pitch_deg.reset();
      CHECK(finds_view(scene.modalities, scene.placement) == level);
      const SeenClip seen = scene.see(track);
      CHECK(seen.view.field_of_view_deg == 45);
      CHECK(seen.view.pitch_deg.has_value() == level);
      if (!level) continue;
      CHECK(std::abs(*seen.view.pitch_deg - 14) < 3);
      CHECK(std::abs(*seen.view.roll_deg) < 3);
      // What is seen is seen through the view that was found.
      const Camera found =
          scene.modalities.assumed_camera(seen.view, track.width_px, track.height_px);
      if (track.keypoints.empty())
        CHECK(seen.features == scene.modalities.encode_track(smooth_track(track), found));
      scene.placement.view.pitch_deg = 2;  // given, however wrong
      CHECK(scene.see(track).view.pitch_deg == 2);
    }
  }
  scene.placement.view.roll_deg = 0;
  CHECK_FALSE(finds_view(scene.modalities, scene.placement));
  scene.placement = {{scene.camera, scene.truth.skeleton}};
  CHECK_FALSE(finds_view(scene.modalities, scene.placement));
}

TEST_CASE("seen clips: the last fit begins with the view in which the network answered") {
  Scene scene;
  scene.truth = synthesize({.seconds = 3});
  scene.view.elevation_deg = 25;
  scene.camera = place_camera(scene.truth, scene.view);
  scene.modalities.level_view = true;
  scene.pose = scene.modalities.encode_pose(scene.truth, scene.camera.camera_from_world);
  scene.placement.camera.reset();
  scene.placement.view.field_of_view_deg = 45;
  const Track2d track = project_motion(scene.truth, scene.camera);
  const SeenClip seen = scene.see(track);
  REQUIRE(*seen.view.pitch_deg > 5);
  const auto answer = [&](const MatrixF&) -> PosePrior { return scene.pose; };
  const MatrixD got =
      regenerate_clip(scene.modalities, track, scene.placement, answer,
                      [&](const MatrixF&) { return std::vector<PosePrior>{scene.pose}; })
          .at(0)
          .channels;
  const auto fitted_from = [&](const AssumedView& found) {
    KnownOfClip known = scene.placement;
    known.found = found;
    return fit_to_track(scene.pose, scene.modalities, seen.joints, known, scene.placement.fit)
        .motion.channels;
  };
  CHECK((fitted_from(seen.view) - got).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((fitted_from({}) - got).cwiseAbs().maxCoeff() > 1e-3);
}

TEST_CASE("seen clips: legs that come back with the other's sides get their own") {
  Scene scene;
  scene.truth = synthesize({.seconds = 3});
  scene.exact = project_motion(scene.truth, scene.camera);
  scene.pose = scene.modalities.encode_pose(scene.truth, scene.camera.camera_from_world);
  Track2d track = scene.seen(body_25_keypoints());
  const LimbPairs legs = leg_pairs(track.keypoints);
  for (const int gap : {33, 52})
    for (const auto& [left, right] : legs.columns)
      for (const int column : {left, right}) track.confidence.col(column).segment(gap, 7).setZero();
  const SeenClip right = scene.see(track);
  CHECK(right.swaps.empty());
  CHECK(scene.asked == 2 + 2 * 3);  // each of three spells both ways
  for (const auto& [first, last] : {std::pair{0, 32}, std::pair{40, 51}, std::pair{59, 89}}) {
    CAPTURE_BOUND(first);
    Track2d exchanged = track;
    for (int t = first; t <= last; ++t)
      for (const auto& [left, other] : legs.columns) exchange_columns(exchanged, t, left, other);
    const SeenClip seen = scene.see(exchanged);
    CHECK(described(seen.swaps) == fmt::format("legs swapped in frames {}-{}", first, last));
    CHECK(seen.features == right.features);
    CHECK((seen.joints.confidence == right.joints.confidence));
    ClipPlacement unfitted = scene.placement;
    unfitted.fit.reset();
    std::swap(unfitted, scene.placement);
    CHECK(scene.see(exchanged).swaps.empty());
    std::swap(unfitted, scene.placement);
  }
}

TEST_CASE(
    "seen clips: the fit's first step is that of looking at sides, the rounds have their own") {
  Scene scene;
  Track2d track = scene.seen(body_25_keypoints());
  const MatrixF usual = scene.see(track).features;
  REQUIRE(scene.asked == 2);  // no spells
  TrackFitSettings& fit = *scene.placement.fit;
  for (const double step_s : {0.03, 5.0}) {
    fit.first_solution_step_s = step_s;
    CHECK(scene.see(track).features == usual);
  }
  const LimbPairs legs = leg_pairs(track.keypoints);
  for (const auto& [left, right] : legs.columns) {
    for (const int gap : {20, 35})
      for (const int column : {left, right}) track.confidence.col(column).segment(gap, 7).setZero();
    for (int t = 27; t < 35; ++t) exchange_columns(track, t, left, right);
  }
  CHECK(scene.see(track).swaps.empty());  // the first frame alone does not show them
  fit.first_solution_step_s = TrackFitSettings{}.first_solution_step_s;
  CHECK(described(scene.see(track).swaps) == "legs swapped in frames 27-34");
}

TEST_CASE("seen clips: sides that were looked at again are reported in the track's own frames") {
  const Motion fast = synthesize({.fps = 60, .seconds = 3});
  Scene scene;
  scene.pose = scene.modalities.encode_pose(resample(fast, 30), scene.camera.camera_from_world);
  Track2d track = keypoint_track(fast, scene.camera, body_25_keypoints());
  const LimbPairs legs = leg_pairs(track.keypoints);
  for (const auto& [left, right] : legs.columns) {
    for (const int gap : {60, 100})
      for (const int column : {left, right})
        track.confidence.col(column).segment(gap, 20).setZero();
    for (int t = 80; t < 100; ++t) exchange_columns(track, t, left, right);
  }
  const auto answer = [&](const MatrixF&) -> MatrixF { return scene.pose; };
  TrackFindings found;
  regenerate_clip(
      scene.modalities, track, scene.placement, answer,
      [&](const MatrixF& features) { return std::vector<PosePrior>{answer(features)}; }, &found);
  REQUIRE(found.swaps.size() == 1);
  CHECK(std::abs(found.swaps[0].first_frame - 80) <= 2);
  CHECK(std::abs(found.swaps[0].last_frame - 99) <= 2);
}

TEST_CASE("seen clips: too little of a person is an error") {
  Scene scene;
  Track2d track = scene.seen(coco_keypoints());
  track.keypoints.resize(7);
  CHECK_THROWS_WITH_AS(scene.see(track), doctest::Contains("shows too little of the body"),
                       InputError);
}

}  // namespace seen_clip_test
