// What files give of people, rates, frames and confidences, each where another reading would do for
// the layouts' figures.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/capture_bound.hpp"
#include "base/npy.hpp"
#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace {

constexpr int kDetailFrames = 6;

/// x, y, confidence of 17 joints about a place.
json body(double x) {
  json numbers = json::array();
  for (int joint = 0; joint < 17; ++joint)
    for (const double value : {x + 3.0 * joint, 100.0 + 20 * (joint % 5), 0.9})
      numbers.push_back(value);
  return numbers;
}

json detail_points(double x) {
  json list = json::array();
  const json numbers = body(x);
  for (std::size_t i = 0; i < numbers.size(); i += 3) list.push_back({numbers[i], numbers[i + 1]});
  return list;
}

/// Where person `who` of two is in a frame: they change places in each, as no one who is followed
/// would.
double place_of(int who, int frame) {
  return (who + frame) % 2 == 0 ? 200 : 900;
}

std::string lists_of_people(const std::string& format) {
  json list = json::array();
  for (int frame = 0; frame < kDetailFrames; ++frame) {
    json instances = json::array();
    // Not always in the same order.
    for (const int who : {frame / 2 % 2, 1 - frame / 2 % 2}) {
      const double x = place_of(who, frame);
      if (format == "alphapose")
        list.push_back({{"image_id", fmt::format("{}.jpg", frame)},
                        {"keypoints", body(x)},
                        {"idx", {who + 1.0}}});
      if (format == "coco")
        list.push_back({{"image_id", frame}, {"keypoints", body(x)}, {"track_id", who + 4}});
      instances.push_back({{"keypoints", detail_points(x)},
                           {"keypoint_scores", std::vector<double>(17, 0.5)},
                           {"track_id", who}});
    }
    if (format == "mmpose") list.push_back({{"frame_id", frame}, {"instances", instances}});
  }
  return list.dump();
}

}  // namespace

TEST_CASE("track details: the numbers that a tracker gave people hold") {
  const ScratchFolder folder;
  for (const std::string format : {"alphapose", "coco", "mmpose"}) {
    CAPTURE(format);
    const TrackReading reading =
        read_tracks(folder.write("people.json", lists_of_people(format)), {.person = "all"});
    CHECK(reading.format == format);
    REQUIRE(reading.people.size() == 2);
    for (const Track2d& track : reading.people)
      for (int frame = 1; frame < kDetailFrames; ++frame)
        CHECK(std::abs(track.x_px(frame, 0) - track.x_px(frame - 1, 0)) == doctest::Approx(700));
  }
}

TEST_CASE("track details: a numbered person who is away for long comes back, in every layout") {
  const ScratchFolder folder;
  json landmarks = json::array(), instances = json::array();
  std::string columns = "frame,track_id", rows = "frame,track_id,landmark,x,y\n";
  for (int joint = 0; joint < 17; ++joint) columns += fmt::format(",L{0}_x,L{0}_y", joint);
  for (int frame = 0; frame < 150; ++frame) {
    const bool away = frame >= 45 && frame < 105;
    const json points = detail_points(200);
    json named = json::array();
    if (!away) columns += fmt::format("\n{},7", frame);
    for (int joint = 0; joint < 17; ++joint) {
      const double x = points[joint][0], y = points[joint][1];
      named.push_back({{"x", x}, {"y", y}, {"score", 0.5}});
      if (away) continue;
      columns += fmt::format(",{},{}", x, y);
      rows += fmt::format("{},7,{},{},{}\n", frame, joint, x, y);
    }
    json of_tfjs = json::array(), of_mmpose = json::array();
    if (!away) {
      of_tfjs.push_back({{"id", 7}, {"keypoints", named}});
      of_mmpose.push_back({{"track_id", 7},
                           {"keypoints", points},
                           {"keypoint_scores", std::vector<double>(17, 0.5)}});
    }
    landmarks.push_back(of_tfjs);
    instances.push_back({{"frame_id", frame}, {"instances", of_mmpose}});
  }
  for (const auto& [name, text] : {std::pair{"columns.csv", columns + "\n"},
                                   {"rows.csv", rows},
                                   {"movenet.json", landmarks.dump()},
                                   {"mmpose.json", instances.dump()}}) {
    CAPTURE_BOUND(name);
    const TrackReading reading = read_tracks(folder.write(name, text), {.fps = 30});
    CHECK(reading.people_seen == 1);
    CHECK((reading.people.front().confidence.rowwise().maxCoeff().array() > 0).count() == 90);
  }
}

