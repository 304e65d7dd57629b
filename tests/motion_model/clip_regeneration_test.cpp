#include "mcdbn/motion_model/clip_regeneration.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "camera/track_noise.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

namespace clip_regeneration_test {

using namespace mcdbn;

namespace {

Modalities modalities_of(const Motion& clip) {
  const CameraPlacement view;
  const Camera camera = place_camera(clip, view);
  const PoseFeatures pose_features = PoseFeatures::fit({&clip});
  const TrackFeatures track_features =
      TrackFeatures::for_skeleton(clip.skeleton, pose_features.root());
  const MatrixD poses = pose_features.encode(clip, camera.camera_from_world);
  const MatrixD tracks = track_features.encode(project_motion(clip, camera));
  return {pose_features,
          track_features,
          Standardizer::fit({&poses}),
          Standardizer::fit({&tracks}),
          clip.fps(),
          view};
}

/// A walk, and its track with an arm hidden in the middle.
struct Scene {
  Motion truth = synthesize({.seconds = 3});
  Modalities modalities = modalities_of(truth);
  Camera camera = place_camera(truth, modalities.camera);
  Track2d hidden = project_motion(truth, camera);
  MatrixF pose = modalities.encode_pose(truth, camera.camera_from_world);
  MatrixF whole = modalities.encode_track(hidden, camera), features;

  explicit Scene(double hidden_s = 1) {
    hide_arm(hidden, truth.skeleton, hidden_s, 1);
    features = modalities.encode_track(hidden, camera);
  }
  ClipPlacement placement() const { return {{camera, truth.skeleton}, std::nullopt}; }
};

bool has_gap(const MatrixF& features) {
  return features.array().isNaN().any();
}

/// RMS over the entries that are missing in `features`.
float off_in_gap(const MatrixF& filled, const MatrixF& whole, const MatrixF& features) {
  const auto gap = features.array().isNaN();
  const auto off = gap.select((filled - whole).array(), 0.0F);
  return std::sqrt(off.square().sum() / static_cast<float>(gap.count()));
}

}  // namespace

TEST_CASE("gaps are filled with what the answer shows there, and what is seen stays") {
  const Scene scene;
  REQUIRE(has_gap(scene.features));
  const auto truth = [&](const MatrixF&) { return scene.pose; };
  for (const bool fit : {false, true}) {
    CAPTURE(fit);
    ClipPlacement placement = scene.placement();
    if (fit) placement.fit = TrackFitSettings{};
    const MatrixF filled =
        fill_gaps(scene.modalities, scene.features, scene.hidden, placement, truth);
    CHECK_FALSE(has_gap(filled));
    const auto seen = !scene.features.array().isNaN();
    CHECK((seen.select(filled.array(), 0) == seen.select(scene.features.array(), 0)).all());
    // Rounding; the fit takes a track to be off by half a pixel of the arm's fifty or so.
    CHECK(off_in_gap(filled, scene.whole, scene.features) < (fit ? 0.01F : 1e-5F));
  }
}

TEST_CASE("gaps are filled anew from the answer to the filled track") {
  const Scene scene;
  std::vector<bool> gaps;
  // The answer to a track with a gap is the mean, otherwise the truth.
  const auto answer = [&](const MatrixF& seen) -> MatrixF {
    gaps.push_back(has_gap(seen));
    return gaps.back() ? MatrixF::Zero(scene.pose.rows(), scene.pose.cols()) : scene.pose;
  };
  const MatrixF filled =
      fill_gaps(scene.modalities, scene.features, scene.hidden, scene.placement(), answer);
  REQUIRE(gaps.size() > 1);
  CHECK(gaps.front());
  CHECK(std::count(gaps.begin(), gaps.end(), true) == 1);
  CHECK(off_in_gap(filled, scene.whole, scene.features) < 1e-5F);
}

TEST_CASE("without a gap no answer is asked for") {
  const Scene scene(0);
  const auto answer = [](const MatrixF& seen) -> MatrixF {
    FAIL("asked");
    return seen;
  };
  CHECK(fill_gaps(scene.modalities, scene.features, scene.hidden, scene.placement(), answer) ==
        scene.features);
}

TEST_CASE("a joint that is never seen, without a camera and without a skeleton; no joint at all") {
  Scene scene;
  const int hand = scene.hidden.find("LeftHand");
  REQUIRE(hand >= 0);
  scene.hidden.confidence.col(hand).setZero();
  scene.features = scene.modalities.encode_track(scene.hidden, scene.camera);
  const auto truth = [&](const MatrixF&) { return scene.pose; };
  const MatrixF filled = fill_gaps(scene.modalities, scene.features, scene.hidden,
                                   {{std::nullopt, std::nullopt}, TrackFitSettings{}}, truth);
  CHECK_FALSE(has_gap(filled));
  // No further than with body and camera known, as above: the truth needs no other bones.
  CHECK(off_in_gap(filled, scene.whole, scene.features) < 0.01F);
  drop_joints(scene.hidden, 1, 1);
  scene.features = scene.modalities.encode_track(scene.hidden, scene.camera);
  CHECK_THROWS_AS(
      fill_gaps(scene.modalities, scene.features, scene.hidden, scene.placement(), truth),
      InputError);
}

}  // namespace clip_regeneration_test
