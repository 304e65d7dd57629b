// A track line by line, as it is written: what a whole file is read as, one frame at a time.

#include "mcdbn/formats/track_lines.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/scratch_folder.hpp"
#include "formats/csv_text.hpp"
#include "formats/figure_track.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

constexpr const char* kCsv =
    "# fps=25 width_px=640 height_px=480\n"
    "Hips_x_px,Hips_y_px,Hips_confidence,Foot_x_px,Foot_y_px\n"
    "10,20,0.5,30,40\n"
    "\n"
    "11,21,1,,\n";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (const std::string_view line : split(text, '\n')) lines.emplace_back(line);
  if (lines.back().empty()) lines.pop_back();
  return lines;
}

std::vector<TrackFrame> read_all(TrackLines& lines, const std::string& text) {
  std::vector<TrackFrame> frames;
  for (const std::string& line : lines_of(text))
    if (auto frame = lines.read(line)) frames.push_back(std::move(*frame));
  return frames;
}

std::string message_of(TrackLines& lines, const std::string& line) {
  try {
    (void)lines.read(line);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// A person of 17 joints around a place, as rtmlib answers.
std::string people_line(const std::vector<double>& at_px) {
  std::string keypoints, scores;
  for (const double at : at_px) {
    std::string one, sure;
    for (int joint = 0; joint < 17; ++joint) {
      one += fmt::format("{}[{},{}]", joint ? "," : "", at + 10 * (joint % 3), 100 + 12 * joint);
      sure += fmt::format("{}0.9", joint ? "," : "");
    }
    keypoints += fmt::format("{}[{}]", keypoints.empty() ? "" : ",", one);
    scores += fmt::format("{}[{}]", scores.empty() ? "" : ",", sure);
  }
  return fmt::format("{{\"keypoints\":[{}],\"scores\":[{}]}}", keypoints, scores);
}

TrackReadOptions of_image() {
  TrackReadOptions options;
  options.image_size = {1280, 720};
  options.fps = 60;
  return options;
}

}  // namespace

TEST_CASE("track lines: our CSV, its header first, gaps missing") {
  TrackLines lines("pipe");
  const auto frames = read_all(lines, kCsv);
  REQUIRE(frames.size() == 2);
  CHECK(lines.knows_joints());
  CHECK(lines.like().joint_names == std::vector<std::string>{"Hips", "Foot"});
  CHECK(lines.like().fps == 25);
  CHECK(lines.like().width_px == 640);
  CHECK(lines.like().height_px == 480);
  CHECK(lines.like().frames() == 0);
  CHECK(frames[0].x_px[1] == 30);
  CHECK(frames[0].confidence[0] == 0.5);
  CHECK(frames[1].y_px[0] == 21);
  CHECK(std::isnan(frames[1].x_px[1]));
  CHECK(frames[1].confidence[1] == 0);
  CHECK(lines.take_notices().empty());
}

TEST_CASE("track lines: the image's size is the options', the line's, or the camera's") {
  const auto width = [](const TrackReadOptions& options, const std::string& text) {
    TrackLines lines("pipe", options);
    read_all(lines, text);
    return lines.like().width_px;
  };
  const TrackReadOptions seen_by{.camera_image = ImageSize{800, 600}};
  CHECK(width(seen_by, kCsv) == 640);
  CHECK(width(seen_by, people_line({300})) == 800);
  CHECK(width(of_image(), kCsv) == 1280);
}

TEST_CASE("track lines: every JSON format's frames are what its file is read as") {
  const ScratchFolder folder;
  for (const char* format : {"openpose", "mmpose"}) {
    CAPTURE(format);
    const Track2d track = figure_track(track_format(format), 5);
    // A frame a line, as programs that write one after the other do.
    std::string text;
    for (int frame = 0; frame < track.frames(); ++frame) {
      nlohmann::json keypoints = nlohmann::json::array(), scores = keypoints, flat = keypoints;
      for (int joint = 0; joint < track.joint_count(); ++joint) {
        const bool seen = track.confidence(frame, joint) > 0;
        const double x = seen ? track.x_px(frame, joint) : 0,
                     y = seen ? track.y_px(frame, joint) : 0;
        keypoints.push_back({x, y});
        scores.push_back(track.confidence(frame, joint));
        for (const double value : {x, y, track.confidence(frame, joint)}) flat.push_back(value);
      }
      const nlohmann::json line =
          std::string(format) == "openpose"
              ? nlohmann::json{{"people", {{{"pose_keypoints_2d", flat}}}}}
              : nlohmann::json{
                    {"keypoints", keypoints}, {"keypoint_scores", scores}, {"frame_id", frame}};
      text += line.dump() + "\n";
    }
    const Track2d whole = read_track(folder.write("track.json", text), of_image());
    TrackLines lines("pipe", of_image());
    const auto frames = read_all(lines, text);
    REQUIRE(static_cast<int>(frames.size()) == whole.frames());
    CHECK(lines.like().joint_names == whole.joint_names);
    CHECK(lines.like().keypoints.size() == whole.keypoints.size());
    CHECK(lines.like().fps == 60);
    for (int frame = 0; frame < whole.frames(); ++frame)
      for (int joint = 0; joint < whole.joint_count(); ++joint) {
        const bool seen = whole.confidence(frame, joint) > 0;
        const TrackFrame& got = frames[static_cast<std::size_t>(frame)];
        CHECK((got.confidence[joint] > 0) == seen);
        if (seen) CHECK(got.x_px[joint] == doctest::Approx(whole.x_px(frame, joint)));
      }
  }
}

TEST_CASE("track lines: every layout of a line is a frame, also of a file of such lines") {
  const ScratchFolder folder;
  const auto line = [](const std::string& layout, double at_px) {
    const nlohmann::json people = nlohmann::json::parse(people_line({at_px}));
    const nlohmann::json points = people["keypoints"][0], scores = people["scores"][0];
    nlohmann::json flat = nlohmann::json::array(), triples = flat, named = flat;
    for (std::size_t joint = 0; joint < points.size(); ++joint) {
      const nlohmann::json &x = points[joint][0], &y = points[joint][1], &c = scores[joint];
      for (const nlohmann::json& value : {x, y, c}) flat.push_back(value);
      triples.push_back({x, y, c});
      named.push_back({{"x", x}, {"y", y}, {"score", c}});
    }
    const nlohmann::json instance{{"keypoints", points}, {"keypoint_scores", scores}};
    if (layout == "rtmlib") return people;
    if (layout == "instance") return instance;
    if (layout == "instances") return nlohmann::json::array({instance});
    if (layout == "frame") return nlohmann::json{{"instances", nlohmann::json::array({instance})}};
    if (layout == "openpose") return nlohmann::json{{"people", {{{"pose_keypoints_2d", flat}}}}};
    if (layout == "triples") return triples;
    return nlohmann::json{{"keypoints", named}};
  };
  for (const char* layout :
       {"rtmlib", "instance", "instances", "frame", "openpose", "triples", "landmarks"}) {
    CAPTURE(layout);
    std::string text;
    for (int frame = 0; frame < 4; ++frame) text += line(layout, 300 + frame).dump() + "\n";
    TrackLines lines("pipe", of_image());
    const auto followed = read_all(lines, text);
    const TrackReading whole = read_tracks(folder.write("track.jsonl", text), of_image());
    CHECK(whole.people_seen == 1);
    REQUIRE(whole.people.front().frames() == 4);
    REQUIRE(followed.size() == 4);
    for (int frame = 0; frame < 4; ++frame) {
      CHECK(whole.people.front().x_px(frame, 0) == 300 + frame);
      CHECK(followed[static_cast<std::size_t>(frame)].x_px[0] == 300 + frame);
    }
  }
}

TEST_CASE("track lines: no person, then several, of whom one is followed") {
  TrackLines lines("pipe", of_image());
  auto frame = lines.read(people_line({}));
  REQUIRE(frame);
  CHECK(frame->joints() == 0);
  CHECK(!lines.knows_joints());
  CHECK(lines.read(people_line({300}))->x_px[0] == 300);
  CHECK(lines.knows_joints());
  // Another comes in, listed first; then the first is gone, and comes back.
  CHECK(lines.read(people_line({700, 310}))->x_px[0] == 310);
  CHECK(lines.read(people_line({700}))->confidence.sum() == 0);
  CHECK(lines.read(people_line({}))->joints() == 17);
  CHECK(lines.read(people_line({700, 330}))->x_px[0] == 330);
  // After a second and a half any person is taken.
  for (int t = 0; t < 90; ++t) CHECK(lines.read(people_line({700}))->confidence.sum() == 0);
  CHECK(lines.read(people_line({700}))->x_px[0] == 700);
}

TEST_CASE("track lines: a person whom the file numbers is followed however far") {
  const auto line = [](const std::vector<std::pair<int, int>>& people) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& [number, at_px] : people) {
      nlohmann::json numbers = nlohmann::json::array();
      for (int joint = 0; joint < 25; ++joint)
        for (const double value : {at_px + 10.0 * (joint % 3), 100.0 + 12 * joint, 0.9})
          numbers.push_back(value);
      list.push_back({{"person_id", {number}}, {"pose_keypoints_2d", numbers}});
    }
    return nlohmann::json{{"people", list}}.dump();
  };
  TrackLines lines("pipe", of_image());
  CHECK(lines.read(line({{4, 300}}))->x_px[0] == 300);
  CHECK(lines.read(line({{7, 300}, {4, 900}}))->x_px[0] == 900);
  CHECK(lines.read(line({{7, 900}}))->confidence.sum() == 0);
  // A number that several have does not distinguish them.
  CHECK(lines.read(line({{4, 300}, {4, 890}}))->x_px[0] == 890);
}

