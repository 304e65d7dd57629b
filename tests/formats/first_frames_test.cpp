// Tracks that begin before anybody is in view, and where confidences stand in results that are
// nested one way or another.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/formats/track_lines.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace first_frames_test {

namespace {

constexpr int kJoints = 17;

double x_of(int frame, int joint) {
  return 200 + 3 * frame + 10 * (joint % 5);
}
double y_of(int joint) {
  return 100 + 20 * joint;
}
double score_of(int joint) {
  return 0.25 + 0.03125 * joint;
}

json mmpose_instance(int frame) {
  json keypoints = json::array(), scores = json::array();
  for (int joint = 0; joint < kJoints; ++joint) {
    keypoints.push_back({x_of(frame, joint), y_of(joint)});
    scores.push_back(score_of(joint));
  }
  return {{"keypoints", keypoints}, {"keypoint_scores", scores}, {"bbox_score", 0.9}};
}

json yolo_instance(int frame) {
  json x = json::array(), y = json::array(), visible = json::array();
  for (int joint = 0; joint < kJoints; ++joint) {
    x.push_back(x_of(frame, joint));
    y.push_back(y_of(joint));
    visible.push_back(score_of(joint));
  }
  return {{"name", "person"}, {"keypoints", {{"x", x}, {"y", y}, {"visible", visible}}}};
}

/// A list of one value; in braces it might be taken for the value itself.
json list_of(const json& value) {
  json list = json::array();
  list.push_back(value);
  return list;
}

std::string as_lines(const json& frames) {
  std::string text;
  for (const json& frame : frames) text += frame.dump() + "\n";
  return text;
}

/// Of three frames the first shows nobody.
void check_track(const TrackReading& reading) {
  const Track2d& track = reading.people.front();
  REQUIRE(track.joint_count() == kJoints);
  REQUIRE(track.frames() == 3);
  CHECK((track.confidence.row(0).array() == 0).all());
  for (int frame = 1; frame < 3; ++frame)
    for (int joint = 0; joint < kJoints; ++joint) {
      CHECK(track.x_px(frame, joint) == x_of(frame, joint));
      CHECK(track.confidence(frame, joint) == score_of(joint));
    }
}

struct Layout {
  std::string name;
  json empty;
  json (*frame)(int number);
};

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> all{
      {"instances", json::array(), [](int i) { return list_of(mmpose_instance(i)); }},
      {"a batch", list_of(json::array()),
       [](int i) { return list_of(list_of(mmpose_instance(i))); }},
      {"null", nullptr, [](int i) { return list_of(mmpose_instance(i)); }},
      {"predictions", json{{"predictions", list_of(json::array())}},
       [](int i) {
         return json{{"predictions", list_of(list_of(mmpose_instance(i)))}};
       }},
      {"frames", json{{"instances", json::array()}},
       [](int i) {
         return json{{"instances", list_of(mmpose_instance(i))}};
       }},
      {"YOLO", json::array(), [](int i) { return list_of(yolo_instance(i)); }},
  };
  return all;
}

}  // namespace

TEST_CASE("first frames: without a person they are frames, and scores are confidences") {
  const ScratchFolder folder;
  for (const Layout& layout : layouts()) {
    CAPTURE(layout.name);
    const json frames = json::array({layout.empty, layout.frame(1), layout.frame(2)});
    // A first line of null is no JSON lines.
    for (const std::string& text :
         {frames.dump(), layout.empty.is_null() ? frames.dump() : as_lines(frames)}) {
      const TrackReading reading = read_tracks(folder.write("track.json", text));
      CHECK(reading.format == "mmpose");
      check_track(reading);
    }
  }
}