TEST_CASE("track details: an object's `id` beside a frame's one body is the frame's") {
  const ScratchFolder folder;
  json frames = json::array();
  for (int frame = 0; frame < 30; ++frame) {
    json named = json::array();
    for (const json& point : detail_points(200 + frame))
      named.push_back({{"x", point[0]}, {"y", point[1]}, {"score", 0.5}});
    frames.push_back({{"id", frame}, {"keypoints", named}});
  }
  CHECK(read_tracks(folder.write("film.json", frames.dump()), {.fps = 30}).people_seen == 1);
}

TEST_CASE("track details: who is seen for half a second, or a tenth of a short film, stays") {
  const ScratchFolder folder;
  for (const int seen : {14, 15}) {
    CAPTURE(seen);
    json list = json::array();
    for (int frame = 0; frame < 200; ++frame) {
      list.push_back({{"image_id", frame}, {"keypoints", body(200)}});
      if (frame < seen) list.push_back({{"image_id", frame}, {"keypoints", body(900)}});
    }
    CHECK(read_tracks(folder.write("guest.json", list.dump()), {.fps = 30}).people_seen ==
          (seen < 15 ? 1 : 2));
  }
}

TEST_CASE("track details: third numbers are confidences unless one of them is below 0") {
  const ScratchFolder folder;
  const auto of = [&](const json& last) {
    json frame = json::array();
    for (int joint = 0; joint < 17; ++joint)
      frame.push_back({200 + 10.0 * joint, 100.0 + joint, joint == 16 ? last : json(0.25)});
    return read_track(folder.write("lists.json", json::array({frame, frame}).dump()));
  };
  CHECK(of(0.75).confidence(0, 0) == 0.25);
  CHECK(of(0.75).confidence(1, 16) == 0.75);
  CHECK(of(-0.75).confidence(0, 0) == 1);
  CHECK(of(-0.75).confidence(1, 16) == 1);
  // One that is not known is no depth, and does not make depths of the others.
  CHECK(of(nullptr).confidence(0, 0) == 0.25);
  CHECK(of(nullptr).confidence(1, 16) == 1);
}

TEST_CASE("track details: a landmark's confidence that is null is 1 in lists of numbers, too") {
  const ScratchFolder folder;
  json frame = json::array();
  for (int joint = 0; joint < 17; ++joint)
    frame.push_back({200 + 10.0 * joint, 100.0, -0.1, joint == 16 ? json() : json(0.25)});
  const std::string with_null = json::array({frame}).dump();
  std::string with_nan = with_null;  // as Python writes it
  with_nan.replace(with_nan.find("null"), 4, "NaN");
  for (const std::string& text : {with_null, with_nan}) {
    const Track2d track = read_track(folder.write("lists.json", text));
    CHECK(track.confidence(0, 0) == 0.25);
    CHECK(track.confidence(0, 16) == 1);
    CHECK(track.x_px(0, 16) == 360);
  }
}

TEST_CASE("track details: third numbers are those of their frames, in whatever order these stand") {
  const ScratchFolder folder;
  json by_number = json::object(), rising = json::array(), falling = json::array();
  for (int frame = 0; frame < 12; ++frame) {
    json landmarks = json::array();
    for (int joint = 0; joint < 17; ++joint)
      landmarks.push_back({200 + 10.0 * joint, 100.0 + joint, (1.0 + frame) / 16});
    by_number[std::to_string(frame)] = landmarks;
    rising.push_back({{"frame", frame}, {"landmarks", landmarks}});
    falling.insert(falling.begin(), rising.back());
  }
  for (const json& content : {by_number, rising, falling}) {
    const Track2d track = read_track(folder.write("film.json", content.dump()));
    REQUIRE(track.frames() == 12);
    for (int frame = 0; frame < 12; ++frame) {
      CAPTURE(frame);
      CHECK((track.confidence.row(frame).array() == (1.0 + frame) / 16).all());
    }
  }
}

TEST_CASE("track details: landmarks under their names may have a name beside x and y, too") {
  const ScratchFolder folder;
  json named = json::object(), twice = json::object();
  for (const Keypoint& keypoint : joint_set("COCO_17").keypoints) {
    const double at = 200.0 + 10 * static_cast<double>(named.size());
    named[keypoint.name] = twice[keypoint.name] = {{"x", at}, {"y", 2 * at}};
    twice[keypoint.name]["name"] = keypoint.name;
  }
  const TrackReading once = read_tracks(folder.write("named.json", json::array({named}).dump())),
                     both = read_tracks(folder.write("twice.json", json::array({twice}).dump()));
  REQUIRE(once.joint_set == "COCO_17");
  REQUIRE(both.joint_set == "COCO_17");
  CHECK(once.people.front().x_px(0, 16) == 360);
  CHECK(both.people.front().x_px == once.people.front().x_px);
  CHECK(both.people.front().y_px == once.people.front().y_px);
}