TEST_CASE("track lines: a broken line is named, and the next is read") {
  TrackLines lines("pipe");
  (void)read_all(lines, kCsv);
  CHECK(message_of(lines, "1,2,3").starts_with("pipe:6: 3 cells"));
  CHECK(message_of(lines, "1,2,x,4,5").starts_with("pipe:7: "));
  CHECK(lines.read("12,22,1,32,42")->x_px[0] == 12);

  TrackLines json("pipe", of_image());
  CHECK(json.read(people_line({300}))->joints() == 17);
  CHECK(message_of(json, "{\"keypoints\":[[[1,2]").starts_with("pipe:2"));
  CHECK(message_of(json, people_line({3e6})).find("no pixel") != std::string::npos);
  // Nobody who was seen before.
  CHECK(json.read("{\"keypoints\":[[[1,2]]],\"scores\":[[1]]}")->confidence.sum() == 0);
  CHECK(json.read(people_line({302}))->x_px[0] == 302);
}

TEST_CASE("track lines: what has to be given is asked for") {
  TrackLines nameless("pipe");
  CHECK(message_of(nameless, people_line({300})).find("`image-size`") != std::string::npos);
  TrackLines headless("pipe");
  CHECK(headless.read("1,2,3") == std::nullopt);  // the header, which it is not
  CHECK(message_of(headless, "4,5,6").find("numbers where the header is expected") !=
        std::string::npos);
  TrackLines other("pipe", of_image());
  CHECK(message_of(other, "{\"what\": 1}").starts_with("pipe:1: not a frame"));
  TrackReadOptions all = of_image();
  all.person = "all";
  CHECK_THROWS_AS(TrackLines("pipe", all), ConfigError);
  TrackReadOptions shares = of_image();
  TrackLines small("pipe", shares);
  const auto frame = small.read("{\"keypoints\":[[[0.25,0.5],[0.5,0.5]]],\"scores\":[[1,1.2]]}");
  REQUIRE(frame);
  CHECK(frame->x_px[0] == 0.25 * 1280);
  CHECK(frame->y_px[0] == 0.5 * 720);
  CHECK(frame->confidence[1] == 1);
}

