// The layouts of tools, and what is wrong with files that are nearly of one.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "base/scratch_folder.hpp"
#include "formats/layout_samples.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/track_file.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Every joint stands where the figure has it, from the nose.
void check_joints(const Track2d& track, const std::string& joint_set, int nose) {
  const Track2d figure = sample_figure(joint_set);
  REQUIRE(track.joint_names == figure.joint_names);
  for (int joint = 0; joint < track.joint_count(); ++joint) {
    if (!(track.confidence(0, joint) > 0)) continue;
    CAPTURE(track.joint_names[joint]);
    CHECK(track.x_px(0, joint) - track.x_px(0, nose) ==
          doctest::Approx(figure.x_px(0, joint) - figure.x_px(0, nose)));
    CHECK(track.y_px(0, joint) == doctest::Approx(figure.y_px(0, joint)));
  }
}

/// Rows of a figure's landmarks, numbered from `first`, without those before `seen_from`.
std::string numbered_rows(const Track2d& figure, int first, int seen_from = 0) {
  std::string text = "frame,landmark,x,y\n";
  for (int frame = 0; frame < figure.frames(); ++frame)
    for (int joint = seen_from; joint < figure.joint_count(); ++joint)
      text += fmt::format("{},{},{},{}\n", frame, first + joint, figure.x_px(frame, joint),
                          figure.y_px(frame, joint));
  return text;
}

}  // namespace

TEST_CASE("layouts: each is recognised, and is the figure that was written") {
  const ScratchFolder folder;
  for (const LayoutSample& sample : layout_samples()) {
    CAPTURE(sample.name);
    const auto path = folder.write(sample.name, sample.text);
    const TrackReading reading =
        read_tracks(path, {.person = "all", .fps = 25, .image_size = ImageSize{1920, 1080}});
    CHECK(reading.format == sample.format);
    CHECK(reading.joint_set == sample.joint_set);
    CHECK(reading.people_seen == sample.people);
    REQUIRE(reading.people.size() == static_cast<std::size_t>(sample.people));
    const Track2d& track = reading.people.front();
    CHECK(track.frames() == sample.frames);
    CHECK(track.fps == 25);
    CHECK(track.width_px == 1920);
    CHECK(track.confidence.maxCoeff() <= 1);
    const int nose = std::max(track.find("nose"), track.find("Nose"));
    if (nose < 0) continue;
    check_joints(track, sample.joint_set, nose);
    // A head above the middle, that walks 3 px a frame.
    for (int frame = 0; frame < track.frames(); ++frame) {
      if (std::isnan(track.x_px(frame, nose))) continue;
      CHECK(track.x_px(frame, nose) == doctest::Approx(track.x_px(0, nose) + 3 * frame));
      CHECK(track.y_px(frame, nose) == doctest::Approx(450 - 400 * 0.908));
    }
  }
}

TEST_CASE("layouts: frames in which no person was found are frames of missing joints") {
  const ScratchFolder folder;
  for (const LayoutSample& sample : layout_samples()) {
    if (sample.name != "rows.csv" && sample.name != "mediapipe.json") continue;
    CAPTURE(sample.name);
    const Track2d track = read_track(folder.write(sample.name, sample.text));
    int empty = 0;
    for (int frame = 0; frame < track.frames(); ++frame)
      empty += (track.confidence.row(frame).array() == 0).all() ? 1 : 0;
    CHECK(empty == 1);
  }
}

TEST_CASE("layouts: confidences of other scales end at 1") {
  const ScratchFolder folder;
  for (const LayoutSample& sample : layout_samples()) {
    if (sample.name != "confident.json") continue;
    std::vector<std::string> notices;
    const Track2d track = read_track(folder.write(sample.name, sample.text), {}, &notices);
    CHECK(track.confidence.maxCoeff() == 1);
    CHECK(notices.front().find("image's size") != std::string::npos);
    CHECK(notices.at(1).find("4.5") != std::string::npos);
  }
}

