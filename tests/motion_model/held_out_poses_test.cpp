// New poses of a training with a person held out: nothing of theirs is learnt from, and what judges
// shows them alone.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "corpus/fresh_views.hpp"
#include "corpus/humanoid_clips.hpp"
#include "corpus/no_augmentation.hpp"
#include "mcdbn/motion_model/training_schedule.hpp"

namespace held_out_poses_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

using enum JointRole;

/// The bends of three people's elbows, by which they are known. The last has the least data.
constexpr double kOne_deg = 10, kOther_deg = 40, kStranger_deg = 80;

LoadedClip clip_of(const char* person, double elbow_deg, int frames) {
  LoadedClip clip = humanoid_clip(elbow_deg, 20, 0, frames);
  clip.clip = {std::string("/") + person + ".bvh", person, {}, person};
  return clip;
}

struct Scene {
  ClipStore clips =
      std::vector<LoadedClip>{clip_of("one", kOne_deg, 90), clip_of("other", kOther_deg, 90),
                              clip_of("stranger", kStranger_deg, 60)};
  TrainingConfig config = settings();
  TrainingSet data = make_training_set(clips, config);

  static TrainingConfig settings() {
    TrainingConfig config;
    config.skeleton = SkeletonUse::humanoid;
    config.augment = nothing();
    config.augment.views = 8;
    config.augment.limbs_exchanged = 1;
    config.hold_out_among = 2;
    config.fine_tuning.windows = 6;
    return config;
  }

  /// Of both elbows in every tenth frame of standardized poses.
  std::vector<double> bends_deg(std::span<const MatrixF> poses) const {
    std::vector<double> bends;
    for (const MatrixF& pose : poses) {
      const MatrixD features = data.modalities.pose_scale.invert(pose);
      for (Eigen::Index t = 0; t < features.rows(); t += 10)
        for (const auto& [above, elbow] :
             {std::pair{left_shoulder, left_elbow}, std::pair{right_shoulder, right_elbow}})
          bends.push_back(
              angle_deg(turn(features.row(t), above).transpose() * turn(features.row(t), elbow)));
    }
    return bends;
  }

 private:
  /// camera_from_joint, of its first two columns.
  Eigen::Matrix3d turn(const RowVectorD& features, JointRole role) const {
    const std::vector<int>& joints = data.modalities.pose_features.joints();
    const auto found = std::ranges::find(joints, humanoid_roles().joint(role));
    REQUIRE(found != joints.end());
    const auto first = PoseFeatures::kBlock * (found - joints.begin());
    Eigen::Matrix3d turn;
    turn.col(0) = features.segment<3>(first).transpose();
    turn.col(1) = features.segment<3>(first + 3).transpose();
    turn.col(2) = turn.col(0).cross(turn.col(1));
    return turn;
  }
};

bool bends_by(double deg, double wanted_deg) {
  return std::abs(deg - wanted_deg) < 0.5;
}

/// The elbows are those of both others.
void check_not_the_stranger(const Scene& scene, std::span<const MatrixF> poses) {
  int of_one = 0, of_other = 0;
  for (const double deg : scene.bends_deg(poses)) {
    CHECK((bends_by(deg, kOne_deg) || bends_by(deg, kOther_deg)));
    of_one += bends_by(deg, kOne_deg);
    of_other += bends_by(deg, kOther_deg);
  }
  CHECK(of_one > 0);
  CHECK(of_other > 0);
}

void check_bends(const Scene& scene, const SequenceSource& source,
                 const std::optional<TrainingSet>& held_out_views) {
  check_not_the_stranger(scene, source.sequences().modalities[kPose].clips);
  REQUIRE(held_out_views);
  REQUIRE(!held_out_views->poses.empty());
  for (const double deg : scene.bends_deg(held_out_views->poses))
    CHECK(bends_by(deg, kStranger_deg));
}

}  // namespace

TEST_CASE(
    "views made beforehand have no limbs of the person held out, whose views have no others") {
  const Scene scene;
  const ViewSource views(scene.clips, scene.data, scene.config);
  check_bends(scene, views, views.held_out_views());
  CHECK(views.sequences().count() == 2 * 8);
  CHECK(views.held_out_views()->poses.size() == 8);
}

TEST_CASE("fresh views have no limbs of the person held out, whose views have no others") {
  Scene scene;
  scene.config.fine_tuning.view_uses = 12;
  const FreshViewSource views(scene.clips, scene.data, scene.config);
  check_bends(scene, views, views.held_out_views());
}

TEST_CASE("fresh views for others to learn from show nobody who is held out, by the seed") {
  Scene scene;
  scene.config.seed = 7;
  scene.config.fine_tuning.view_uses = 12;
  // So many frames a piece that a few make two hours, and that each clip is one.
  scene.config.fine_tuning.window_frames = 6600;
  const TrainingSet views = some_fresh_views(scene.clips, scene.data.modalities, scene.config);
  CHECK(views.poses.size() == 200'000 / frames_of_pieces(scene.config));
  CHECK(views.poses.size() > 5);
  check_not_the_stranger(scene, views.poses);
  PieceChoice pieces{.frames = frames_of_pieces(scene.config),
                     .groups_power = scene.config.fine_tuning.people_power};
  pieces.people.without = 2;
  const FreshViews as_seeded(scene.clips, scene.data.modalities, scene.config,
                             pose_pool_for(scene.clips, scene.config, pieces.people), 7, pieces);
  CHECK(views.poses[0] == as_seeded.make(0).pose);
  CHECK(views.tracks[0] == as_seeded.make(0).track);
}

TEST_CASE("views of which nobody is held out are of everybody") {
  Scene scene;
  scene.config.hold_out_among = 0;
  const ViewSource views(scene.clips, scene.data, scene.config);
  CHECK_FALSE(views.held_out_views());
  CHECK(views.sequences().count() == 3 * 8);
}

}  // namespace held_out_poses_test
