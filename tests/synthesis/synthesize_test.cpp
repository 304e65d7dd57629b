#include "mcdbn/synthesis/synthesize.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"

using namespace mcdbn;

namespace {

constexpr double kBallHeight = 2.0;  // of the ToeBase joint when the foot stands

SynthesisOptions clip_of(SynthesisAction action, int subject = 1, int clip = 1) {
  SynthesisOptions options;
  options.action = action;
  options.subject = subject;
  options.clip = clip;
  return options;
}

std::string name_of(SynthesisAction action) {
  return std::string(synthesis_action_name(action));
}

Eigen::Vector3d position(const MatrixD& positions, int frame, int joint) {
  return positions.row(frame).segment<3>(3 * joint).transpose();
}

/// Mean and largest horizontal speed of the balls of the feet while they are on the ground, cm/s.
struct Slide {
  double mean_cm_s = 0, planted_fraction = 0;
};

Slide slide_of(const Motion& motion) {
  const MatrixD positions = joint_positions(motion);
  double sum = 0, planted = 0;
  for (const char* name : {"LeftToeBase", "RightToeBase"}) {
    const int toe = motion.skeleton.find(name);
    for (int frame = 1; frame < motion.frames(); ++frame) {
      const Eigen::Vector3d from = position(positions, frame - 1, toe);
      const Eigen::Vector3d to = position(positions, frame, toe);
      constexpr double kTouch_cm = 0.3;
      if (std::max(std::abs(from.y() - kBallHeight), std::abs(to.y() - kBallHeight)) > kTouch_cm) {
        continue;
      }
      sum += std::hypot(to.x() - from.x(), to.z() - from.z()) * motion.fps();
      ++planted;
    }
  }
  return {sum / planted, planted / (2.0 * (motion.frames() - 1))};
}

/// Lowest of heels, balls and toe tips of all frames.
double lowest_foot_point(const Motion& motion) {
  double lowest = 1e9;
  for (int frame = 0; frame < motion.frames(); ++frame) {
    const WorldPose pose = forward_kinematics(motion.skeleton, motion.channels.row(frame));
    for (const char* side : {"Left", "Right"}) {
      const int foot = motion.skeleton.find(std::string(side) + "Foot");
      const int toe = motion.skeleton.find(std::string(side) + "ToeBase");
      const Joint& toe_joint = motion.skeleton.joints[toe];
      const Eigen::Vector3d heel(0, toe_joint.offset.y() - kBallHeight, -6);
      lowest = std::min(
          {lowest, pose.position[toe].y(),
           (pose.position[foot] + pose.world_from_joint[foot] * heel).y(),
           (pose.position[toe] + pose.world_from_joint[toe] * toe_joint.end_sites.at(0)).y()});
    }
  }
  return lowest;
}

double root_travel(const Motion& motion) {
  const auto from = motion.channels.row(0), to = motion.channels.row(motion.frames() - 1);
  return std::hypot(to(0) - from(0), to(2) - from(2));
}

}  // namespace

TEST_CASE("synthesis is decided by its options alone") {
  for (const SynthesisAction action : synthesis_actions()) {
    CAPTURE(name_of(action));
    const SynthesisOptions options = clip_of(action);
    const Motion motion = synthesize(options);
    CHECK(motion.channels == synthesize(options).channels);
    CHECK(motion.frames() == 240);
    CHECK(motion.fps() == doctest::Approx(30));
    SynthesisOptions other_clip = options, other_subject = options, other_seed = options;
    other_clip.clip = 2;
    other_subject.subject = 2;
    other_seed.seed = 2;
    for (const SynthesisOptions& other : {other_clip, other_subject, other_seed}) {
      const Motion different = synthesize(other);
      CHECK((motion.channels - different.channels).cwiseAbs().mean() > 0.3);
    }
  }
}

TEST_CASE("a subject keeps the body in every action and clip, others have another") {
  const Motion walk = synthesize(clip_of(SynthesisAction::walk, 3, 1));
  const Motion clap = synthesize(clip_of(SynthesisAction::clap, 3, 2));
  CHECK(bvh_header_text(walk.skeleton) == bvh_header_text(clap.skeleton));
  std::set<std::string> bodies;
  for (int subject = 1; subject <= 10; ++subject) {
    const Motion motion = synthesize(clip_of(SynthesisAction::clap, subject));
    bodies.insert(bvh_header_text(motion.skeleton));
    const double height = motion.skeleton.rest_height(1);
    CHECK(height > 145);
    CHECK(height < 195);
  }
  CHECK(bodies.size() == 10);
}