TEST_CASE("layouts: what is wrong is reported with its place") {
  const ScratchFolder folder;
  struct Case {
    std::string name, text, message;
  };
  for (const Case& wrong : {
           Case{"a.json", R"({"people": [{"pose_keypoints_2d": [1, 2]}]})",
                "a.json: people[0].pose_keypoints_2d: 2 numbers"},
           Case{"a.json", R"({"people": [{"pose_keypoints_2d": [1, 2, "x"]}]})",
                "a.json: people[0].pose_keypoints_2d[2]: a text where a number"},
           Case{"a.json", R"({"people": [{"pose": []}]})",
                "a.json: people[0]: no key 'pose_keypoints_2d'"},
           Case{"a.json", R"({"people": []})", "a.json: no person in any frame"},
           Case{"a.json", "{\"people\": [\n{]}", "a.json:2: no readable JSON"},
           Case{"a.json", R"({"people": 1e999})", "a.json: "},
           Case{"a.json", R"([{"image_id": 1, "keypoints": [1, 2, 1]}, {"image_id": 2}])",
                "a.json: [1]: no key 'keypoints'"},
           Case{"a.json", R"([{"image_id": "x.jpg", "keypoints": [1, 2, 1]}])",
                "a.json: [0].image_id: no number of a frame"},
           Case{"a.json", R"({"instance_info": [{"frame_id": 1, "instances": [{}]}]})",
                "a.json: instance_info[0].instances[0]: no key 'keypoints'"},
           Case{"a.json", "{\"people\": []}\n{\"people\": [}\n", "a.json:2: no readable JSON"},
           Case{"a.json", R"({"keypoints": {"x": [1, 2], "y": [1]}})", "keypoints: lists of diff"},
           Case{"a.csv", "bodyparts,a,a\ncoords,x,q\n0,1,2\n", "a.csv:2: coords 'q'"},
           Case{"a.csv", "bodyparts,a,a\ncoords,x,y\n0,1,two\n", "a.csv:3: 'two' in column 3"},
           Case{"a.csv", "frame_idx,a.x\n0,1\n", "a.csv:1: node 'a' needs both columns"},
           Case{"a.csv", "frame,landmark,x,y\n0,nose,1\n", "a.csv:2: 3 cells"},
           Case{"a.csv", "frame_idx,a.x,a.y\n0,1e300,2\n", "a.csv: a coordinate of 1e+300"},
           Case{"a.csv", "frame,model,keypoint,x,y,z\n0,b,nose,1,2,3\n", "points in space"},
       }) {
    CAPTURE(wrong.text);
    CHECK_THROWS_WITH_AS(read_track(folder.write(wrong.name, wrong.text)),
                         doctest::Contains(wrong.message.c_str()), InputError);
  }
}

TEST_CASE("layouts: a folder of images in the first of which no person was found") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "images");
  for (const LayoutSample& sample : layout_samples())
    if (sample.name == "mmpose_image.json")
      for (const int frame : {1, 2, 4})
        std::ofstream(folder / "images" / ("f" + std::to_string(frame) + ".json")) << sample.text;
  for (const int frame : {0, 3})
    std::ofstream(folder / "images" / ("f" + std::to_string(frame) + ".json")) << "[]";
  const TrackReading reading = read_tracks(folder / "images");
  CHECK(reading.format == "mmpose");
  REQUIRE(reading.people.front().frames() == 5);
  CHECK((reading.people.front().confidence.row(0).array() == 0).all());
  CHECK((reading.people.front().confidence.row(1).array() > 0).all());
  CHECK((reading.people.front().confidence.row(3).array() == 0).all());
}

TEST_CASE("layouts: a folder of what rtmlib answers of each image, two people in it") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "images");
  const auto sample = std::ranges::find(layout_samples(), "rtmlib.json", &LayoutSample::name);
  const auto frames = nlohmann::json::parse(sample->text);
  const TrackReading film = read_tracks(folder.write("film.json", sample->text), {.person = "all"});
  REQUIRE(film.people.size() == 2);
  for (const bool batched : {false, true}) {
    CAPTURE(batched);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      nlohmann::json image = frames[i];
      image.erase("frame");
      if (batched)  // of one image
        for (const char* key : {"keypoints", "scores"})
          image[key] = nlohmann::json::array({frames[i][key]});
      std::ofstream(folder / "images" / fmt::format("f{}.json", i)) << image.dump();
    }
    const TrackReading reading = read_tracks(folder / "images", {.person = "all"});
    CHECK(reading.format == "mmpose");
    REQUIRE(reading.people.size() == 2);
    for (std::size_t person = 0; person < 2; ++person) {
      CHECK(reading.people[person].x_px == film.people[person].x_px);
      CHECK(reading.people[person].y_px == film.people[person].y_px);
    }
  }
  // A batch of two images is no file of one.
  nlohmann::json two = frames[0];
  for (const char* key : {"keypoints", "scores"})
    two[key] = nlohmann::json::array({frames[0][key], frames[1][key]});
  std::ofstream(folder / "images/f0.json") << two.dump();
  CHECK_THROWS_WITH_AS(read_tracks(folder / "images"), doctest::Contains("not of one image"),
                       InputError);
}

