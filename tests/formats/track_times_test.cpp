// Times of frames in tables and JSON: they give the rate and, where frames have no numbers, the
// frames in which nobody was found.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/scratch_folder.hpp"
#include "formats/json_bodies.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace track_times_test {

namespace {

constexpr int kFrames = 86, kJoints = 17;
constexpr double kRate_hz = 25;

/// The frames without a person, which the files leave out.
bool is_left_out(int frame) {
  return frame >= 20 && frame < 30;
}

double x_of(int frame, int joint) {
  return 300 + 2 * frame + 10 * (joint % 5);
}
double y_of(int joint) {
  return 100 + 20 * joint;
}

Places places(int frame) {
  Places joints;
  for (int joint = 0; joint < kJoints; ++joint) joints.push_back({x_of(frame, joint), y_of(joint)});
  return joints;
}

std::string columns_header() {
  std::string header;
  for (int joint = 0; joint < kJoints; ++joint) header += fmt::format(",L{0}_x,L{0}_y", joint);
  return header + '\n';
}

std::string columns_row(int frame, double right_px = 0) {
  std::string row;
  for (int joint = 0; joint < kJoints; ++joint)
    row += fmt::format(",{},{}", x_of(frame, joint) + right_px, y_of(joint));
  return row + '\n';
}

/// A name for the time, and how many of its units make a second.
struct Time {
  std::string name;
  double units_per_s;

  double of(int frame) const { return units_per_s * frame / kRate_hz; }
};

std::string columns_film(const Time& time) {
  std::string text = time.name + columns_header();
  for (int frame = 0; frame < kFrames; ++frame)
    if (!is_left_out(frame)) text += fmt::format("{}", time.of(frame)) + columns_row(frame);
  return text;
}

std::string rows_film(const Time& time) {
  std::string text = time.name + ",landmark,x,y\n";
  for (int frame = 0; frame < kFrames; ++frame)
    for (int joint = 0; joint < kJoints && !is_left_out(frame); ++joint)
      text += fmt::format("{},{},{},{}\n", time.of(frame), joint, x_of(frame, joint), y_of(joint));
  return text;
}

/// @param content of a frame, an object, by its places
template <typename Content>
std::string json_film(const Time& time, const Content& content) {
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    if (is_left_out(frame)) continue;
    frames.push_back(content(places(frame)));
    frames.back()[time.name] = time.of(frame);
  }
  return frames.dump();
}

json landmarks_frame(const Places& places) {
  return {{"landmarks", landmarks_at(places)}};
}

/// Every frame is in its place, those that were left out too.
void check_places(const TrackReading& reading) {
  const Track2d& track = reading.people.front();
  REQUIRE(track.frames() == kFrames);
  for (int frame = 0; frame < kFrames; ++frame) {
    CAPTURE(frame);
    if (is_left_out(frame))
      CHECK(track.confidence.row(frame).sum() == 0);
    else
      CHECK(track.x_px(frame, 0) == x_of(frame, 0));
  }
}

void check_film(const TrackReading& reading) {
  check_places(reading);
  CHECK(reading.people.front().fps == doctest::Approx(kRate_hz));
  CHECK(!any_notice(reading, "rate"));
  CHECK(!any_notice(reading, "times"));
}

}  // namespace

TEST_CASE("track times: they give the rate and the frames that are left out") {
  const ScratchFolder folder;
  for (const Time& time : {Time{"timestamp", 1}, Time{"timestamp", 1e3}, Time{"timestamp", 1e6},
                           Time{"ts", 1e9}, Time{"time_s", 1}, Time{"timestamp_ms", 1e3},
                           Time{"timeMs", 1e3}, Time{"Time (ms)", 1e3}}) {
    CAPTURE(time.name);
    CAPTURE(time.units_per_s);
    check_film(read_tracks(folder.write("columns.csv", columns_film(time))));
    check_film(read_tracks(folder.write("rows.csv", rows_film(time))));
    for (const auto& content : {landmarks_frame, instance_at, openpose_frame_at})
      check_film(read_tracks(folder.write("film.json", json_film(time, content))));
  }
}

TEST_CASE("track times: seconds that are the keys of frames") {
  const ScratchFolder folder;
  json film = json::object();
  for (int frame = 0; frame < kFrames; ++frame)
    if (!is_left_out(frame))
      film[fmt::format("{:.3f}", frame / kRate_hz)] = landmarks_at(places(frame));
  check_film(read_tracks(folder.write("film.json", film.dump())));
}

TEST_CASE("track times: whole milliseconds of 30 frames a second, and a long gap") {
  const ScratchFolder folder;
  std::string text = "timestamp_ms,track_id" + columns_header();
  for (const int frame : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 90, 91, 92})
    text += fmt::format("{},7", frame * 1000 / 30) + columns_row(frame);
  const Track2d track = read_track(folder.write("columns.csv", text));
  REQUIRE(track.frames() == 93);
  CHECK(track.x_px(90, 0) == x_of(90, 0));
  CHECK(track.fps == 30);
}

