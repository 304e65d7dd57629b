// What a report is given of each clip, and a clip's score by hand.

#include <doctest/doctest.h>

#include "comparison/comparison_run.hpp"
#include "comparison/report_clips.hpp"
#include "device/every_device.hpp"
#include "mcdbn/evaluation/pearson.hpp"
#include "motion/body_size.hpp"
#include "motion_model/clip_scene.hpp"

namespace report_clips_test {

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

EncodedClip truth_of(const Motion& motion, const std::filesystem::path& file) {
  EncodedClip clip;
  clip.file = file;
  clip.motion = motion;
  clip.camera = place_camera(motion, {50, 20, std::nullopt, 45, 800, 601});
  clip.track = project_motion(motion, clip.camera);
  clip.root_position = path_of(motion, "Hips");
  return clip;
}

/// The same motion with one arm turned further, and the root elsewhere.
Motion changed(Motion motion, double turn_deg, const Eigen::RowVector3d& shift) {
  const int arm = motion.skeleton.first_channel(motion.skeleton.find("LArm"));
  motion.channels.col(arm + 2).array() += turn_deg;
  const int hips = motion.skeleton.first_channel(motion.skeleton.find("Hips"));
  motion.channels.middleCols(hips, 3).rowwise() += RowVectorD(shift);
  return motion;
}

/// Joints that are judged: all but the root and LHip, which stands where the root does.
std::vector<std::string> judged_joints() {
  std::vector<std::string> names;
  for (const Joint& joint : small_body().joints)
    if (joint.name != "Hips" && joint.name != "LHip") names.push_back(joint.name);
  return names;
}

double largest(const MatrixD& difference) {
  return difference.cwiseAbs().maxCoeff();
}

Model model_of(Device& device) {
  const Modalities modalities = modalities_of({swinging(small_body(), 30)}, {});
  return {random_network(device, modalities), modalities, {}, {}};
}

}  // namespace

TEST_CASE("a clip's score: every figure by hand") {
  const Motion motion = swinging(small_body(), 40);
  const EncodedClip truth = truth_of(motion, "x.bvh");
  const Motion other = changed(motion, 40, {3, 0, -4});
  const ClipScore score = score_clip(truth, other, "Hips");
  const double mm = 1000.0 / file_units_per_metre(motion.skeleton);
  const auto names = judged_joints();
  const MatrixD real = mm * joints_about(motion, names, "Hips"),
                made = mm * joints_about(other, names, "Hips");
  double distances = 0;
  for (Eigen::Index t = 0; t < 40; ++t)
    for (Eigen::Index c = 0; c < real.cols(); c += 3)
      distances += (real.block<1, 3>(t, c) - made.block<1, 3>(t, c)).norm();
  CHECK(score.error.mpjpe_mm ==
        doctest::Approx(distances / (40.0 * static_cast<double>(names.size()))));
  CHECK(score.root_mm == doctest::Approx(5.0 * mm));
  CHECK(score.mpjae_deg == doctest::Approx(2 * 40.0 / 13));  // arm and hand, of all but the chest
  CHECK(score.pcc_flat == doctest::Approx(pearson_flat(real, made)));
  MatrixD real_seen = real, made_seen = made;
  for (Eigen::Index t = 0; t < 40; ++t)
    for (Eigen::Index c = 0; c < real.cols(); c += 3)
      for (MatrixD* seen : {&real_seen, &made_seen}) {
        const Eigen::Vector3d point = seen->block<1, 3>(t, c).transpose();
        seen->block<1, 3>(t, c) = (truth.camera.camera_from_world * point).transpose();
      }
  const double strict = pearson_per_channel(real_seen, made_seen);
  CHECK(score.pcc_channel == doctest::Approx(strict));
  CHECK(std::abs(strict - pearson_per_channel(real, made)) > 1e-6);  // the axes matter
  CHECK(score.bone_length_spread_mm < 1e-6);
  // Velocities over a frame.
  double speeds = 0;
  for (Eigen::Index t = 1; t < 40; ++t)
    for (Eigen::Index c = 0; c < real.cols(); c += 3)
      speeds += ((real.block<1, 3>(t, c) - made.block<1, 3>(t, c)) -
                 (real.block<1, 3>(t - 1, c) - made.block<1, 3>(t - 1, c)))
                    .norm() *
                30.0;
  CHECK(score.error.mpjve_mm_s ==
        doctest::Approx(speeds / (39.0 * static_cast<double>(names.size()))));
  const FootSlide slide =
      foot_slide(mm * joint_positions(motion), mm * joint_positions(other),
                 {motion.skeleton.find("LFoot"), motion.skeleton.find("RFoot")}, 30.0);
  CHECK(score.foot_slide.planted == slide.planted);

  const ClipScore perfect = score_clip(truth, motion, "Hips");
  CHECK(perfect.pcc_flat == doctest::Approx(1));
  CHECK(perfect.pcc_channel == doctest::Approx(1));
  CHECK(perfect.error.mpjpe_mm < 1e-9);
  CHECK(perfect.root_mm < 1e-9);
  CHECK(perfect.mpjae_deg < 1e-6);
}