TEST_CASE("layouts: faces and hands that are left out are reported") {
  const ScratchFolder folder;
  for (const LayoutSample& sample : layout_samples()) {
    if (sample.name != "whole_body.json" && sample.name != "halpe136.json") continue;
    CAPTURE(sample.name);
    std::vector<std::string> notices;
    read_track(folder.write(sample.name, sample.text), {}, &notices);
    CHECK(std::ranges::any_of(notices, [](const std::string& notice) {
      return notice.find("face and hands are left out") != std::string::npos;
    }));
  }
}

TEST_CASE("layouts: files of other kinds are refused by their kind") {
  const ScratchFolder folder;
  using namespace std::string_literals;
  struct Case {
    std::string name, text, message;
  };
  for (const Case& other : {
           Case{"dlc.h5", "\x89HDF\r\n\x1a\n\0"s, "dlc.h5: HDF5"},
           Case{"data.npz", "PK\x03\x04\0"s, "data.npz: an archive"},
           Case{"film.mp4",
                "\0\0\0\x20"
                "ftypisom"s,
                "film.mp4: a film"},
           Case{"a.pkl", "\x80\x04\x95"s, "a.pkl: Python's pickle"},
           Case{"a.c3d", "\x02P"s + std::string(600, '\0'), "a.c3d: C3D"},
           Case{"a.trc", "PathFileType\t4\t(X/Y/Z)\ta.trc\n", "a.trc: TRC"},
           Case{"a.mot", "Coordinates\nnRows=1\nendheader\n", "a.mot: a table of OpenSim"},
           Case{"a.bvh", "HIERARCHY\nROOT a\n", "a.bvh: BVH"},
           Case{"table.csv", "name,class,confidence,box,keypoints\nperson,0,0.9,{},{}\n",
                "table.csv: YOLO's labels or table"},
           Case{"pandas.csv", ",name,class,confidence,box,keypoints\n0,person,0,0.9,{},{}\n",
                "pandas.csv: YOLO's labels or table"},
           Case{"a.txt", "words", "a.txt: not a 2D track of a known format"},
       }) {
    CAPTURE(other.name);
    CHECK_THROWS_WITH_AS(read_track(folder.write(other.name, other.text)),
                         doctest::Contains(other.message.c_str()), InputError);
  }
}

TEST_CASE("layouts: YOLO's labels are refused by their kind, with what to write instead") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "labels");
  std::string label = "0 0.5 0.5 0.2 0.8";
  for (int joint = 0; joint < 17; ++joint) label += " 0.25 0.375 0.875";
  for (const std::string more : {"", " 0.9", " 0.9 3"}) {
    const auto file = folder.write("labels/film_1.txt", label + more + "\n" + label + more + "\n");
    for (const auto& path : {file, folder / "labels"}) {
      CAPTURE(path.string());
      CHECK_THROWS_WITH_AS(read_track(path), doctest::Contains(": YOLO's labels or table"),
                           InputError);
      CHECK_THROWS_WITH_AS(read_track(path), doctest::Contains("to_json()"), InputError);
    }
  }
  // Other texts are not.
  folder.write("labels/film_1.txt", label + " 0.9 3 4\n");
  CHECK_THROWS_WITH_AS(read_track(folder / "labels"), doctest::Contains("no .json files"),
                       InputError);
}

TEST_CASE("layouts: a body in space is no track") {
  const ScratchFolder folder;
  std::string text = "[[";
  for (int joint = 0; joint < 33; ++joint)
    text += (joint == 0 ? "[" : ",[") + std::to_string(0.03 * joint - 0.5) + ",-0.25,0.1]";
  CHECK_THROWS_WITH_AS(read_track(folder.write("world.json", text + "]]")),
                       doctest::Contains("a body in space"), InputError);
}

TEST_CASE("layouts: a film's rate and size beside its frames, and columns by MediaPipe's names") {
  const ScratchFolder folder;
  for (const LayoutSample& sample : layout_samples()) {
    if (sample.name != "mediapipe.json") continue;
    const Track2d track = read_track(folder.write(
        "film.json", R"({"fps": 25, "width": 640, "height": 480, "frames": )" + sample.text + "}"));
    CHECK(track.fps == 25);
    CHECK(track.width_px == 640);
    CHECK(track.x_px(0, 0) == doctest::Approx((300 + 1.0 / 3) * 640 / 1920));
  }
  const TrackReading named = read_tracks(
      folder.write("named.csv",
                   "frame,PoseLandmark.LEFT_HIP_x,PoseLandmark.LEFT_HIP_y,RIGHT_HIP_x,RIGHT_HIP_y,"
                   "LEFT_KNEE_x,LEFT_KNEE_y,RIGHT_KNEE_x,RIGHT_KNEE_y,NOSE_x,NOSE_y\n"
                   "0,310,200,290,200,310,300,290,300,300,50\n"));
  CHECK(named.format == "mediapipe");
  CHECK(named.people.front().keypoints[0].role == JointRole::left_hip);
  CHECK(named.people.front().keypoints[4].role == JointRole::head);
}

