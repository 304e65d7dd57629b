// What is called in one way or another beside a landmark's x and y: confidences, and places in
// space.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "formats/field_names.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace landmark_fields_test {

namespace {

constexpr int kJoints = 17, kHidden = 9;

double x_of(int joint) {
  return 300 + 10 * (joint % 5);
}
double y_of(int joint) {
  return 100 + 20 * joint;
}
double confidence_of(int joint) {
  return joint == kHidden ? 0 : 0.75;
}

/// @param confidence the key of its confidence  @param key the body's
json frame_with(const std::string& confidence, const std::string& key) {
  json list = json::array();
  for (int joint = 0; joint < kJoints; ++joint)
    list.push_back({{"x", x_of(joint)}, {"y", y_of(joint)}, {confidence, confidence_of(joint)}});
  return {{key, list}};
}

json points() {
  json list = json::array();
  for (int joint = 0; joint < kJoints; ++joint) list.push_back({x_of(joint), y_of(joint)});
  return list;
}

std::vector<double> confidences() {
  std::vector<double> values;
  for (int joint = 0; joint < kJoints; ++joint) values.push_back(confidence_of(joint));
  return values;
}

void check_hidden(const Track2d& track) {
  REQUIRE(track.joint_count() == kJoints);
  for (int joint = 0; joint < kJoints; ++joint)
    CHECK(track.confidence(0, joint) == confidence_of(joint));
}

/// A table of MediaPipe's landmarks, which are behind the words `before` and before `after`.
std::string world_table(bool world, const std::string& before, const std::string& after) {
  std::string header = "frame", row = "0";
  for (int joint = 0; joint < kJoints; ++joint) {
    header += fmt::format(",L{0}_x,L{0}_y,L{0}_visibility", joint);
    row += fmt::format(",{},{},0.75", x_of(joint) / 1920, y_of(joint) / 1080);
  }
  for (int joint = 0; joint < kJoints && world; ++joint) {
    header += fmt::format(",{1}L{0}{2}_x,{1}L{0}{2}_y,{1}L{0}{2}_z", joint, before, after);
    row += fmt::format(",{},{},0.1", 0.05 * (joint % 5) - 0.1, 0.1 * joint - 0.8);
  }
  return header + '\n' + row + '\n';
}

}  // namespace

TEST_CASE("landmark fields: a confidence under each of its names, in JSON and in tables") {
  const ScratchFolder folder;
  for (const std::string name : kConfidenceNames) {
    CAPTURE(name);
    std::string columns = "frame", rows = "frame,landmark,x,y," + name + '\n', row = "0";
    for (int joint = 0; joint < kJoints; ++joint) {
      columns += fmt::format(",L{0}_x,L{0}_y,L{0}_{1}", joint, name);
      row += fmt::format(",{},{},{}", x_of(joint), y_of(joint), confidence_of(joint));
      rows += fmt::format("0,{},{},{},{}\n", joint, x_of(joint), y_of(joint), confidence_of(joint));
    }
    check_hidden(read_track(folder.write("columns.csv", columns + '\n' + row + '\n')));
    check_hidden(read_track(folder.write("rows.csv", rows)));
    for (const char* key : {"landmarks", "keypoints", "joints", "poses"})
      check_hidden(
          read_track(folder.write("film.json", json::array({frame_with(name, key)}).dump())));
  }
}

TEST_CASE("landmark fields: `visible` may be true or false") {
  const ScratchFolder folder;
  json list = json::array();
  for (int joint = 0; joint < kJoints; ++joint)
    list.push_back({{"x", x_of(joint)}, {"y", y_of(joint)}, {"visible", joint != kHidden}});
  const Track2d track =
      read_track(folder.write("film.json", json::array({json{{"landmarks", list}}}).dump()));
  for (int joint = 0; joint < kJoints; ++joint)
    CHECK(track.confidence(0, joint) == (joint == kHidden ? 0 : 1));
}

TEST_CASE("landmark fields: a list of confidences beside the landmarks, as long as they are") {
  const ScratchFolder folder;
  for (const char* key : {"confidences", "conf", "confidence", "keypoints_conf",
                          "keypoint_confidence", "landmark_scores", "visibilities"}) {
    CAPTURE(std::string(key));
    const json one{{"landmarks", points()}, {key, confidences()}};
    check_hidden(read_track(folder.write("film.json", json::array({one, one}).dump())));
    json several{{"landmarks", json::array({points()})}, {key, json::array({confidences()})}};
    // One of each body is none of its joints'.
    several[key == std::string("conf") ? "confidence" : "conf"] = json::array({0.5});
    check_hidden(read_track(folder.write("film.json", json::array({several}).dump())));
    const json other{{"landmarks", points()}, {key, {0.25}}};
    CHECK(
        (read_track(folder.write("film.json", json::array({other}).dump())).confidence.array() == 1)
            .all());
  }
}

TEST_CASE("landmark fields: one score of each person leaves the joints their own") {
  const ScratchFolder folder;
  json left = json::array(), right = json::array();
  for (int joint = 0; joint < kJoints; ++joint) {
    left.push_back({x_of(joint), y_of(joint), confidence_of(joint)});
    right.push_back({x_of(joint) + 600, y_of(joint), confidence_of(joint)});
  }
  for (const char* key : {"keypoints", "landmarks"}) {
    CAPTURE(std::string(key));
    const json frame{{key, json::array({left, right})}, {"scores", {0.9, 0.8}}};
    const TrackReading reading = read_tracks(
        folder.write("film.json", json::array({frame, frame}).dump()), {.person = "all"});
    REQUIRE(reading.people.size() == 2);
    for (const Track2d& track : reading.people) check_hidden(track);
  }
}

TEST_CASE("landmark fields: a table's places in space are left out beside those in the image") {
  const ScratchFolder folder;
  const TrackReading alone = read_tracks(folder.write("alone.csv", world_table(false, "", "")));
  for (const auto& [before, after] :
       {std::pair{"world_", ""}, std::pair{"", "_world"}, std::pair{"pose_world_landmark_", ""}}) {
    const std::string text = world_table(true, before, after);
    CAPTURE(text.substr(text.size() / 4, 60));
    const TrackReading both = read_tracks(folder.write("both.csv", text));
    CHECK(both.joint_set == alone.joint_set);
    CHECK(both.people.front().x_px == alone.people.front().x_px);
    CHECK(both.people.front().y_px == alone.people.front().y_px);
    CHECK(both.people.front().confidence == alone.people.front().confidence);
  }
}

TEST_CASE("landmark fields: JSON of nothing but world landmarks is refused as such") {
  const ScratchFolder folder;
  for (const char* key : {"pose_world_landmarks", "worldLandmarks"}) {
    json frame = frame_with("visibility", key);
    for (const json& film : {json::array({json{{key, json::array()}}, frame}), frame}) {
      CAPTURE(film.dump().substr(0, 40));
      CHECK_THROWS_WITH_AS(read_track(folder.write("world.json", film.dump())),
                           doctest::Contains("points in space (world landmarks, metres)"),
                           InputError);
    }
    // Beside the image's landmarks they are left out.
    frame.update(frame_with("visibility", "landmarks"));
    check_hidden(read_track(folder.write("both.json", json::array({frame}).dump())));
  }
}

}  // namespace landmark_fields_test