TEST_CASE("track times: a rate that is not whole stays") {
  const ScratchFolder folder;
  std::string text = "timestamp_ms" + columns_header();
  for (int frame = 0; frame < 60; ++frame)
    text += fmt::format("{:.2f}", frame * 1001.0 / 30) + columns_row(frame);
  const Track2d track = read_track(folder.write("columns.csv", text));
  CHECK(track.fps == doctest::Approx(30 / 1.001).epsilon(1e-5));
}

TEST_CASE("track times: a rate that is given as an option holds, and frames keep their places") {
  const ScratchFolder folder;
  const Time time{"timestamp", 1};
  for (const std::string& text : {columns_film(time), json_film(time, landmarks_frame)}) {
    const TrackReading reading = read_tracks(folder.write("film", text), {.fps = 50});
    check_places(reading);
    CHECK(reading.people.front().fps == 50);
  }
}

TEST_CASE("track times: beside numbers of frames they give the rate alone") {
  const ScratchFolder folder;
  std::string table = "frame,timestamp" + columns_header();
  json frames = json::array();
  // Every fifth frame of 25 a second: they are taken one after the other, five a second.
  for (int i = 0; i < 6; ++i) {
    table += fmt::format("{},{}", 5 * i, 0.2 * i) + columns_row(i);
    frames.push_back(
        {{"frame", 5 * i}, {"timestamp", 0.2 * i}, {"landmarks", landmarks_at(places(i))}});
  }
  for (const std::string& text : {table, frames.dump()}) {
    const TrackReading reading = read_tracks(folder.write("film", text));
    CHECK(reading.frame_numbers == std::vector<long long>{0, 5, 10, 15, 20, 25});
    CHECK(reading.people.front().fps == doctest::Approx(5));
  }
}

TEST_CASE("track times: two people in a table share them") {
  const ScratchFolder folder;
  std::string text = "timestamp,track_id" + columns_header();
  for (int frame = 0; frame < 20; ++frame)
    for (const int person : {1, 2})
      text += fmt::format("{},{}", frame / kRate_hz, person) + columns_row(frame, 600 * person);
  const TrackReading reading = read_tracks(folder.write("two.csv", text));
  CHECK(reading.people_seen == 2);
  CHECK(reading.people.front().frames() == 20);
  CHECK(reading.people.front().fps == doctest::Approx(kRate_hz));
}

TEST_CASE("track times: those that do not rise are reported, and frames are as they come") {
  const ScratchFolder folder;
  std::string table = "timestamp" + columns_header();
  json frames = json::array();
  for (const double time_s : {0.0, 0.04, 0.04, 0.08}) {
    const int frame = static_cast<int>(frames.size());
    table += fmt::format("{}", time_s) + columns_row(frame);
    frames.push_back({{"timestamp", time_s}, {"landmarks", landmarks_at(places(frame))}});
  }
  for (const std::string& text : {table, frames.dump()}) {
    const TrackReading reading = read_tracks(folder.write("film", text));
    REQUIRE(reading.people.front().frames() == 4);
    CHECK(reading.people.front().x_px(3, 0) == x_of(3, 0));
    CHECK(reading.people.front().fps == 30);
    CHECK(any_notice(reading, "its times, 'timestamp', do not rise"));
  }
}

TEST_CASE("track times: another rate than that of the file, and one that no film has") {
  const ScratchFolder folder;
  json frames = json::array(), slow = json::array();
  for (int frame = 0; frame < 5; ++frame) {
    frames.push_back({{"time_s", frame / kRate_hz}, {"landmarks", landmarks_at(places(frame))}});
    slow.push_back({{"time_s", 100 * frame}, {"landmarks", landmarks_at(places(frame))}});
  }
  const json film{{"fps", 50}, {"frames", frames}};
  const TrackReading other = read_tracks(folder.write("film.json", film.dump()));
  CHECK(other.people.front().fps == doctest::Approx(kRate_hz));
  CHECK(any_notice(other, "the file gives 50 frames a second, its times make 25"));
  const TrackReading none = read_tracks(folder.write("slow.json", slow.dump()));
  CHECK(none.people.front().fps == 30);
  CHECK(any_notice(none, "its times make 0.01 frames a second"));
}

TEST_CASE("track times: a list's OpenPose frames are those that it numbers") {
  const ScratchFolder folder;
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    if (is_left_out(frame)) continue;
    frames.push_back(openpose_frame_at(places(frame)));
    frames.back()["frame"] = frame;
  }
  check_places(read_tracks(folder.write("film.json", frames.dump())));
}

}  // namespace track_times_test