TEST_CASE("first frames: lists of people are OpenPose's by the keys of the first person") {
  const ScratchFolder folder;
  const auto film = [](const char* people, const char* body, bool flat, int first) {
    json frames = json::array();
    for (int frame = first; frame < 3; ++frame) {
      json joints = json::array(), persons = json::array();
      for (int joint = 0; joint < kJoints; ++joint) {
        const json numbers{x_of(frame, joint), y_of(joint), score_of(joint)};
        if (flat)
          joints.insert(joints.end(), numbers.begin(), numbers.end());
        else
          joints.push_back(numbers);
      }
      if (frame > 0) persons.push_back({{"track_id", 3}, {body, joints}});
      frames.push_back({{"frame", frame}, {people, persons}});
    }
    return frames;
  };
  const auto read = [&](const json& content) {
    return read_tracks(folder.write("people.json", content.dump()));
  };
  for (const char* people : {"people", "persons"}) {
    CAPTURE(std::string(people));
    const json frames = film(people, "keypoints", false, 0);
    for (const json& content : {frames, json{{"frames", frames}}}) {
      const TrackReading reading = read(content);
      CHECK(reading.format == "mediapipe");
      check_track(reading);
    }
    const TrackReading at_once = read(film(people, "keypoints", false, 1));
    CHECK(at_once.format == "mediapipe");
    REQUIRE(at_once.people.front().frames() == 2);
    CHECK(at_once.people.front().x_px(0, 0) == x_of(1, 0));
  }
  for (const char* body : {"pose_keypoints_2d", "pose_keypoints"}) {
    CAPTURE(std::string(body));
    const TrackReading reading = read(film("people", body, true, 0));
    CHECK(reading.format == "openpose");
    check_track(reading);
  }
}

TEST_CASE("first frames: instances under the numbers of frames") {
  const ScratchFolder folder;
  json frames = json::object();
  for (int frame = 0; frame < 3; ++frame)
    frames[std::to_string(frame)] = frame == 0 ? json::array() : list_of(mmpose_instance(frame));
  const TrackReading reading = read_tracks(folder.write("track.json", frames.dump()));
  CHECK(reading.format == "mmpose");
  check_track(reading);
}

TEST_CASE("first frames: a whole film's keypoints and scores at once") {
  const ScratchFolder folder;
  json one{{"keypoints", list_of(json::array())}, {"scores", list_of(json::array())}},
      several = one;
  for (int frame = 1; frame < 3; ++frame) {
    const json instance = mmpose_instance(frame);
    one["keypoints"].push_back(instance["keypoints"]);
    one["scores"].push_back(instance["keypoint_scores"]);
    several["keypoints"].push_back(list_of(instance["keypoints"]));
    several["scores"].push_back(list_of(instance["keypoint_scores"]));
  }
  for (const json& film : {one, several}) {
    const TrackReading reading = read_tracks(folder.write("film.json", film.dump()));
    CHECK(reading.format == "mmpose");
    check_track(reading);
  }
}

TEST_CASE("first frames: lists of landmarks with their scores beside them") {
  const ScratchFolder folder;
  for (const char* key : {"keypoint_scores", "scores"}) {
    json one = json::array({json{{"landmarks", json::array()}}}), several = one;
    for (int frame = 1; frame < 3; ++frame) {
      const json instance = mmpose_instance(frame);
      one.push_back(json{{"landmarks", instance["keypoints"]}, {key, instance["keypoint_scores"]}});
      several.push_back(json{{"landmarks", list_of(instance["keypoints"])},
                             {key, list_of(instance["keypoint_scores"])}});
    }
    for (const json& frames : {one, several}) {
      const TrackReading reading = read_tracks(folder.write("track.json", frames.dump()));
      CHECK(reading.format == "mediapipe");
      check_track(reading);
    }
    one[1][key].erase(0);
    CHECK_THROWS_WITH_AS(read_tracks(folder.write("track.json", one.dump())),
                         doctest::Contains("16 scores of 17 joints"), InputError);
  }
}

TEST_CASE("first frames: a track that grows may begin before anybody is in view") {
  const TrackReadOptions options{.fps = 30, .image_size = ImageSize{640, 480}};
  for (const Layout& layout : layouts())
    for (const std::string& empty :
         {std::string("[]"), std::string("{}"), std::string(R"({"pose_landmarks": []})"),
          std::string(R"({"frame": 0, "time_s": 0.5, "people": [], "masks": null})"),
          layout.empty.dump()}) {
      CAPTURE(layout.name);
      CAPTURE(empty);
      TrackLines lines("pipe", options);
      for (int frame = 0; frame < 3; ++frame) {
        const auto unseen = lines.read(empty);
        REQUIRE(unseen);
        CHECK(unseen->joints() == 0);
        CHECK(!lines.knows_joints());
      }
      const auto seen = lines.read(layout.frame(1).dump());
      REQUIRE(seen);
      REQUIRE(lines.knows_joints());
      for (int joint = 0; joint < kJoints; ++joint)
        CHECK(seen->confidence[joint] == score_of(joint));
      const auto unseen = lines.read(empty);
      REQUIRE(unseen);
      CHECK(unseen->joints() == kJoints);
      CHECK(unseen->confidence.sum() == 0);
    }
  // What shows something, but nothing that is known, is still refused.
  for (const char* other : {R"({"what": 1})", R"({"markers": [[1, 2, 3]], "errors": []})"}) {
    CAPTURE(other);
    TrackLines lines("pipe", options);
    CHECK_THROWS_WITH_AS(lines.read(other), doctest::Contains("pipe:1: "), InputError);
  }
}