TEST_CASE("bodies move as bodies can") {
  for (const SynthesisAction action : synthesis_actions()) {
    for (int subject = 1; subject <= 4; ++subject) {
      CAPTURE(name_of(action));
      CAPTURE(subject);
      const Motion motion = synthesize(clip_of(action, subject, subject));
      const Skeleton& skeleton = motion.skeleton;
      REQUIRE(motion.channels.allFinite());
      for (const char* side : {"Left", "Right"}) {
        // Knees and elbows are hinges: one angle of theirs moves, and only to one side.
        const int knee = skeleton.first_channel(skeleton.find(std::string(side) + "Leg"));
        CHECK(motion.channels.col(knee).cwiseAbs().maxCoeff() < 1e-6);
        CHECK(motion.channels.col(knee + 1).minCoeff() > 0);
        CHECK(motion.channels.col(knee + 1).maxCoeff() < 140);
        CHECK(motion.channels.col(knee + 2).cwiseAbs().maxCoeff() < 1e-6);
        const int elbow = skeleton.first_channel(skeleton.find(std::string(side) + "ForeArm"));
        const double inwards = side[0] == 'L' ? -1 : 1;
        CHECK((inwards * motion.channels.col(elbow + 2)).minCoeff() > 0);
        CHECK((inwards * motion.channels.col(elbow + 2)).maxCoeff() < 150);
      }
      CHECK(lowest_foot_point(motion) > -0.5);
      const Slide slide = slide_of(motion);
      CHECK(slide.mean_cm_s < 2);
      CHECK(slide.planted_fraction > 0.3);
      // No angle of a joint runs round, and none leaps within a frame.
      const int frames = motion.frames();
      const MatrixD steps =
          motion.channels.bottomRows(frames - 1) - motion.channels.topRows(frames - 1);
      CHECK(steps.rightCols(steps.cols() - 3).cwiseAbs().maxCoeff() < 80);
    }
  }
}

TEST_CASE("walking looks like walking") {
  for (int subject = 1; subject <= 5; ++subject) {
    CAPTURE(subject);
    const Motion motion = synthesize(clip_of(SynthesisAction::walk, subject));
    const double speed_cm_s = root_travel(motion) / 8;
    CHECK(speed_cm_s > 80);
    CHECK(speed_cm_s < 180);
    const int knee = motion.skeleton.first_channel(motion.skeleton.find("LeftLeg")) + 1;
    CHECK(motion.channels.col(knee).maxCoeff() > 50);  // swings through bent
    CHECK(motion.channels.col(knee).minCoeff() < 10);  // stands straight
    const auto height = motion.channels.col(1);
    CHECK(height.maxCoeff() - height.minCoeff() > 2);
    CHECK(height.maxCoeff() - height.minCoeff() < 9);
    // Feet keep their sides: neither crosses the other's track.
    const MatrixD positions = joint_positions(motion);
    const int left = motion.skeleton.find("LeftFoot"), right = motion.skeleton.find("RightFoot");
    double crossed = 0;
    for (int frame = 0; frame + 15 < motion.frames(); ++frame) {
      const Eigen::Vector3d along =
          position(positions, frame + 15, 0) - position(positions, frame, 0);
      const Eigen::Vector3d to_left = Eigen::Vector3d(along.z(), 0, -along.x()).normalized();
      const double gap =
          (position(positions, frame, left) - position(positions, frame, right)).dot(to_left);
      crossed += gap < 1 ? 1 : 0;
    }
    CHECK(crossed / motion.frames() < 0.05);
  }
}

