#include "mcdbn/features/track_features.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion/synthetic_motion.hpp"
#include "shared_data.hpp"

using namespace mcdbn;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A root at the image's centre with joints at fixed positions around it, for 90 frames.
Track2d still_track() {
  Track2d track;
  track.joint_names = {"Extra", "Hand", "Hips", "Foot"};
  track.x_px = RowVectorD{{5, 960 + 30, 960, 960}}.replicate(90, 1);
  track.y_px = RowVectorD{{5, 540, 540, 540 + 40}}.replicate(90, 1);
  track.confidence = MatrixD::Ones(90, 4);
  return track;
}

const TrackFeatures kFeatures({"Hand", "Foot"}, "Hips");
const double kSize_px = std::sqrt((900 + 1600) / 2.0);

void lose(Track2d& track, const std::string& joint, int first, int count) {
  track.x_px.block(first, track.find(joint), count, 1).setConstant(kNan);
  track.y_px.block(first, track.find(joint), count, 1).setConstant(kNan);
  track.confidence.block(first, track.find(joint), count, 1).setZero();
}

bool all_nan(const MatrixD& values) {
  return values.array().isNaN().all();
}

}  // namespace

TEST_CASE(
    "track features: joints about the root over the body's size, then its position and size") {
  const MatrixD features = kFeatures.encode(still_track());
  REQUIRE(features.rows() == 90);
  REQUIRE(features.cols() == kFeatures.dimension());
  REQUIRE(kFeatures.dimension() == 7);
  CHECK(kFeatures.feature_names().size() == 7);
  for (const int frame : {0, 44, 89}) {
    CHECK(features(frame, 0) == doctest::Approx(30 / kSize_px));
    CHECK(features(frame, 1) == doctest::Approx(0));
    CHECK(features(frame, 2) == doctest::Approx(0));
    CHECK(features(frame, 3) == doctest::Approx(40 / kSize_px));
    CHECK(features(frame, 4) == doctest::Approx(0));
    CHECK(features(frame, 5) == doctest::Approx(0));
    CHECK(features(frame, 6) == doctest::Approx(std::log(kSize_px / 1080)));
  }
}

TEST_CASE("track features: neither image size nor the position in it changes the pose") {
  Track2d track = still_track();
  const MatrixD before = kFeatures.encode(track);
  track.x_px = (track.x_px * 0.5).array() + 100;
  track.y_px = (track.y_px * 0.5).array() - 50;
  track.width_px /= 2;
  track.height_px /= 2;
  const MatrixD after = kFeatures.encode(track);
  CHECK((after.leftCols(4) - before.leftCols(4)).norm() < 1e-9);
  CHECK((after.col(4).array() - before.col(4).array() - 100.0 / 540).abs().maxCoeff() < 1e-12);
  CHECK((after.col(5).array() - before.col(5).array() + 50.0 / 540).abs().maxCoeff() < 1e-12);
  CHECK((after.col(6) - before.col(6)).norm() < 1e-9);
}

TEST_CASE("track features: decoded, pixels come back wherever nothing was missing") {
  Track2d track = still_track();
  track.width_px = 1281;
  track.height_px = 720;
  track.fps = 24;
  for (int frame = 0; frame < 90; ++frame) {
    // Across the image, towards the camera, and a hand that waves.
    track.x_px.row(frame).array() += 3.0 * frame - 500;
    track.y_px.row(frame).array() -= 0.5 * frame;
    track.x_px(frame, track.find("Foot")) += 0.2 * frame;
    track.y_px(frame, track.find("Hand")) += 20 * std::sin(0.3 * frame);
  }
  const Track2d back = kFeatures.decode(kFeatures.encode(track), 24, 1281, 720);
  CHECK(back.joint_names == std::vector<std::string>{"Hips", "Hand", "Foot"});
  CHECK(back.fps == 24);
  CHECK(back.width_px == 1281);
  CHECK(back.height_px == 720);
  CHECK((back.confidence.array() == 1.0).all());
  REQUIRE(back.frames() == 90);
  for (const std::string& name : back.joint_names) {
    CAPTURE(name);
    const auto joint = back.find(name), same = track.find(name);
    // A few roundings of numbers up to a thousand.
    CHECK((back.x_px.col(joint) - track.x_px.col(same)).cwiseAbs().maxCoeff() < 1e-11);
    CHECK((back.y_px.col(joint) - track.y_px.col(same)).cwiseAbs().maxCoeff() < 1e-11);
  }
  // On an image twice as large everything is.
  const Track2d large = kFeatures.decode(kFeatures.encode(track), 24, 2562, 1440);
  CHECK((large.x_px - 2 * back.x_px).cwiseAbs().maxCoeff() < 1e-11);
  CHECK((large.y_px - 2 * back.y_px).cwiseAbs().maxCoeff() < 1e-11);
  CHECK_THROWS_AS(kFeatures.decode(MatrixD::Zero(3, 6), 24, 100, 100), ShapeError);
}