TEST_CASE("first frames: null where MediaPipe found nobody, and in the landmarks of somebody") {
  const ScratchFolder folder;
  json landmarks = json::array();
  for (int joint = 0; joint < kJoints; ++joint)
    landmarks.push_back(json{{"x", x_of(1, joint) / 640},
                             {"y", y_of(joint) / 480},
                             {"visibility", score_of(joint)},
                             {"presence", nullptr},
                             {"name", nullptr}});
  const json nobody{{"pose_landmarks", nullptr}}, somebody{{"pose_landmarks", list_of(landmarks)}};
  const TrackReadOptions options{.fps = 30, .image_size = ImageSize{640, 480}};
  const std::string text = nobody.dump() + "\n" + somebody.dump() + "\n";
  const Track2d track = read_track(folder.write("track.jsonl", text), options);
  TrackLines lines("pipe", options);
  REQUIRE(lines.read(nobody.dump()));
  CHECK(!lines.knows_joints());
  const auto seen = lines.read(somebody.dump());
  REQUIRE(seen);
  REQUIRE(seen->joints() == kJoints);
  REQUIRE(track.frames() == 2);
  CHECK(track.confidence.row(0).sum() == 0);
  for (int joint = 0; joint < kJoints; ++joint) {
    CHECK(track.confidence(1, joint) == score_of(joint));
    CHECK(seen->confidence[joint] == score_of(joint));
    CHECK(seen->x_px[joint] == doctest::Approx(x_of(1, joint)));
  }
}

TEST_CASE("first frames: a file that shows nobody is named as such") {
  const ScratchFolder folder;
  for (const char* text : {"[]", "[[], []]", R"([{"pose_landmarks": []}, {"pose_landmarks": []}])",
                           R"([{"frame_id": 1, "instances": []}])", R"({"people": []})"}) {
    CAPTURE(text);
    CHECK_THROWS_WITH_AS(read_track(folder.write("nobody.json", text)),
                         doctest::Contains("nobody.json: no person in any frame"), InputError);
  }
}

TEST_CASE("first frames: a folder's joints are called as its first file calls them") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "images");
  json names = json::object();
  std::vector<std::string> animal;
  for (int joint = 0; joint < kJoints; ++joint) {
    animal.push_back(fmt::format("Paw {}", joint));
    names[std::to_string(joint)] = animal.back();
  }
  for (int frame = 0; frame < 3; ++frame) {
    const json people = frame == 0 ? json::array() : list_of(mmpose_instance(frame));
    const json content{{"meta_info", {{"keypoint_id2name", names}}}, {"instance_info", people}};
    std::ofstream(folder / fmt::format("images/results_{}.json", frame)) << content.dump();
  }
  const TrackReading reading = read_tracks(folder / "images");
  CHECK(reading.format == "mmpose");
  CHECK(reading.people.front().joint_names == animal);
  check_track(reading);
}

TEST_CASE("first frames: files whose names begin with a dot are no frames") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "images");
  for (int frame = 0; frame < 3; ++frame) {
    const json people = frame == 0 ? json::array() : list_of(mmpose_instance(frame));
    std::ofstream(folder / fmt::format("images/frame_{}.json", frame)) << people.dump();
    // As macOS writes beside them.
    std::ofstream(folder / fmt::format("images/._frame_{}.json", frame)) << std::string(8, '\0');
  }
  const TrackReading reading = read_tracks(folder / "images");
  CHECK(reading.format == "mmpose");
  check_track(reading);
}

}  // namespace first_frames_test
