// Views hold the new poses, and gravity's error, that settings ask for.
#include <doctest/doctest.h>

#include "base/random_streams.hpp"
#include "corpus/augmented_views.hpp"
#include "corpus/humanoid_clips.hpp"
#include "corpus/new_poses.hpp"
#include "corpus/no_augmentation.hpp"
#include "mcdbn/corpus/training_set.hpp"

namespace new_poses_wiring_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr double kFps = 30;

std::vector<LoadedClip> two_clips() {
  return {humanoid_clip(10, 20, 0), humanoid_clip(60, 40, 120)};
}

}  // namespace

TEST_CASE("a view with a pool has new poses before it is seen") {
  const auto clips = two_clips();
  const PosePool pool(clips, kFps);
  AugmentationSettings settings = nothing();
  settings.arms_anywhere = settings.limbs_exchanged = 1;
  const RandomKey key{4, 2, 0, 0};
  const AugmentedView plain = augmented_view(clips[0].motion, kFps, {}, settings, key),
                      view = augmented_view(clips[0].motion, kFps, {}, settings, key, false, &pool);
  CHECK(view.motion.channels == with_new_poses(plain.motion, settings, pool, key).channels);
  CHECK(view.motion.channels != plain.motion.channels);
  CHECK((view.track.x_px - project_motion(view.motion, view.camera).x_px).cwiseAbs().maxCoeff() <
        1e-9);
}

TEST_CASE("views of one number that are made for two purposes have other new poses") {
  const auto clips = two_clips();
  const PosePool pool(clips, kFps);
  for (double AugmentationSettings::*share :
       {&AugmentationSettings::limbs_exchanged, &AugmentationSettings::limbs_turned,
        &AugmentationSettings::arms_anywhere, &AugmentationSettings::leaning,
        &AugmentationSettings::turning_round}) {
    AugmentationSettings settings = nothing();
    settings.*share = 1;
    const auto made_for = [&](std::uint16_t stream) {
      return with_new_poses(clips[0].motion, settings, pool, {4, 2, stream, 0}).channels;
    };
    CHECK(made_for(random_streams::kScalingViews) == made_for(random_streams::kScalingViews));
    CHECK(made_for(random_streams::kScalingViews) != made_for(random_streams::kAugmentedViews));
  }
}

TEST_CASE("training sets and views are made with them, and without them as before") {
  const auto clips = two_clips();
  CorpusSettings settings;
  settings.augment = nothing();
  settings.augment.views = 2;
  const auto made = [&](const AugmentationSettings& augment) {
    CorpusSettings with = settings;
    with.augment = augment;
    const TrainingSet set = make_training_set(clips, with, 3, true);
    return std::pair{set, make_augmented_views(clips, set.modalities, with, 3)};
  };
  const auto [plain_set, plain_views] = made(settings.augment);
  AugmentationSettings augment = settings.augment;
  augment.arms_anywhere = 1;
  const auto [set, views] = made(augment);
  CHECK(views.poses.size() == plain_views.poses.size());
  // In the same scaling: it changes with the poses, too.
  settings.augment = augment;
  const TrainingSet scaled_alike = make_augmented_views(clips, plain_set.modalities, settings, 3);
  for (std::size_t i = 0; i < views.poses.size(); ++i) {
    CHECK(scaled_alike.poses[i].rows() == plain_views.poses[i].rows());
    CHECK(scaled_alike.poses[i] != plain_views.poses[i]);
  }
  // What hardly moved in the clips moves in the views that the scaling is learnt from.
  CHECK(set.modalities.pose_scale.deviation() != plain_set.modalities.pose_scale.deviation());
  CHECK(set.poses.size() == 2);
  CHECK(set.modalities.pose_features.skeleton().joints[5].offset ==
        canonical_humanoid().joints[5].offset);
}

TEST_CASE("gravity's error: the image and the heights stay, what is taken for level turns") {
  const Motion motion = humanoid_clip(10, 20, 30).motion;
  AugmentationSettings settings = nothing();
  double sum = 0;
  constexpr std::uint32_t kViews = 200;
  for (std::uint32_t i = 0; i < kViews; ++i) {
    const RandomKey key{9, i, 0, 0};
    settings.gravity_deg = 0;
    const AugmentedView truth = augmented_view(motion, kFps, {}, settings, key);
    settings.gravity_deg = 1.5;
    const AugmentedView view = augmented_view(motion, kFps, {}, settings, key);
    CHECK(view.track.x_px == truth.track.x_px);
    const Eigen::Matrix3d error =
        truth.camera.camera_from_world.transpose() * view.camera.camera_from_world;
    CHECK(std::abs(Eigen::AngleAxisd(error).axis().y()) < 1e-6);
    sum += angle_deg(error) * angle_deg(error) / kViews;
    if (i > 5) continue;
    const MatrixD was = joint_positions(truth.motion), is = joint_positions(view.motion);
    CHECK((was.col(1) - is.col(1)).cwiseAbs().maxCoeff() < 1e-6);
    for (int t = 0; t < motion.frames(); t += 20) {
      const MatrixD seen = truth.camera.camera_from_world * turns_of(truth.motion, t),
                    as_given = view.camera.camera_from_world * turns_of(view.motion, t);
      CHECK((seen - as_given).cwiseAbs().maxCoeff() < 1e-6);
    }
  }
  CHECK(std::sqrt(sum) == doctest::Approx(1.5).epsilon(0.15));
}

TEST_CASE("gravity's error: the heights stay where a node that never turns is above the hips") {
  Motion motion = humanoid_clip(10, 20, 30).motion;
  for (Joint& joint : motion.skeleton.joints) ++joint.parent;
  Joint scene;
  scene.name = "Scene";
  motion.skeleton.joints.insert(motion.skeleton.joints.begin(), scene);
  AugmentationSettings settings = nothing();
  const RandomKey key{9, 1, 0, 0};
  const AugmentedView truth = augmented_view(motion, kFps, {}, settings, key);
  settings.gravity_deg = 60;
  const AugmentedView view = augmented_view(motion, kFps, {}, settings, key);
  const MatrixD was = joint_positions(truth.motion), is = joint_positions(view.motion);
  CHECK((was.col(3 + 1) - is.col(3 + 1)).cwiseAbs().maxCoeff() < 1e-6);
  CHECK((was - is).cwiseAbs().maxCoeff() > 1);
  const auto seen = [](const AugmentedView& of) {
    return (of.camera.camera_from_world *
            forward_kinematics(of.motion.skeleton, of.motion.channels.row(40)).world_from_joint[1])
        .eval();
  };
  CHECK((seen(truth) - seen(view)).cwiseAbs().maxCoeff() < 1e-6);
}

}  // namespace new_poses_wiring_test