TEST_CASE("track features: the body's size follows an approach to the ends, but not the gait") {
  Track2d track = still_track();
  for (int frame = 0; frame < 90; ++frame) {
    // Doubles in three seconds, and swings by a tenth twice a second.
    const double approach = std::exp2(frame / 90.0);
    const double swing = std::exp(0.1 * std::sin(2 * M_PI * 2 * frame / 30.0));
    for (const char* name : {"Hand", "Foot"}) {
      double& x = track.x_px(frame, track.find(name));
      double& y = track.y_px(frame, track.find(name));
      x = 960 + (x - 960) * approach * swing;
      y = 540 + (y - 540) * approach * swing;
    }
  }
  const MatrixD features = kFeatures.encode(track);
  for (int frame = 0; frame < 90; ++frame) {
    const double expected = std::log(kSize_px * std::exp2(frame / 90.0) / 1080);
    const bool at_end = frame < 30 || frame >= 60;
    CAPTURE(frame);
    CHECK(std::abs(features(frame, 6) - expected) < (at_end ? 0.05 : 0.005));
  }
}

TEST_CASE("track features: short gaps are bridged, longer ones stay missing, both are counted") {
  Track2d track = still_track();
  for (int frame = 0; frame < 90; ++frame) track.x_px(frame, track.find("Hand")) += frame;
  const MatrixD whole = kFeatures.encode(track);
  lose(track, "Hand", 10, 6);  // 0.2 s at 30 fps
  lose(track, "Hand", 30, 7);
  lose(track, "Foot", 0, 3);
  lose(track, "Foot", 88, 2);
  track.confidence(50, track.find("Foot")) = 0;  // its numbers mean nothing
  track.x_px(50, track.find("Foot")) = 0;
  TrackFeatures::FillCount filled;
  const MatrixD features = kFeatures.encode(track, &filled);
  CHECK(filled.interpolated == 6 + 3 + 2 + 1);
  CHECK(filled.missing == 7);
  const auto pose_of = [](const MatrixD& values, int frame) {
    // Gaps move the body's size a little, as its joints share it: compare pixels again.
    return (values.row(frame).leftCols(4) * std::exp(values(frame, 6))).eval();
  };
  for (const int frame : {0, 10, 12, 15, 29, 37, 50, 89}) {
    CAPTURE(frame);
    CHECK((pose_of(features, frame) - pose_of(whole, frame)).norm() < 1e-9);
  }
  CHECK(all_nan(features.block(30, 0, 7, 2)));
  CHECK(features.block(30, 2, 7, 5).allFinite());
}

TEST_CASE("track features: a missing limb does not shrink the body") {
  Track2d track = still_track();
  lose(track, "Hand", 30, 30);
  const MatrixD features = kFeatures.encode(track);
  CHECK((features.col(6).array() - std::log(kSize_px / 1080)).abs().maxCoeff() < 1e-9);
}

TEST_CASE("track features: joints in no column are missing, and the body's size stays what it is") {
  Track2d track = still_track();
  const TrackFeatures features({"Hand", "Foot", "Extra"}, "Hips");
  track.x_px.col(0).setConstant(960 + 24);
  track.y_px.col(0).setConstant(540 - 32);
  const MatrixD whole = features.encode(track);
  // As over many clips: the feet do not move, the others do.
  RowVectorD deviation = RowVectorD::Zero(features.dimension());
  const RowVectorD usual = features.usual_squares(whole.row(0), deviation);
  REQUIRE(usual.size() == 3);
  CHECK(usual.sum() == doctest::Approx(3));
  deviation[0] = 0.5;
  CHECK(features.usual_squares(whole.row(0), deviation)[0] == doctest::Approx(usual[0] + 0.25));
  CHECK(features.usual_squares(whole.row(0), RowVectorD()).size() == 0);

  track.joint_names[3] = "Tail";  // the foot's
  TrackFeatures::FillCount filled;
  const MatrixD seen = features.encode(track, &filled, usual);
  CHECK(filled.unseen == std::vector<std::string>{"Foot"});
  CHECK(filled.missing == 0);
  CHECK(filled.interpolated == 0);
  CHECK(all_nan(seen.middleCols(2, 2)));
  for (const int column : {0, 1, 4, 5, 6, 7, 8})
    CHECK((seen.col(column) - whole.col(column)).cwiseAbs().maxCoeff() < 1e-9);
  // A column that is empty throughout counts as missing, too.
  Track2d empty = still_track();
  empty.x_px.col(0) = track.x_px.col(0);
  empty.y_px.col(0) = track.y_px.col(0);
  lose(empty, "Foot", 0, 90);
  TrackFeatures::FillCount of_empty;
  const MatrixD same = features.encode(empty, &of_empty, usual);
  CHECK(of_empty.unseen == filled.unseen);
  CHECK((same.array().isNaN() == seen.array().isNaN()).all());
  CHECK((same.rightCols<1>() - seen.rightCols<1>()).norm() < 1e-12);
  // Where the foot's usual distance is not given, it counts as 0.
  const MatrixD alone = features.encode(track);
  CHECK(alone(0, 8) == doctest::Approx(std::log(std::sqrt((900 + 1600) / 3.0) / 1080)));
  // Half of what is seen at all is enough for a size.
  Track2d half = track;
  lose(half, "Extra", 30, 30);
  CHECK(features.encode(half, nullptr, usual).col(8).allFinite());

  track.joint_names[0] = "Nose";
  CHECK_THROWS_WITH_AS(features.encode(track), doctest::Contains("Foot, Extra"), InputError);
}