TEST_CASE(
    "track lines: after a first line of JSON all others are JSON, before anybody comes, too") {
  for (const char* first : {"[]", "null"}) {
    CAPTURE(first);
    TrackLines lines("pipe", of_image());
    CHECK(!lines.read(""));
    const auto begin = lines.read(first);
    REQUIRE(begin);
    CHECK(begin->joints() == 0);
    CHECK(message_of(lines, "INFO: warming up").starts_with("pipe:3:"));
    CHECK(message_of(lines, "None").starts_with("pipe:4:"));
    const auto nobody = lines.read("null");
    REQUIRE(nobody);
    CHECK(nobody->joints() == 0);
    const auto somebody = lines.read(people_line({300}));
    REQUIRE(somebody);
    REQUIRE(somebody->joints() == 17);
    CHECK(somebody->x_px[0] == 300);
  }
}

TEST_CASE("track lines: COCO's and AlphaPose's lists of a frame's people, also as a file") {
  const ScratchFolder folder;
  const auto entry = [](const nlohmann::json& image, double at_px, double size) {
    nlohmann::json numbers = nlohmann::json::array();
    for (int joint = 0; joint < 17; ++joint)
      for (const double value : {at_px + size * (joint % 3), 100 + size * joint, 0.5})
        numbers.push_back(value);
    return nlohmann::json{{"image_id", image}, {"category_id", 1}, {"keypoints", numbers}};
  };
  for (const bool alphapose : {false, true})
    for (const bool named : {false, true}) {
      CAPTURE(alphapose);
      CAPTURE(named);
      TrackReadOptions options = of_image();
      if (named) options.format = alphapose ? "alphapose" : "coco";
      TrackLines lines("pipe", options);
      std::string text;
      nlohmann::json film = nlohmann::json::array({nlohmann::json::array()});
      const auto image_id = [&](int frame) -> nlohmann::json {
        if (alphapose) return fmt::format("{}.jpg", frame);
        return frame;
      };
      for (int frame = 0; frame < 4; ++frame) {
        const nlohmann::json image = image_id(frame);
        nlohmann::json people = nlohmann::json::array();
        people.push_back(entry(image, 300 + frame, 12));
        // Someone smaller, listed first now and then, or not there.
        if (frame < 3) people.insert(people.begin() + frame % 2, entry(image, 700, 6));
        const auto seen = lines.read(people.dump());
        REQUIRE(seen);
        REQUIRE(seen->joints() == 17);
        CHECK(seen->x_px[0] == 300 + frame);
        CHECK(seen->y_px[16] == 100 + 12 * 16);
        CHECK(seen->confidence[0] == 0.5);
        CHECK(lines.read("[]")->confidence.sum() == 0);
        text += people.dump() + "\n[]\n";
        film.push_back(people);
      }
      for (const std::string& content : {text, "[]\n" + text, film.dump()}) {
        const TrackReading whole = read_tracks(folder.write("log.json", content), options);
        CHECK(whole.format == (alphapose ? "alphapose" : "coco"));
        CHECK(whole.people_seen == 2);
        const Track2d& track = whole.people.front();
        REQUIRE(track.frames() == 4);
        for (int frame = 0; frame < 4; ++frame) CHECK(track.x_px(frame, 0) == 300 + frame);
      }
      nlohmann::json two = nlohmann::json::array();
      for (const int frame : {8, 9}) two.push_back(entry(image_id(frame), 300, 12));
      CHECK(message_of(lines, two.dump()).find("more than one frame in a line") !=
            std::string::npos);
    }
}