TEST_CASE("a clip's score: an answer on another body is judged at the truth's joints") {
  const Motion motion = swinging(small_body(), 40);
  Motion other = motion;
  // Here it stands where its parent does, there it does not.
  other.skeleton.joints[static_cast<std::size_t>(motion.skeleton.find("LHip"))].offset.x() += 2;
  const ClipScore score = score_clip(truth_of(motion, "x.bvh"), other, "Hips");
  const auto names = judged_joints();
  const auto places = [&](const Motion& one) -> MatrixD {
    return 1000.0 / file_units_per_metre(one.skeleton) * joints_about(one, names, "Hips");
  };
  const MatrixD off = places(other) - places(motion);
  double distances = 0;
  for (Eigen::Index t = 0; t < 40; ++t)
    for (Eigen::Index c = 0; c < off.cols(); c += 3) distances += off.block<1, 3>(t, c).norm();
  CHECK(distances > 0);
  CHECK(score.error.mpjpe_mm ==
        doctest::Approx(distances / (40.0 * static_cast<double>(names.size()))));
}

TEST_CASE("a clip's score: an answer in other units is as far off") {
  const Motion motion = swinging(small_body(), 40);
  Motion other = changed(motion, 40, {3, 0, -4});
  const EncodedClip truth = truth_of(motion, "x.bvh");
  const ClipScore same = score_clip(truth, other, "Hips");
  for (Joint& joint : other.skeleton.joints) joint.offset *= 10;
  for (int joint = 0, column = 0; joint < other.skeleton.joint_count(); ++joint)
    for (const Channel channel : other.skeleton.joints[static_cast<std::size_t>(joint)].channels) {
      if (!is_rotation(channel)) other.channels.col(column) *= 10;
      ++column;
    }
  const ClipScore score = score_clip(truth, other, "Hips");
  CHECK(score.root_mm == doctest::Approx(same.root_mm));
  CHECK(score.error.mpjpe_mm == doctest::Approx(same.error.mpjpe_mm));
}

