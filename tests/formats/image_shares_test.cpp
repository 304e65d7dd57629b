// Whether coordinates are shares of the image, pixels, or a body in space: of whole files, and of
// the first frame of a track that grows.
#include "formats/image_shares.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/capture_bound.hpp"
#include "base/scratch_folder.hpp"
#include "formats/layout_samples.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/formats/track_lines.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace image_shares_test {

namespace {

constexpr ImageSize kImage{1280, 720};
constexpr int kRightFoot = 32, kNose = 0;

/// Each frame of a figure as MediaPipe's landmarks, where `place` puts a joint at these pixels.
template <typename Place>
json landmarks_of(const Track2d& figure, const Place& place) {
  json frames = json::array();
  for (int frame = 0; frame < figure.frames(); ++frame) {
    json landmarks = json::array();
    for (int joint = 0; joint < figure.joint_count(); ++joint) {
      const Eigen::Vector2d at = place(figure.x_px(frame, joint), figure.y_px(frame, joint), joint);
      landmarks.push_back({{"x", at.x()}, {"y", at.y()}, {"visibility", 0.9}});
    }
    json people = json::array();
    people.push_back(landmarks);
    frames.push_back(json{{"pose_landmarks", people}});
  }
  return frames;
}

Eigen::Vector2d share(double x_px, double y_px) {
  return {x_px / kImage.width_px, y_px / kImage.height_px};
}

TrackReadOptions of_image() {
  return {.fps = 30, .image_size = kImage};
}

}  // namespace

TEST_CASE("shares: a landmark that is guessed far outside does not make pixels of the others") {
  const ScratchFolder folder;
  const Track2d figure = sample_figure("MEDIAPIPE_33");
  json frames = landmarks_of(figure, [](double x, double y, int) { return share(x, y); });
  frames[0]["pose_landmarks"][0][kRightFoot]["y"] = 3.2;
  const Track2d track = read_track(folder.write("far.json", frames.dump()), of_image());
  CHECK(track.y_px(0, kRightFoot) == doctest::Approx(3.2 * kImage.height_px));
  CHECK(track.x_px.isApprox(figure.x_px, 1e-9));
  CHECK(track.y_px.bottomRows(3).isApprox(figure.y_px.bottomRows(3), 1e-9));

  TrackLines lines("pipe", of_image());
  for (int frame = 0; frame < figure.frames(); ++frame) {
    const auto read = lines.read(frames[static_cast<std::size_t>(frame)].dump());
    REQUIRE(read);
    CHECK(read->x_px.isApprox(figure.x_px.row(frame), 1e-9));
    CHECK(read->y_px[kNose] == doctest::Approx(figure.y_px(frame, kNose)));
  }
}

TEST_CASE("shares: a person at the edge of the image is in the image") {
  const ScratchFolder folder;
  const Track2d figure = sample_figure("MEDIAPIPE_33");
  // Half of the joints are left of the image, or head and arms above it.
  for (const auto& [left_px, up_px] : {std::pair{305.0, 0.0}, {0.0, 200.0}}) {
    CAPTURE_BOUND(left_px);
    const auto outside = [left = left_px, up = up_px](double x, double y, int) {
      return share(x - left, y - up);
    };
    const Track2d track =
        read_track(folder.write("edge.json", landmarks_of(figure, outside).dump()), of_image());
    CHECK((track.x_px.array() - (figure.x_px.array() - left_px)).abs().maxCoeff() < 1e-6);
    CHECK((track.y_px.array() - (figure.y_px.array() - up_px)).abs().maxCoeff() < 1e-6);
  }
}

TEST_CASE("shares: world landmarks, metres about the hips, are refused, also as they come") {
  const ScratchFolder folder;
  const Track2d figure = sample_figure("MEDIAPIPE_33");
  constexpr double kMetresOfPixel = 1.7 / 400, kHips_px = 450 - 0.53 * 400;
  const double middle_px = figure.x_px.row(0).mean();
  const auto front = [&](double x, double y, int) {
    return Eigen::Vector2d(kMetresOfPixel * (x - middle_px), kMetresOfPixel * (y - kHips_px));
  };
  // From its side, bent forward: nothing but a hip and the heels is left of the hips' middle.
  const auto side = [&](double, double y, int joint) {
    const bool is_behind = joint == 24 || joint == 29 || joint == 30;
    return Eigen::Vector2d(is_behind ? -0.05 : 0.2, kMetresOfPixel * (y - kHips_px));
  };
  for (const json& frames : {landmarks_of(figure, front), landmarks_of(figure, side)}) {
    CHECK_THROWS_WITH_AS(read_track(folder.write("world.json", frames.dump()), of_image()),
                         doctest::Contains("a body in space"), InputError);
    TrackLines lines("pipe", of_image());
    CHECK_THROWS_WITH_AS(lines.read(frames[0].dump()),
                         doctest::Contains("pipe:1: its coordinates lie about 0: a body in space"),
                         InputError);
    CHECK(!lines.knows_joints());
  }
}