TEST_CASE("track details: of two confidences in columns the first counts") {
  const ScratchFolder folder;
  std::string header = "frame", row = "0";
  for (int joint = 0; joint < 33; ++joint) {
    header += fmt::format(",L{0}_x,L{0}_y,L{0}_z,L{0}_visibility,L{0}_presence", joint);
    row += fmt::format(",{},0.5,-0.1,0.25,0.75", 0.01 * joint + 0.1);
  }
  CHECK((read_track(folder.write("two.csv", header + "\n" + row + "\n")).confidence.array() == 0.25)
            .all());
}

TEST_CASE("track details: what was seen without a confidence has 1, in every table") {
  const ScratchFolder folder;
  struct Table {
    std::string format, text;
  };
  // Joint a has a confidence in frame 0 alone; b is not seen in frame 1.
  for (const Table& table :
       {Table{"sleap",
              "track,frame_idx,instance.score,a.x,a.y,a.score,b.x,b.y,b.score\n"
              "t,0,0.9,10,20,0.25,14,24,0.75\nt,1,,11,21,,,,\n"},
        Table{"deeplabcut",
              "scorer,s,s,s,s,s,s\nbodyparts,a,a,a,b,b,b\n"
              "coords,x,y,likelihood,x,y,likelihood\n0,10,20,0.25,14,24,0.75\n1,11,21,,,,\n"},
        Table{
            "mediapipe",
            "frame,landmark,x,y,visibility\n0,a,10,20,0.25\n0,b,14,24,0.75\n1,a,11,21,\n1,b,,,\n"},
        Table{"mediapipe",
              "frame,a_x,a_y,a_visibility,b_x,b_y,b_visibility,c_x,c_y,d_x,d_y,e_x,e_y\n"
              "0,10,20,0.25,14,24,0.75,1,9,2,9,3,9\n1,11,21,,,,,1,9,2,9,3,9\n"}}) {
    CAPTURE(table.text);
    const TrackReading reading = read_tracks(folder.write("table.csv", table.text));
    CHECK(reading.format == table.format);
    const Track2d& track = reading.people.front();
    REQUIRE(track.frames() == 2);
    CHECK(track.confidence(0, 0) == 0.25);
    CHECK(track.confidence(0, 1) == 0.75);
    CHECK(track.x_px(1, 0) == 11);
    CHECK(track.confidence(1, 0) == 1);
    CHECK(track.confidence(1, 1) == 0);
  }
}

TEST_CASE("track details: MediaPipe's landmarks with null for what is not known of them") {
  const ScratchFolder folder;
  const auto with = [&](const json& more) {
    json landmarks = json::array();
    for (int joint = 0; joint < 33; ++joint) {
      landmarks.push_back(json{{"x", 0.25 + 0.01 * joint}, {"y", 0.5}, {"z", nullptr}});
      landmarks.back().update(more);
    }
    return read_tracks(folder.write(
        "task.json", json::array({json{{"pose_landmarks", json::array({landmarks})}}}).dump()));
  };
  const TrackReading nameless = with({{"visibility", 0.5}, {"presence", 0.75}, {"name", nullptr}});
  CHECK(nameless.joint_set == "MEDIAPIPE_33");
  CHECK((nameless.people.front().confidence.array() == 0.5).all());
  const TrackReading present = with({{"visibility", nullptr}, {"presence", 0.75}});
  CHECK((present.people.front().confidence.array() == 0.75).all());
  const TrackReading unknown = with({{"visibility", nullptr}, {"presence", nullptr}});
  CHECK((unknown.people.front().confidence.array() == 1).all());
}