TEST_CASE("what a report is given of a clip") {
  const Motion motion = swinging(small_body(), 6);
  on_every_device([&](Device& device) {
    const Model model = model_of(device);
    ClipResult result;
    result.truth = truth_of(motion, "walk/08_01.bvh");
    result.seen.joints = result.truth.track;
    result.trained_on = true;
    result.known_person = "08";
    for (const double turn : {10.0, 20.0}) {
      ScoredAnswer sample{changed(motion, turn, {1, 2, 3}), {}};
      sample.score.root_mm = turn;
      result.samples.push_back(sample);
    }
    result.other_answers["mean_pose"] = {changed(motion, 30, {0, 0, 0}), {}};
    result.other_answers["mean_pose"].score.root_mm = 30;
    const auto clips = report_clips(model, {result}, true);
    REQUIRE(clips.size() == 1);
    const ReportClip& clip = clips[0];
    CHECK(clip.name == "08_01");
    CHECK(clip.action == "walk");
    CHECK(clip.trained_on);
    CHECK(clip.known_person == "08");
    CHECK(clip.fps == doctest::Approx(30));
    CHECK(clip.width_px == 800);
    CHECK(clip.height_px == 601);
    // The root, the judged joints, then the ends of limbs.
    std::vector<std::string> names{"Hips"};
    for (const std::string& name : judged_joints()) names.push_back(name);
    CHECK(clip.joints == static_cast<int>(names.size()));
    const auto joints = static_cast<Eigen::Index>(names.size());
    std::vector<std::string> points = names;
    points.emplace_back("Neck end");
    CHECK(clip.point_names == points);
    const auto index_of = [&](const std::string& name) {
      return static_cast<int>(std::find(points.begin(), points.end(), name) - points.begin());
    };
    REQUIRE(clip.parents.size() == points.size());
    CHECK(clip.parents[0] == -1);
    CHECK(clip.parents[static_cast<std::size_t>(index_of("LLeg"))] == 0);  // past LHip
    CHECK(clip.parents[static_cast<std::size_t>(index_of("LShin"))] == index_of("LLeg"));
    CHECK(clip.parents[static_cast<std::size_t>(index_of("LHand"))] == index_of("LArm"));
    CHECK(clip.parents[static_cast<std::size_t>(index_of("Neck end"))] == index_of("Neck"));
    // In the world, in mm on a 1.7 m body.
    const double mm = 1000.0 / file_units_per_metre(motion.skeleton);
    const auto check_points = [&](const MatrixD& got, const Motion& of) {
      REQUIRE(got.cols() == 3 * joints + 3);
      for (std::size_t i = 0; i < names.size(); ++i)
        CHECK(largest(got.middleCols(3 * static_cast<Eigen::Index>(i), 3) -
                      mm * path_of(of, names[i])) < 1e-6);
      // 20 units from the neck, as the end site has it.
      const MatrixD end =
          got.rightCols(3) - got.middleCols(3 * static_cast<Eigen::Index>(index_of("Neck")), 3);
      CHECK(largest(end.rowwise().norm().array() - 20 * mm) < 1e-6);
    };
    check_points(clip.truth_mm, motion);
    REQUIRE(clip.samples.size() == 2);
    for (std::size_t s = 0; s < 2; ++s) {
      check_points(clip.samples[s].points_mm, result.samples[s].motion);
      CHECK(clip.samples[s].score.root_mm == 10.0 * static_cast<double>(s + 1));
    }
    REQUIRE(clip.others.count("mean_pose") == 1);
    CHECK(clip.others.size() == 1);
    check_points(clip.others.at("mean_pose").points_mm, result.other_answers["mean_pose"].motion);
    CHECK(clip.others.at("mean_pose").score.root_mm == 30.0);
    REQUIRE(clip.track_px.cols() == 2 * joints);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const int column = result.truth.track.find(names[i]);
      const auto at = 2 * static_cast<Eigen::Index>(i);
      CHECK(clip.track_px.col(at) == result.truth.track.x_px.col(column));
      CHECK(clip.track_px.col(at + 1) == result.truth.track.y_px.col(column));
    }
  });
}

TEST_CASE("clips are put under actions by their folders, or all together; names are unique") {
  const Motion motion = swinging(small_body(), 3);
  on_every_device([&](Device& device) {
    const Model model = model_of(device);
    std::vector<ClipResult> results;
    for (const char* file : {"a/walk/01.bvh", "a/jump/01.bvh", "b/jump/01.bvh", "a/walk/02.bvh"}) {
      results.emplace_back();
      results.back().truth = truth_of(motion, file);
    }
    const auto by_folder = report_clips(model, results, true);
    const std::vector<std::string> actions{"walk", "jump", "jump", "walk"},
        names{"01", "jump/01", "b/jump/01", "02"};
    const auto together = report_clips(model, results, false);
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(by_folder[i].action == actions[i]);
      CHECK(together[i].action == "all clips");
      CHECK_FALSE(by_folder[i].trained_on);
      CHECK(by_folder[i].known_person == "");
      CHECK(by_folder[i].name == names[i]);
      CHECK(together[i].name == names[i]);
    }
  });
}

}  // namespace report_clips_test
