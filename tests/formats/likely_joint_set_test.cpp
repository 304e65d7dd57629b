// Which of two joint sets with the same count of joints people show, whole and in part, from all
// sides.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "formats/figure_track.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/formats/track_lines.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace likely_joint_set_test {

namespace {

using Choice = std::function<bool(const Keypoint&)>;

/// How far a walker's joint is before the body, at the end of a step, in body heights.
double swing_of(JointRole role) {
  switch (role) {
    case JointRole::left_elbow:
      return 0.06;
    case JointRole::left_wrist:
      return 0.14;
    case JointRole::left_knee:
      return -0.1;
    case JointRole::left_ankle:
      return -0.22;
    case JointRole::left_toe:
      return -0.15;
    default:
      return role > JointRole::left_toe ? -swing_of(other_side(role)) : 0;
  }
}

/// Where the walker's place is, in body heights: to the left, up, and before the body at that phase
/// of a step.
Eigen::Vector3d place_in_walker(const Keypoint& keypoint, double phase) {
  const auto joint = [&](JointRole role) {
    const Eigen::Vector2d at = place_in_figure(role);
    return Eigen::Vector3d(at.x(), at.y(), phase * swing_of(role));
  };
  if (keypoint.role) return joint(*keypoint.role) + keypoint.offset;
  return (joint(keypoint.halfway->first) + joint(keypoint.halfway->second)) / 2;
}

struct View {
  double azimuth_deg = 0;
  ImageSize image{1920, 1080};
  bool shares = false;
};

/// Frames of a walker of 500 px, as lists of [x, y, confidence]; what is not seen is [0, 0, 0].
json walker(const std::string& set, const View& view, const Choice& is_seen) {
  const double azimuth = view.azimuth_deg * std::numbers::pi / 180;
  json frames = json::array();
  for (const double phase : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
    json person = json::array();
    for (const Keypoint& keypoint : joint_set(set).keypoints) {
      if (!is_seen(keypoint)) {
        person.push_back({0, 0, 0});
        continue;
      }
      const Eigen::Vector3d at = place_in_walker(keypoint, phase);
      const double x = 300 + 500 * (at.x() * std::cos(azimuth) + at.z() * std::sin(azimuth)),
                   y = 550 - 500 * at.y();
      person.push_back({view.shares ? x / view.image.width_px : x,
                        view.shares ? y / view.image.height_px : y, 0.8});
    }
    frames.push_back(person);
  }
  return frames;
}

std::string read_as(const std::string& set, const View& view, const Choice& is_seen) {
  const ScratchFolder folder;
  return read_tracks(folder.write("walker.json", walker(set, view, is_seen).dump()),
                     {.image_size = view.image})
      .joint_set;
}

bool is_one_of(const Keypoint& keypoint, std::initializer_list<JointRole> lefts) {
  return std::ranges::any_of(lefts, [&](JointRole left) {
    return keypoint.role == left || keypoint.role == other_side(left);
  });
}
bool is_arm(const Keypoint& keypoint) {
  return is_one_of(keypoint,
                   {JointRole::left_shoulder, JointRole::left_elbow, JointRole::left_wrist});
}
bool is_hip(const Keypoint& keypoint) {
  return is_one_of(keypoint, {JointRole::left_hip, JointRole::pelvis});
}
bool is_below_hips(const Keypoint& keypoint) {
  return is_one_of(keypoint, {JointRole::left_knee, JointRole::left_ankle, JointRole::left_toe});
}

struct Part {
  std::string name;
  Choice is_seen;
};

const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"whole", [](const Keypoint&) { return true; }},
      {"without hips", [](const Keypoint& k) { return !is_hip(k); }},
      {"to the knees",
       [](const Keypoint& k) {
         return !is_one_of(k, {JointRole::left_ankle, JointRole::left_toe});
       }},
      {"waist up", [](const Keypoint& k) { return !is_below_hips(k); }},
      {"above the hips", [](const Keypoint& k) { return !is_below_hips(k) && !is_hip(k); }},
      {"legs", [](const Keypoint& k) { return is_below_hips(k) || is_hip(k); }},
      {"arms and hips", [](const Keypoint& k) { return is_arm(k) || is_hip(k); }},
      {"arms", is_arm},
  };
  return all;
}

/// Joint sets of one count, the usual one first.
const std::vector<std::vector<std::string>> kPairs{{"COCO_17", "H36M_17"}, {"BODY_25", "BODY_25B"}};

}  // namespace

TEST_CASE("likely joint set: the usual one's people are known in every part, from all sides") {
  for (const auto& pair : kPairs)
    for (const Part& part : parts())
      for (const double azimuth_deg : {0, 30, 60, 90, 135, 180, 270})
        for (const bool shares : {false, true}) {
          CAPTURE(pair[0]);
          CAPTURE(part.name);
          CAPTURE(azimuth_deg);
          CAPTURE(shares);
          const View view{azimuth_deg, {1280, 720}, shares};
          CHECK(read_as(pair[0], view, part.is_seen) == pair[0]);
        }
}

TEST_CASE("likely joint set: the other one's are, whole and where enough is seen of them") {
  for (const auto& pair : kPairs)
    for (const Part& part : parts())
      for (const double azimuth_deg : {0, 30, 60, 90, 135, 180, 270})
        for (const bool shares : {false, true}) {
          if (part.name == "arms") continue;  // six joints, of BODY_25B not enough from the side
          CAPTURE(pair[1]);
          CAPTURE(part.name);
          CAPTURE(azimuth_deg);
          CAPTURE(shares);
          const View view{azimuth_deg, {1280, 720}, shares};
          CHECK(read_as(pair[1], view, part.is_seen) == pair[1]);
        }
}

TEST_CASE("likely joint set: shares are measured in pixels, of an upright image too") {
  for (const auto& pair : kPairs)
    for (const std::string& set : pair)
      for (const ImageSize& image : {ImageSize{720, 1280}, ImageSize{3840, 1080}}) {
        CAPTURE(set);
        CAPTURE(image.width_px);
        CHECK(read_as(set, {30, image, true}, [](const Keypoint&) { return true; }) == set);
      }
  // Arms from the side, which in shares of this image are 3.6 times as long as they are wide.
  CHECK(read_as("COCO_17", {90, {3840, 1080}, true}, is_arm) == "COCO_17");
}

TEST_CASE("likely joint set: a head alone, and nobody, are of the usual set") {
  const auto is_head = [](const Keypoint& keypoint) { return keypoint.role == JointRole::head; };
  for (const double azimuth_deg : {0, 45, 90, 135, 180})
    CHECK(read_as("COCO_17", {azimuth_deg}, is_head) == "COCO_17");
  CHECK(read_as("H36M_17", {}, [](const Keypoint&) { return false; }) == "COCO_17");
}

TEST_CASE("likely joint set: a track that grows knows it by the first frame that shows a person") {
  for (const auto& pair : kPairs)
    for (const std::string& set : pair)
      for (const Part& part : parts()) {
        if (part.name == "arms") continue;
        CAPTURE(set);
        CAPTURE(part.name);
        const View view{30, {1280, 720}, true};
        TrackLines lines("pipe", {.fps = 30, .image_size = view.image});
        const json frames = walker(set, view, part.is_seen);
        REQUIRE(lines.read("[]"));
        REQUIRE(lines.read(json{{"landmarks", frames[2]}}.dump()));
        REQUIRE(lines.knows_joints());
        const auto& names = lines.like().joint_names;
        REQUIRE(joint_set_of(names) != nullptr);
        CHECK(joint_set_of(names)->name == set);
      }
}

}  // namespace likely_joint_set_test