TEST_CASE("track details: a landmark that comes twice in a frame is a second person's") {
  const ScratchFolder folder;
  const std::string two_bodies = "0,a,1,2\n0,b,3,4\n0,a,5,6\n0,b,7,8\n";
  CHECK_THROWS_WITH_AS(
      read_track(folder.write("rows.csv", "frame,landmark,x,y\n" + two_bodies)),
      doctest::Contains("rows.csv:4: landmark 'a' comes twice in frame '0'; add a column person"),
      InputError);
  CHECK_THROWS_WITH_AS(
      read_track(folder.write("rows.csv", "frame,id,x,y\n0,0,1,2\n0,1,3,4\n0,0,5,6\n")),
      doctest::Contains("rows.csv:4: landmark '0' comes twice in frame '0'; add a column person"),
      InputError);
  // A row that says that a landmark was not seen is a row.
  CHECK_THROWS_WITH_AS(
      read_track(folder.write("rows.csv", "frame,landmark,x,y,person\n0,a,,,1\n0,a,5,6,1\n")),
      doctest::Contains("rows.csv:3: landmark 'a' comes twice in frame '0'; remove one row"),
      InputError);
}

TEST_CASE("track details: labelled images are frames by the numbers in their names") {
  const ScratchFolder folder;
  const std::string header = "scorer,me,me\nbodyparts,tail,tail\ncoords,x,y\n";
  const TrackReading labels = read_tracks(
      folder.write("labels.csv", header + "cam2/img0010_a1.png,5,6\ncam2/img0012_a1.png,7,8\n"
                                          "cam2/img0013_a1.png,7,9\n"));
  CHECK(labels.frame_numbers == std::vector<long long>{10, 11, 12, 13});
  REQUIRE(labels.people.front().frames() == 4);
  CHECK(labels.people.front().confidence(1, 0) == 0);
  CHECK(labels.people.front().y_px(3, 0) == 9);
  // Names whose numbers are not different ones give no order.
  CHECK(read_tracks(folder.write("labels.csv", header + "a7.png,5,6\nb7.png,7,8\nc9.png,7,9\n"))
            .people.front()
            .frames() == 3);
}

TEST_CASE("track details: axes of length 1 before the joints of an array are left out") {
  const ScratchFolder folder;
  constexpr std::size_t kFrames = 4, kJoints = 17;
  std::vector<double> values;
  for (std::size_t i = 0; i < kFrames * kJoints; ++i) {
    const auto at = static_cast<double>(i);
    values.insert(values.end(), {200 + at, 300 - at, 0.5});
  }
  const auto read = [&](const std::vector<std::size_t>& shape) {
    return read_track(folder.write("a.npy", npy_bytes(NpyArray{shape, values})));
  };
  const Track2d plain = read({kFrames, kJoints, 3});
  REQUIRE(plain.frames() == 4);
  // The first is what MoveNet's answers are, one behind the other.
  for (const std::vector<std::size_t>& shape : {std::vector<std::size_t>{kFrames, 1, 1, kJoints, 3},
                                                {1, kFrames, 1, kJoints, 3},
                                                {kFrames, 1, 1, 1, kJoints, 3}}) {
    const Track2d track = read(shape);
    CHECK(track.x_px == plain.x_px);
    CHECK(track.y_px == plain.y_px);
  }
  CHECK_THROWS_WITH_AS(read({2, 2, 1, kJoints, 3, 1}),
                       doctest::Contains("an array of 2 x 2 x 1 x 17 x 3 x 1"), InputError);
}

TEST_CASE("track details: lists of numbers do not say which of them is x, objects do") {
  const ScratchFolder folder;
  json lists = json::array(), objects = json::array();
  for (const json& point : detail_points(200)) {
    lists.push_back({point[0], point[1], 0.5});
    objects.push_back({{"x", point[0]}, {"y", point[1]}, {"score", 0.5}});
  }
  const auto are_unnamed = [&](const std::string& name, const std::string& text) {
    return read_tracks(folder.write(name, text)).axes_are_unnamed;
  };
  CHECK(are_unnamed("lists.json", json::array({lists}).dump()));
  CHECK(are_unnamed("array.npy",
                    npy_bytes(NpyArray{{1, 17, 3}, body(200).get<std::vector<double>>()})));
  CHECK(!are_unnamed("objects.json", json::array({objects}).dump()));
  const json coco{{"image_id", 1}, {"keypoints", body(200)}};
  CHECK(!are_unnamed("coco.json", json::array({coco}).dump()));
}

TEST_CASE("track details: a rate in the file holds, and --fps before it") {
  const ScratchFolder folder;
  const auto file =
      folder.write("rate.csv", "# fps=25 width_px=640 height_px=480\na_x_px,a_y_px\n1,2\n3,4\n");
  CHECK(read_track(file).fps == 25);
  CHECK(read_track(file, {.fps = 50}).fps == 50);
  for (const std::string& notice : read_tracks(file).notices)
    CHECK(notice.find("rate") == std::string::npos);
}
