#pragma once

#include <cmath>
#include <random>

#include "features/clip_modalities.hpp"
#include "fitting/two_second_walk.hpp"
#include "mcdbn/fitting/track_fit.hpp"
#include "motion/rotation_vector.hpp"

namespace mcdbn::test {

/// Of the turns by which priors are wrong, and how alike they are along a limb.
inline constexpr double kWrong_deg = 10, kAlike = 0.5;

/// A walk, its 2D track through a lens with distortion, and a prior that is wrong by turns.
struct Scene {
  Motion truth;
  Modalities modalities;
  KnownOfClip known;
  Track2d track;
  MatrixF mean;

  Motion fit(const Track2d& seen, const TrackFitSettings& settings = {}) const {
    return fit_to_track(mean, modalities, seen, known, settings).motion;
  }
  Motion fit() const { return fit(track); }
  Motion unfitted() const {
    return fit_to_track(mean, modalities, track, known, std::nullopt).motion;
  }
};

inline MatrixD disturbed(MatrixD features, const PoseFeatures& pose_features, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, kWrong_deg * M_PI / 180);
  const auto drawn = [&] {  // arguments would be drawn in an order of the compiler's own
    const double z = normal(random), y = normal(random), x = normal(random);
    return Eigen::Vector3d(x, y, z);
  };
  const Eigen::Vector3d common = drawn();
  for (std::size_t turn = 0; turn < pose_features.joints().size(); ++turn) {
    const Eigen::Vector3d own = drawn();
    const Eigen::Matrix3d rotation =
        rotation_of(std::sqrt(kAlike) * common + std::sqrt(1 - kAlike) * own);
    for (const int axis : {0, 3})
      for (Eigen::Index t = 0; t < features.rows(); ++t)
        features.row(t).segment<3>(static_cast<Eigen::Index>(6 * turn) + axis) *=
            rotation.transpose();
  }
  return features;
}

/// @param seed 0: the prior is right
inline Scene make_scene(unsigned seed = 1, int frames = 60) {
  Motion truth = two_second_walk();
  truth.channels.conservativeResize(frames, Eigen::NoChange);
  Camera camera = place_camera(truth, {});
  camera.distortion = {-0.1, 0.02, 1e-3, -5e-4};
  Scene scene{truth,
              modalities_of({two_second_walk()}, {}),
              {camera, truth.skeleton},
              project_motion(truth, camera),
              {}};
  MatrixD features = scene.modalities.pose_values(truth, camera.camera_from_world);
  if (seed > 0) features = disturbed(features, scene.modalities.pose_features, seed);
  scene.mean = scene.modalities.pose_scale.apply(features);
  return scene;
}

}  // namespace mcdbn::test