TEST_CASE("track lines: a line for each person is reported once, by the image's number") {
  const auto line = [](const nlohmann::json& image, double at_px) {
    std::vector<double> numbers;
    for (int joint = 0; joint < 17; ++joint)
      numbers.insert(numbers.end(), {at_px + 10 * (joint % 3), 100.0 + 12 * joint, 0.9});
    return nlohmann::json{{"image_id", image}, {"keypoints", numbers}}.dump();
  };
  const auto reported = [&](const std::vector<std::string>& all) {
    TrackLines lines("pipe", of_image());
    std::vector<std::string> notices;
    for (const std::string& text : all) {
      CHECK(lines.read(text));
      for (const std::string& notice : lines.take_notices())
        if (notice.find("of the same image") != std::string::npos) notices.push_back(notice);
    }
    return notices;
  };
  const std::vector<std::string> twice =
      reported({line(7, 300), line(8, 300), line(8, 700), line(9, 300), line(9, 700)});
  REQUIRE(twice.size() == 1);
  CHECK(twice.front().starts_with("line 3 is of the same image, 8, as the one before"));
  CHECK(reported({line("7.jpg", 300), line("7.jpg", 700)}).size() == 1);
  CHECK(reported({line(7, 300), "[]", line(8, 300), line(9, 300)}).empty());
  // Lines that do not number their frames.
  CHECK(reported({people_line({300}), people_line({310}), people_line({320})}).empty());
}

TEST_CASE("track lines: a line may be all that MMPose writes of an image") {
  nlohmann::json instance = nlohmann::json::parse(people_line({300}));
  for (const char* key : {"keypoints", "scores"}) {
    const nlohmann::json first = instance[key][0];
    instance[key] = first;
  }
  const nlohmann::json image{{"meta_info", {{"dataset_name", "coco"}}},
                             {"instance_info", nlohmann::json::array({instance})}};
  TrackLines lines("pipe", of_image());
  for (int frame = 0; frame < 2; ++frame) {
    const auto seen = lines.read(image.dump());
    REQUIRE(seen);
    REQUIRE(seen->joints() == 17);
    CHECK(seen->x_px[1] == 310);
  }
}