TEST_CASE("layouts: lists in lists without end are refused") {
  const ScratchFolder folder;
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  for (const TrackFormat& format : track_formats())
    CHECK_THROWS_AS(read_track(folder.write("deep.json", deep), {.format = format.name}),
                    InputError);
  CHECK_THROWS_AS(read_track(folder.write("deep.json", deep)), InputError);
}

TEST_CASE("layouts: landmarks numbered from 1 are those numbered from 0") {
  const ScratchFolder folder;
  for (const char* set : {"COCO_17", "BODY_25", "MEDIAPIPE_33"}) {
    const Track2d figure = sample_figure(set);
    for (const int first : {0, 1}) {
      CAPTURE(set);
      CAPTURE(first);
      const TrackReading reading =
          read_tracks(folder.write("rows.csv", numbered_rows(figure, first)));
      CHECK(reading.joint_set == set);
      CHECK(reading.people.front().x_px == figure.x_px);
      CHECK(reading.people.front().y_px == figure.y_px);
    }
  }
  // 1 to 16 are those of 17 of which the first was never seen.
  const Track2d rest =
      read_track(folder.write("rest.csv", numbered_rows(sample_figure("COCO_17"), 0, 1)));
  CHECK(rest.joint_count() == 17);
  CHECK(rest.confidence.col(0).maxCoeff() == 0);
  CHECK(rest.confidence.col(1).minCoeff() == 1);
}

TEST_CASE("layouts: an image's size that is given holds for pixels and for shares of it") {
  const ScratchFolder folder;
  Track2d track = sample_figure("MEDIAPIPE_33");
  track.width_px = 640;
  track.height_px = 480;
  track_format("mediapipe").write(folder / "shares.csv", track);
  std::string text = "nose_x_px,nose_y_px\n";
  for (int frame = 0; frame < track.frames(); ++frame)
    text +=
        std::to_string(track.x_px(frame, 0)) + "," + std::to_string(track.y_px(frame, 0)) + "\n";
  folder.write("pixels.csv", text);
  for (const int times : {1, 2}) {
    CAPTURE(times);
    const TrackReadOptions options{.image_size = ImageSize{640 * times, 480 * times}};
    const Track2d shares = read_track(folder / "shares.csv", options);
    CHECK(shares.width_px == 640 * times);
    CHECK(shares.x_px.isApprox(times * track.x_px, 1e-9));
    CHECK(shares.y_px.isApprox(times * track.y_px, 1e-9));
    std::vector<std::string> notices;
    const Track2d pixels = read_track(folder / "pixels.csv", options, &notices);
    CHECK(pixels.width_px == 640 * times);
    CHECK(pixels.height_px == 480 * times);
    CHECK(pixels.x_px.col(0).isApprox(track.x_px.col(0), 1e-6));
    for (const std::string& notice : notices) CHECK(notice.find("size") == std::string::npos);
  }
  // A camera's size holds where neither the options nor the file give one.
  const TrackReadOptions seen_by{.camera_image = ImageSize{800, 600}};
  folder.write("sized.csv", "# width_px=640 height_px=480\n" + text);
  CHECK(read_track(folder / "sized.csv", seen_by).width_px == 640);
  TrackReadOptions given = seen_by;
  given.image_size = ImageSize{320, 240};
  CHECK(read_track(folder / "sized.csv", given).width_px == 320);
  std::vector<std::string> of_camera;
  CHECK(read_track(folder / "pixels.csv", seen_by, &of_camera).width_px == 800);
  for (const std::string& notice : of_camera) CHECK(notice.find("size") == std::string::npos);
  std::vector<std::string> notices;
  CHECK(read_track(folder / "pixels.csv", {}, &notices).width_px == 1920);
  CHECK(notices.front().find("1920 x 1080 px are taken") != std::string::npos);
}

TEST_CASE("layouts: shares of an image whose size is not given are reported") {
  const ScratchFolder folder;
  for (const LayoutSample& sample : layout_samples()) {
    if (sample.name != "rows.csv") continue;
    const auto path = folder.write(sample.name, sample.text);
    const auto notice = [&](const TrackReadOptions& options) {
      return read_tracks(path, options).notices.front();
    };
    CHECK(notice({}).find("1920 x 1080 px, for the file does not give its size") !=
          std::string::npos);
    CHECK(notice({.image_size = ImageSize{640, 480}}).ends_with("taken as 640 x 480 px"));
  }
}
