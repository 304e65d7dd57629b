#include "corpus/encoded_clip.hpp"

#include <doctest/doctest.h>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/synthetic_motion.hpp"

namespace encoded_clip_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A body below a joint that stands still, so that the root that moves is not the first joint.
Modalities modalities_of(const Motion& clip, double fps) {
  const PoseFeatures pose_features = PoseFeatures::fit({&clip});
  const TrackFeatures track_features =
      TrackFeatures::for_skeleton(clip.skeleton, pose_features.root());
  const MatrixD any_pose = MatrixD::Random(30, pose_features.dimension());
  const MatrixD any_track = MatrixD::Random(30, track_features.dimension());
  return {pose_features,
          track_features,
          Standardizer::fit({&any_pose}),
          Standardizer::fit({&any_track}),
          fps,
          {-60, 3, std::nullopt, 30, 640, 480}};
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("a clip as a model sees it: at its rate, from the view that is asked for") {
  const ScratchFolder folder;
  Motion recorded = swinging(small_body_below_still_root(), 101, 60);
  const auto file = folder / "clip.bvh";
  write_bvh(file, recorded);
  const Modalities modalities = modalities_of(recorded, 20);
  const CameraPlacement view{70, 15, std::nullopt, 50, 1000, 800};
  ClipNotices notices;
  const EncodedClip clip = encode_clip(file, modalities, view, false, &notices);
  CHECK(clip.file == file);
  const Motion motion = load_clip(file, {.fps = 20, .keep_first_frame = false});
  CHECK(clip.motion.channels == motion.channels);
  CHECK(clip.motion.fps() == doctest::Approx(20));
  CHECK(clip.motion.frames() == 34);

  const MatrixD points = joint_positions(motion);
  const int hips = motion.skeleton.find("Hips");
  REQUIRE(hips == 1);
  CHECK(clip.root_position == points.middleCols(3 * hips, 3));
  // The view is that of the clip's own placement, not the model's.
  const Camera camera = place_camera(points, view);
  CHECK(clip.camera.camera_from_world == camera.camera_from_world);
  CHECK(clip.camera.translation == camera.translation);
  CHECK(clip.camera.width_px == 1000);
  CHECK(clip.camera.height_px == 800);
  // The track is its pinhole picture.
  REQUIRE(clip.track.joint_count() == motion.skeleton.joint_count());
  CHECK(clip.track.fps == doctest::Approx(20));
  CHECK(clip.track.width_px == 1000);
  for (int j = 0; j < motion.skeleton.joint_count(); ++j)
    for (int t = 0; t < motion.frames(); ++t) {
      const Eigen::Vector3d seen =
          camera.camera_from_world * points.row(t).segment<3>(3 * j).transpose() +
          camera.translation;
      CHECK(std::abs(clip.track.x_px(t, j) - (camera.fx_px * seen.x() / seen.z() + camera.cx_px)) <
            1e-6);
      CHECK(std::abs(clip.track.y_px(t, j) - (camera.fy_px * seen.y() / seen.z() + camera.cy_px)) <
            1e-6);
    }
  // Each modality by its own features and its own scale.
  const MatrixD track = modalities.track_features.encode(clip.track);
  const MatrixD pose = modalities.pose_features.encode(motion, camera.camera_from_world);
  const auto standardized = [](const MatrixD& raw, const Standardizer& scale) {
    return MatrixD((raw.rowwise() - scale.mean()).array().rowwise() / scale.deviation().array());
  };
  CHECK(largest(clip.track_features.cast<double>() - standardized(track, modalities.track_scale)) <
        1e-4);
  CHECK(largest(clip.pose_features.cast<double>() - standardized(pose, modalities.pose_scale)) <
        1e-4);
}

TEST_CASE("a clip's leading calibration pose is dropped unless it is to be kept") {
  const ScratchFolder folder;
  Motion recorded = swinging(small_body(), 40, 30);
  recorded.channels.row(0).setZero();  // a T-pose, far from the next frame
  const auto file = folder / "clip.bvh";
  write_bvh(file, recorded);
  const Modalities modalities = modalities_of(recorded, 30);
  ClipNotices notices;
  const EncodedClip dropped = encode_clip(file, modalities, {}, false, &notices);
  CHECK(dropped.motion.frames() == 39);
  CHECK(dropped.pose_features.rows() == 39);
  CHECK(dropped.track_features.rows() == 39);
  CHECK(notices.all().size() == 1);
  CHECK(encode_clip(file, modalities, {}, true).motion.frames() == 40);
  CHECK(encode_clip(file, modalities, {}).motion.frames() == 39);
  CHECK_THROWS_AS(encode_clip(folder / "missing.bvh", modalities, {}), InputError);
}

}  // namespace encoded_clip_test