TEST_CASE("track features: without the root there is nothing to measure from") {
  Track2d track = still_track();
  lose(track, "Hips", 40, 10);
  TrackFeatures::FillCount filled;
  const MatrixD features = kFeatures.encode(track, &filled);
  CHECK(filled.missing == 10);
  CHECK(all_nan(features.middleRows(40, 10)));
  CHECK(features.topRows(40).allFinite());
  CHECK(features.bottomRows(40).allFinite());
  lose(track, "Hips", 0, 90);
  CHECK(all_nan(kFeatures.encode(track)));
}

TEST_CASE("track features: which joints of a skeleton are worth tracking") {
  const Skeleton below = test::small_body_below_still_root();
  const TrackFeatures features = TrackFeatures::for_skeleton(test::small_body(), 0);
  const auto has = [](const TrackFeatures& f, const std::string& name) {
    return std::count(f.joint_names().begin(), f.joint_names().end(), name) == 1;
  };
  CHECK(features.root_name() == "Hips");
  CHECK(features.joint_names().size() == 12);
  CHECK_FALSE(has(features, "LHip"));  // at its parent's position
  CHECK_FALSE(has(features, "Hips"));  // the root itself
  CHECK(has(features, "Chest"));
  const TrackFeatures inner = TrackFeatures::for_skeleton(below, 1);
  CHECK(inner.root_name() == "Hips");
  CHECK_FALSE(has(inner, "World"));  // above the body
  CHECK(has(inner, "RHand"));
}

TEST_CASE("track features: names are checked, JSON keeps them") {
  CHECK_THROWS_WITH_AS(TrackFeatures({"Hand", "Tail"}, "Hips").encode(still_track()),
                       doctest::Contains("Tail"), InputError);
  CHECK_THROWS_AS(TrackFeatures({"Hand"}, "Pelvis").encode(still_track()), InputError);
  CHECK_THROWS_AS(TrackFeatures({"Hand", "Foot", "Hand"}, "Hips"), InputError);
  const TrackFeatures copy =
      TrackFeatures::from_json(nlohmann::json::parse(kFeatures.to_json().dump()), "track");
  CHECK(copy.joint_names() == kFeatures.joint_names());
  CHECK(copy.root_name() == "Hips");
  CHECK_THROWS_AS(TrackFeatures::from_json(nlohmann::json{{"joints", 3}}, "track"), InputError);
}

TEST_CASE("track features: real walks have no gaps and a size that moves slowly") {
  const char* relative = "cmu/walk/02_01.bvh";
  if (!test::have_shared_data(relative, "track features of a real walk")) return;
  const Motion motion = read_bvh(test::shared_data() / relative);
  const Track2d track = project_motion(motion, place_camera(motion, {}));
  TrackFeatures::FillCount filled;
  const MatrixD features = TrackFeatures::for_skeleton(motion.skeleton, 0).encode(track, &filled);
  CHECK(features.allFinite());
  CHECK(filled.interpolated == 0);
  CHECK(filled.missing == 0);
  const auto size = features.rightCols<1>();
  const MatrixD steps = size.bottomRows(size.rows() - 1) - size.topRows(size.rows() - 1);
  // At 120 fps a step of 0.02 would be a body that grows ten times in a second.
  CHECK(steps.cwiseAbs().maxCoeff() < 0.02);
}