TEST_CASE("shares: MMPose's bodies in space have scores, and are refused, also as they come") {
  const ScratchFolder folder;
  const Track2d figure = sample_figure("COCO_17");
  const auto frames_of = [&](const auto& numbers_of) {
    json frames = json::array();
    for (int frame = 0; frame < figure.frames(); ++frame) {
      json keypoints = json::array(), instances = json::array();
      for (int joint = 0; joint < figure.joint_count(); ++joint)
        keypoints.push_back(
            numbers_of(figure.x_px(frame, joint), figure.y_px(frame, joint), joint));
      const std::vector<double> scores(17, 4.5);  // as some networks overshoot
      instances.push_back({{"keypoints", keypoints}, {"keypoint_scores", scores}});
      frames.push_back({{"frame_id", frame}, {"instances", instances}});
    }
    return frames;
  };
  // x to the side, then the depth, both about the body, and the height, in metres.
  constexpr double kMetresOfPixel = 1.7 / 400;
  const double middle_px = figure.x_px.row(0).mean();
  const json space = frames_of([&](double x, double y, int joint) {
    const double depth = joint / 2 % 2 == 0 ? -0.1 : 0.1;
    return json{kMetresOfPixel * (x - middle_px), depth, kMetresOfPixel * (450 - y)};
  });
  CHECK_THROWS_WITH_AS(read_track(folder.write("space.json", space.dump()), of_image()),
                       doctest::Contains("points in space, not places in an image"), InputError);
  TrackLines lines("pipe", of_image());
  CHECK_THROWS_WITH_AS(lines.read(space[0].dump()), doctest::Contains("points in space"),
                       InputError);
  // A third number that is the score, or a share, makes no points in space of a person of whom the
  // picture shows the feet alone.
  for (const double third : {4.5, 0.5, -1.0}) {
    CAPTURE_BOUND(third);
    const json seen = frames_of([&](double x, double y, int) {
      return third < 0 ? json{x, y - 360} : json{x, y - 360, third};
    });
    const Track2d track = read_track(folder.write("seen.json", seen.dump()), of_image());
    CHECK((track.x_px.array() - figure.x_px.array()).abs().maxCoeff() < 1e-6);
    CHECK((track.y_px.array() - (figure.y_px.array() - 360)).abs().maxCoeff() < 1e-6);
  }
}

namespace {

/// A table with columns for each joint, with a depth and no confidence, or the other way round.
template <typename Place>
std::string columns_of(const Track2d& figure, bool depths, const Place& place) {
  std::string text = "frame";
  for (const std::string& name : figure.joint_names)
    text += fmt::format(",{0}_x,{0}_y,{0}_{1}", name, depths ? "z" : "visibility");
  for (int frame = 0; frame < figure.frames(); ++frame) {
    text += fmt::format("\n{}", frame);
    for (int joint = 0; joint < figure.joint_count(); ++joint) {
      const Eigen::Vector2d at = place(figure.x_px(frame, joint), figure.y_px(frame, joint));
      text += fmt::format(",{},{},0.5", at.x(), at.y());
    }
  }
  return text + '\n';
}

}  // namespace

TEST_CASE("pixels: points in space in millimetres are refused") {
  const ScratchFolder folder;
  const Track2d figure = sample_figure("MEDIAPIPE_33");
  const double left_px = figure.x_px.minCoeff(), middle_px = figure.x_px.mean();
  const auto beside = [&](double x, double y) {
    return Eigen::Vector2d(-4 * (x - left_px) - 100, 4 * y);
  };
  // About the origin, seen from above: x and y are of both signs.
  const auto about = [&](double x, double y) {
    return Eigen::Vector2d(4 * (x - middle_px), 4 * (x - middle_px) + y - 300);
  };
  for (const bool depths : {true, false})
    CHECK_THROWS_WITH_AS(
        read_track(folder.write("beside.csv", columns_of(figure, depths, beside)), of_image()),
        doctest::Contains("points in space"), InputError);
  CHECK_THROWS_WITH_AS(
      read_track(folder.write("about.csv", columns_of(figure, true, about)), of_image()),
      doctest::Contains("points in space"), InputError);
}

TEST_CASE("pixels: a person partly out of the picture is a track") {
  const ScratchFolder folder;
  const Track2d figure = sample_figure("MEDIAPIPE_33");
  const auto moved = [&](double right_px, double down_px) {
    return [=](double x, double y) { return Eigen::Vector2d(x + right_px, y + down_px); };
  };
  const auto check = [&](bool depths, double right_px, double down_px) {
    const Track2d track = read_track(
        folder.write("edge.csv", columns_of(figure, depths, moved(right_px, down_px))), of_image());
    CHECK((track.x_px.array() - (figure.x_px.array() + right_px)).abs().maxCoeff() < 1e-6);
    CHECK((track.y_px.array() - (figure.y_px.array() + down_px)).abs().maxCoeff() < 1e-6);
  };
  for (const bool depths : {true, false}) check(depths, -305, 0);  // half, as above
  check(false, 0, -360);                                           // all but the feet
}

TEST_CASE("shares: most of the joints that are seen decide") {
  const auto of = [](int small, int large) {
    SeenPerson person;
    for (int joint = 0; joint < small + large; ++joint) {
      person.x_px.push_back(joint < small ? 0.5 : 100);
      person.y_px.push_back(joint < small ? kLargestShare : 1);
      person.confidence.push_back(1);
    }
    // Whatever was not seen counts for neither.
    for (int joint = 0; joint < 10; ++joint) {
      person.x_px.push_back(0.1);
      person.y_px.push_back(0.1);
      person.confidence.push_back(0);
    }
    return are_shares({{person}}, false, "a.json");
  };
  CHECK(of(3, 2));
  CHECK(!of(2, 2));
  CHECK(!of(1, 3));
  CHECK(!of(0, 0));
}

}  // namespace image_shares_test