TEST_CASE("each action does what its name means") {
  const auto reach_over_head = [](const Motion& motion, const char* hand) {
    const MatrixD positions = joint_positions(motion);
    const int wrist = motion.skeleton.find(hand), head = motion.skeleton.find("Head");
    return (positions.col(3 * wrist + 1) - positions.col(3 * head + 1)).maxCoeff();
  };
  const auto toe_height = [](const Motion& motion) {
    const MatrixD positions = joint_positions(motion);
    const auto left = positions.col(3 * motion.skeleton.find("LeftToeBase") + 1);
    const auto right = positions.col(3 * motion.skeleton.find("RightToeBase") + 1);
    return left.cwiseMin(right).maxCoeff() - kBallHeight;  // both feet off the ground
  };
  const auto hands_gap = [](const Motion& motion) {
    const MatrixD positions = joint_positions(motion);
    const int left = motion.skeleton.find("LeftHand"), right = motion.skeleton.find("RightHand");
    const auto gap = positions.middleCols<3>(3 * left) - positions.middleCols<3>(3 * right);
    return gap.rowwise().norm().minCoeff();
  };
  const Motion jump = synthesize(clip_of(SynthesisAction::jump));
  CHECK(toe_height(jump) > 10);
  const Motion jacks = synthesize(clip_of(SynthesisAction::jumping_jacks));
  CHECK(toe_height(jacks) > 2);
  CHECK(reach_over_head(jacks, "LeftHand") > 0);
  CHECK(reach_over_head(jacks, "RightHand") > 0);
  const Motion one = synthesize(clip_of(SynthesisAction::wave_one));
  CHECK(reach_over_head(one, "RightHand") > -15);
  CHECK(reach_over_head(one, "LeftHand") < -40);
  const Motion two = synthesize(clip_of(SynthesisAction::wave_two));
  CHECK(reach_over_head(two, "RightHand") > -15);
  CHECK(reach_over_head(two, "LeftHand") > -15);
  const Motion clap = synthesize(clip_of(SynthesisAction::clap));
  CHECK(hands_gap(clap) < 8);
  CHECK(toe_height(clap) < 1);
  const Motion thrown = synthesize(clip_of(SynthesisAction::throw_object));
  const MatrixD positions = joint_positions(thrown);
  const int hand = 3 * thrown.skeleton.find("RightHand");
  double fastest = 0;
  for (int frame = 1; frame < thrown.frames(); ++frame) {
    fastest = std::max(fastest,
                       (positions.row(frame) - positions.row(frame - 1)).segment<3>(hand).norm());
  }
  CHECK(fastest * thrown.fps() > 500);
}

TEST_CASE("synthesized clips survive the file") {
  const Motion motion = synthesize(clip_of(SynthesisAction::throw_object));
  const Motion back = parse_bvh(bvh_text(motion), "throw");
  CHECK((motion.channels - back.channels).cwiseAbs().maxCoeff() < 1e-4);
}

TEST_CASE("synthesis names its actions and refuses what it cannot do") {
  for (const SynthesisAction action : synthesis_actions()) {
    CHECK(parse_synthesis_action(synthesis_action_name(action)) == action);
  }
  CHECK(synthesis_file_name(clip_of(SynthesisAction::wave_one, 2, 11)) == "wave-one_s02_11.bvh");
  CHECK_THROWS_WITH_AS(parse_synthesis_action("swim"),
                       "no action is called 'swim': choose one of walk, jump, jumping-jacks, "
                       "wave-one, wave-two, clap, throw",
                       ConfigError);
  SynthesisOptions options;
  options.fps = 0;
  CHECK_THROWS_AS(synthesize(options), ConfigError);
  options = {};
  options.seconds = NAN;
  CHECK_THROWS_AS(synthesize(options), ConfigError);
  options = {};
  options.subject = 0;
  CHECK_THROWS_AS(synthesize(options), ConfigError);
}

TEST_CASE("synthesis works at other lengths and rates") {
  for (const SynthesisAction action : synthesis_actions()) {
    for (const double fps : {24.0, 120.0}) {
      CAPTURE(name_of(action));
      SynthesisOptions options = clip_of(action);
      options.fps = fps;
      options.seconds = fps > 100 ? 3 : 0.5;
      const Motion motion = synthesize(options);
      CHECK(motion.frames() == std::lround(options.seconds * fps));
      CHECK(motion.channels.allFinite());
      CHECK(lowest_foot_point(motion) > -0.5);
    }
  }
}
