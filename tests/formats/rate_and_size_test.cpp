// The rate and the image's size where JSON and tables give them.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "formats/json_bodies.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace rate_and_size_test {

namespace {

constexpr int kFrames = 4, kJoints = 18, kWidth_px = 832, kHeight_px = 1216;

double x_of(int frame, int joint) {
  return 300 + 2 * frame + 10 * (joint % 5);
}
double y_of(int joint) {
  return 100 + 40 * joint;
}

/// In pixels, or as shares of the image.
Places places(int frame, bool shares = false) {
  Places joints;
  for (int joint = 0; joint < kJoints; ++joint)
    joints.push_back(
        {x_of(frame, joint) / (shares ? kWidth_px : 1), y_of(joint) / (shares ? kHeight_px : 1)});
  return joints;
}

/// A list of frames with these facts in each.
template <typename Content>
json frames_of(const Content& content, const json& facts = json::object()) {
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    frames.push_back(content(frame));
    frames.back().update(facts);
  }
  return frames;
}

json with_landmarks(int frame) {
  return {{"landmarks", landmarks_at(places(frame))}};
}

void check_size(const TrackReading& reading) {
  const Track2d& track = reading.people.front();
  CHECK(track.width_px == kWidth_px);
  CHECK(track.height_px == kHeight_px);
  CHECK(!any_notice(reading, "size"));
  for (int frame = 0; frame < kFrames; ++frame)
    CHECK(track.x_px(frame, 3) == doctest::Approx(x_of(frame, 3)));
}

}  // namespace

TEST_CASE("rate and size: the canvas of OpenPose's frames, in pixels and in shares") {
  const ScratchFolder folder;
  const json canvas{{"canvas_width", kWidth_px}, {"canvas_height", kHeight_px}};
  for (const bool shares : {false, true}) {
    CAPTURE(shares);
    const auto frame_of = [&](int frame) { return openpose_frame_at(places(frame, shares)); };
    const json frames = frames_of(frame_of, canvas);
    check_size(read_tracks(folder.write("film.json", frames.dump())));
    std::filesystem::create_directory(folder / "files");
    for (std::size_t i = 0; i < frames.size(); ++i)
      std::ofstream(folder / fmt::format("files/f{}.json", i)) << frames[i].dump();
    check_size(read_tracks(folder / "files"));
  }
}

TEST_CASE("rate and size: beside the frames, in an object there, and in each frame") {
  const ScratchFolder folder;
  const json facts{{"fps", 25}, {"width", kWidth_px}, {"height", kHeight_px}},
      of_video{{"frameRate", 25}, {"video_width", kWidth_px}, {"video_height", kHeight_px}},
      list{{"fps", 25}, {"image_size", {kWidth_px, kHeight_px}}},
      object{{"fps", 25}, {"image_size", {{"width", kWidth_px}, {"height", kHeight_px}}}};
  std::vector<json> films{frames_of(with_landmarks, facts), frames_of(with_landmarks, list)};
  for (json film : {facts, of_video, list, object, json{{"metadata", facts}},
                    json{{"video_info", facts}}, json{{"meta", list}}}) {
    film["frames"] = frames_of(with_landmarks);
    films.push_back(film);
  }
  for (json film : {facts, json{{"info", facts}}}) {
    film["instance_info"] = frames_of([](int frame) {
      return json{{"frame_id", frame}, {"instances", json::array({instance_at(places(frame))})}};
    });
    films.push_back(film);
  }
  for (const json& film : films) {
    CAPTURE(film.dump().substr(0, 80));
    const TrackReading reading = read_tracks(folder.write("film.json", film.dump()));
    check_size(reading);
    CHECK(reading.people.front().fps == 25);
    CHECK(!any_notice(reading, "rate"));
  }
}

TEST_CASE("rate and size: columns of a table") {
  const ScratchFolder folder;
  std::string columns = "frame,fps,width,height", rows = "frame,fps,width,height,landmark,x,y\n";
  for (int joint = 0; joint < kJoints; ++joint) columns += fmt::format(",L{0}_x,L{0}_y", joint);
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::string facts = fmt::format("{},25,{},{}", frame, kWidth_px, kHeight_px);
    columns += '\n' + facts;
    for (int joint = 0; joint < kJoints; ++joint) {
      columns += fmt::format(",{},{}", x_of(frame, joint), y_of(joint));
      rows += fmt::format("{},{},{},{}\n", facts, joint, x_of(frame, joint), y_of(joint));
    }
  }
  for (const std::string& text : {columns + '\n', rows}) {
    const TrackReading reading = read_tracks(folder.write("table.csv", text));
    check_size(reading);
    CHECK(reading.people.front().fps == 25);
    CHECK(!any_notice(reading, "rate"));
  }
}

TEST_CASE("rate and size: what changes from frame to frame is a box or the detector's speed") {
  const ScratchFolder folder;
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame)
    frames.push_back({{"landmarks", landmarks_at(places(frame))},
                      {"fps", 20 + frame},
                      {"width", 200 + frame},
                      {"height", 500}});
  const TrackReading reading = read_tracks(folder.write("film.json", frames.dump()));
  CHECK(reading.people.front().fps == 30);
  CHECK(any_notice(reading, "does not give its rate"));
  CHECK(any_notice(reading, "does not give the image's size"));
}

TEST_CASE("rate and size: a rate out of range beside the frames is an error") {
  const ScratchFolder folder;
  const json film{{"metadata", {{"fps", 0}}}, {"frames", frames_of(with_landmarks)}};
  CHECK_THROWS_WITH_AS(read_track(folder.write("film.json", film.dump())),
                       doctest::Contains("film.json: metadata: a rate or an image's size of 0"),
                       InputError);
}

}  // namespace rate_and_size_test
