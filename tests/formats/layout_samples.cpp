#include "formats/layout_samples.hpp"

#include <fmt/format.h>

#include <cctype>
#include <nlohmann/json.hpp>

#include "formats/figure_track.hpp"

namespace mcdbn::test {
namespace {

using nlohmann::json;

constexpr int kFrames = 4;

/// x, y, confidence of each joint; `right_px` further right.
json flat(const Track2d& track, int frame, double right_px = 0, double scale = 1) {
  json numbers = json::array();
  for (int joint = 0; joint < track.joint_count(); ++joint) {
    numbers.push_back(track.x_px(frame, joint) + right_px);
    numbers.push_back(track.y_px(frame, joint));
    numbers.push_back(track.confidence(frame, joint) * scale);
  }
  return numbers;
}

json points(const Track2d& track, int frame) {
  json list = json::array();
  for (int joint = 0; joint < track.joint_count(); ++joint)
    list.push_back({track.x_px(frame, joint), track.y_px(frame, joint)});
  return list;
}

/// MediaPipe's normalized landmarks.
json landmarks(const Track2d& track, int frame) {
  json list = json::array();
  for (int joint = 0; joint < track.joint_count(); ++joint)
    list.push_back({{"x", track.x_px(frame, joint) / 1920},
                    {"y", track.y_px(frame, joint) / 1080},
                    {"z", -0.1},
                    {"visibility", track.confidence(frame, joint)}});
  return list;
}

LayoutSample old_openpose() {
  const Track2d track = sample_figure("COCO_18");
  const json person{{"pose_keypoints", flat(track, 0)}, {"face_keypoints", json::array()}};
  return {"person_whole.json",
          "openpose",
          "COCO_18",
          1,
          1,
          json{{"version", 1.0}, {"people", {person}}}.dump()};
}

/// OpenPose's 25 body joints with an id that is a number.
LayoutSample body_25b() {
  const Track2d track = sample_figure("BODY_25B");
  const json person{{"person_id", 1}, {"pose_keypoints_2d", flat(track, 0)}};
  return {"frame_0007_keypoints.json",
          "openpose",
          "BODY_25B",
          1,
          1,
          json{{"version", 1.3}, {"people", {person}}}.dump()};
}

LayoutSample alphapose(const std::string& name, const json& idx, double scale) {
  const Track2d track = sample_figure("COCO_17");
  json list = json::array();
  for (int frame = 0; frame < kFrames; ++frame)
    list.push_back({{"image_id", fmt::format("{:05}.jpg", frame + 1)},
                    {"category_id", 1},
                    {"keypoints", flat(track, frame, 0, scale)},
                    {"score", 2.9},
                    {"box", {1, 2, 3, 4}},
                    {"idx", idx}});
  return {name, "alphapose", "COCO_17", kFrames, 1, list.dump()};
}

/// Two people of 136 joints, of which face and hands are left out.
LayoutSample alphapose_136() {
  const Track2d track = sample_figure("HALPE_26");
  json list = json::array();
  for (int frame = 0; frame < kFrames; ++frame)
    for (const double right_px : {0.0, 500.0}) {
      json numbers = flat(track, frame, right_px);
      for (int i = 26; i < 136; ++i) numbers.insert(numbers.end(), {400.0, 80.0, 0.5});
      list.push_back({{"image_id", fmt::format("{}.jpg", frame)},
                      {"category_id", 1},
                      {"keypoints", numbers},
                      {"score", 2.9}});
    }
  return {"halpe136.json", "alphapose", "HALPE_26", kFrames, 2, list.dump()};
}

LayoutSample alphapose_cmu() {
  const Track2d track = sample_figure("COCO_18");
  json images = json::object();
  for (int frame = 0; frame < kFrames; ++frame)
    images[fmt::format("{:04}.jpg", frame)] = {{"version", "AlphaPose v0.3"},
                                               {"bodies", {{{"joints", flat(track, frame)}}}}};
  return {"cmu.json", "alphapose", "COCO_18", kFrames, 1, images.dump()};
}

json instance(const Track2d& track, int frame) {
  return {{"keypoints", points(track, frame)},
          {"keypoint_scores", json(std::vector<double>(track.joint_count(), 1.06))},
          {"bbox", {{1, 2, 3, 4}}},
          {"bbox_score", 0.9}};
}

LayoutSample mmpose_video() {
  const Track2d track = sample_figure("COCO_17");
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame)
    frames.push_back({{"frame_id", frame}, {"instances", {instance(track, frame)}}});
  return {"mmpose_video.json", "mmpose", "COCO_17", kFrames, 1, frames.dump()};
}

LayoutSample mmpose_image() {
  const Track2d track = sample_figure("HALPE_26");
  return {
      "mmpose_image.json", "mmpose", "HALPE_26", 1, 1, json::array({instance(track, 0)}).dump()};
}

/// JSON lines: a frame in each.
LayoutSample mmpose_lines() {
  const Track2d track = sample_figure("COCO_17");
  std::string text;
  for (int frame = 0; frame < kFrames; ++frame)
    text += json{{"frame_id", frame}, {"instances", {instance(track, frame)}}}.dump() + "\r\n\n";
  return {"mmpose_lines.jsonl", "mmpose", "COCO_17", kFrames, 1, text};
}

/// COCO-WholeBody with its names: six joints of the feet, 68 of the face, 42 of hands.
LayoutSample mmpose_whole_body() {
  const Track2d track = sample_figure("COCO_23");
  json frames = json::array(), names = json::object();
  for (int joint = 0; joint < 133; ++joint)
    names[std::to_string(joint)] = joint < 23   ? track.joint_names[joint]
                                   : joint < 91 ? fmt::format("face-{}", joint - 23)
                                                : fmt::format("left_hand_{}", joint);
  for (int frame = 0; frame < kFrames; ++frame) {
    json body = instance(track, frame);
    for (int joint = 23; joint < 133; ++joint) {
      body["keypoints"].push_back({400, 80});
      body["keypoint_scores"].push_back(0.5);
    }
    frames.push_back({{"frame_id", frame + 1}, {"instances", {body}}});
  }
  return {"whole_body.json",
          "mmpose",
          "COCO_23",
          kFrames,
          1,
          json{{"meta_info", {{"keypoint_id2name", names}}}, {"instance_info", frames}}.dump()};
}

/// rtmlib: all people of a frame at once.
LayoutSample rtmlib_frames() {
  const Track2d track = sample_figure("COCO_17");
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    const json scores(std::vector<double>(17, 0.8));
    json right = points(track, frame);
    for (json& point : right) point[0] = point[0].get<double>() + 500;
    frames.push_back({{"frame", frame},
                      {"keypoints", {points(track, frame), right}},
                      {"scores", {scores, scores}}});
  }
  return {"rtmlib.json", "mmpose", "COCO_17", kFrames, 2, frames.dump()};
}

/// All frames at once, of one person each.
LayoutSample rtmlib_film() {
  const Track2d track = sample_figure("HALPE_26");
  json keypoints = json::array(), scores = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    keypoints.push_back(points(track, frame));
    scores.emplace_back(std::vector<double>(26, 0.8));
  }
  return {"rtmlib_film.json",
          "mmpose",
          "HALPE_26",
          kFrames,
          1,
          json{{"keypoints", keypoints}, {"scores", scores}}.dump()};
}

/// Ultralytics' YOLO: a list of objects for each frame.
LayoutSample yolo() {
  const Track2d track = sample_figure("COCO_17");
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    json x = json::array(), y = json::array();
    for (int joint = 0; joint < 17; ++joint) {
      x.push_back(track.x_px(frame, joint));
      y.push_back(track.y_px(frame, joint));
    }
    const json keypoints{{"x", x}, {"y", y}, {"visible", std::vector<double>(17, 0.9)}};
    frames.push_back(json::array({{{"name", "person"}, {"class", 0}, {"keypoints", keypoints}}}));
  }
  return {"yolo.json", "mmpose", "COCO_17", kFrames, 1, frames.dump()};
}

/// Results whose images are names with a number behind the frame's, not in order.
LayoutSample coco_names() {
  const Track2d track = sample_figure("COCO_17");
  json list = json::array();
  for (const int frame : {2, 0, 3, 1})
    list.push_back({{"image_id", fmt::format("vid3/img_{:04}_cam2.jpg", frame)},
                    {"category_id", 1},
                    {"keypoints", flat(track, frame)},
                    {"score", 0.9}});
  return {"coco_names.json", "alphapose", "COCO_17", kFrames, 1, list.dump()};
}

/// Annotations with flags, of images without size.
LayoutSample coco_annotations() {
  const Track2d track = sample_figure("COCO_17");
  json images = json::array(), annotations = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    images.push_back({{"id", frame + 1}, {"width", 1280}, {"height", 720}});
    json numbers = flat(track, frame);
    for (std::size_t i = 2; i < numbers.size(); i += 3) numbers[i] = 2 - (i == 5 ? 1 : 0);
    annotations.push_back({{"image_id", frame + 1}, {"keypoints", numbers}, {"id", frame}});
  }
  return {"annotations.json",
          "coco",
          "COCO_17",
          kFrames,
          1,
          json{{"images", images}, {"annotations", annotations}}.dump()};
}

/// MediaPipe's own names of JSON, with a frame in which no person was found.
LayoutSample mediapipe_json() {
  const Track2d track = sample_figure("MEDIAPIPE_33");
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame)
    frames.push_back(
        {{"frame", frame}, {"pose_landmarks", frame == 1 ? json() : landmarks(track, frame)}});
  return {"mediapipe.json", "mediapipe", "MEDIAPIPE_33", kFrames, 1, frames.dump()};
}

/// Landmarks by their numbers or names, whose order a JSON object does not keep.
LayoutSample mediapipe_objects(const std::string& name, bool numbered) {
  const Track2d track = sample_figure("MEDIAPIPE_33");
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    json body = json::object();
    const json list = landmarks(track, frame);
    for (std::size_t joint = 0; joint < list.size(); ++joint) {
      std::string key = track.joint_names[joint];
      for (char& letter : key) letter = static_cast<char>(std::toupper(letter));
      body[numbered ? std::to_string(joint) : "PoseLandmark." + key] = list[joint];
    }
    frames.push_back(body);
  }
  return {name, "mediapipe", "MEDIAPIPE_33", kFrames, 1, frames.dump()};
}

/// Rows with `id` for the landmark, and a name beside it.
LayoutSample mediapipe_rows_by_id(const std::string& name, bool named) {
  const Track2d track = sample_figure("MEDIAPIPE_33");
  std::string text = named ? "frame,id,name,x,y\n" : "frame,id,x,y\n";
  for (int frame = 0; frame < kFrames; ++frame)
    for (int joint = 0; joint < 33; ++joint)
      text +=
          fmt::format("{},{}{},{},{}\n", frame, joint, named ? "," + track.joint_names[joint] : "",
                      track.x_px(frame, joint) / 1920, track.y_px(frame, joint) / 1080);
  return {name, "mediapipe", "MEDIAPIPE_33", kFrames, 1, text};
}

/// Rows with `id` for the person.
LayoutSample mediapipe_rows_of_people() {
  const Track2d track = sample_figure("MEDIAPIPE_33");
  std::string text = "frame,id,landmark,x,y\n";
  for (int frame = 0; frame < kFrames; ++frame)
    for (const int person : {0, 1})
      for (int joint = 0; joint < 33; ++joint)
        text += fmt::format("{},{},{},{},{}\n", frame, person, joint,
                            (track.x_px(frame, joint) + 500 * person) / 1920,
                            track.y_px(frame, joint) / 1080);
  return {"rows_of_people.csv", "mediapipe", "MEDIAPIPE_33", kFrames, 2, text};
}

LayoutSample mediapipe_columns() {
  const Track2d track = sample_figure("MEDIAPIPE_33");
  std::string text = "frame";
  for (int joint = 0; joint < 33; ++joint)
    text += fmt::format(",L{0}_x,L{0}_y,L{0}_z,L{0}_visibility", joint);
  for (int frame = 0; frame < kFrames; ++frame) {
    text += fmt::format("\n{}", frame + 1);
    for (int joint = 0; joint < 33; ++joint)
      text += fmt::format(",{},{},-0.2,0.9", track.x_px(frame, joint) / 1920,
                          track.y_px(frame, joint) / 1080);
  }
  return {"columns.csv", "mediapipe", "MEDIAPIPE_33", kFrames, 1, text};
}

/// The rows of frame 2 are missing: no person was found.
LayoutSample mediapipe_rows() {
  const Track2d track = sample_figure("MEDIAPIPE_33");
  std::string text = "Frame,LandmarkID,X,Y\n";
  for (const int frame : {0, 1, 3})
    for (int joint = 0; joint < 33; ++joint)
      text += fmt::format("{},{},{},{}\n", frame, joint, track.x_px(frame, joint) / 1920,
                          track.y_px(frame, joint) / 1080);
  return {"rows.csv", "mediapipe", "MEDIAPIPE_33", kFrames, 1, text};
}

/// TensorFlow.js: named keypoints with scores.
LayoutSample movenet() {
  const Track2d track = sample_figure("COCO_17");
  json frames = json::array();
  for (int frame = 0; frame < kFrames; ++frame) {
    json keypoints = json::array();
    for (int joint = 0; joint < track.joint_count(); ++joint)
      keypoints.push_back({{"x", track.x_px(frame, joint)},
                           {"y", track.y_px(frame, joint)},
                           {"score", 0.5},
                           {"name", track.joint_names[joint]}});
    frames.push_back(json::array({{{"keypoints", keypoints}, {"score", 0.9}}}));
  }
  return {"movenet.json", "mediapipe", "COCO_17", kFrames, 1, frames.dump()};
}

/// Two mice, of which one is not seen in frame 1.
LayoutSample deeplabcut_two() {
  std::string text =
      "scorer,S,S,S,S,S,S,S,S,S,S,S,S\nindividuals,a,a,a,a,a,a,b,b,b,b,b,b\n"
      "bodyparts,snout,snout,snout,tail,tail,tail,snout,snout,snout,tail,tail,tail\n"
      "coords,x,y,likelihood,x,y,likelihood,x,y,likelihood,x,y,likelihood\n";
  for (int frame = 0; frame < kFrames; ++frame)
    text += fmt::format("{0},10,20,0.9,50,60,0.8,{1}\n", frame,
                        frame == 1 ? ",,,,," : "210,20,0.9,250,60,0.8");
  return {"two_mice.csv", "deeplabcut", "", kFrames, 2, text};
}

LayoutSample sleap_two() {
  std::string text = "track,frame_idx,instance.score,head.score,head.x,head.y,tail.x,tail.y\n";
  for (int frame = 0; frame < kFrames; ++frame)
    text += fmt::format("track_0,{0},0.9,1.17,10,20,50,60\ntrack_1,{0},0.9,0.0,,,250,80\n", frame);
  return {"two_flies.csv", "sleap", "", kFrames, 2, text};
}

}  // namespace

Track2d sample_figure(const std::string& set) {
  Track2d track = figure_track({.name = {},
                                .about = {},
                                .joint_sets = {set},
                                .recognises = nullptr,
                                .read = nullptr,
                                .write = nullptr},
                               kFrames);
  track.x_px(1, 1) = track.x_px(0, 1) + 3;
  track.y_px(1, 1) = track.y_px(0, 1);
  track.confidence(1, 1) = 0.75;
  return track;
}

const std::vector<LayoutSample>& layout_samples() {
  static const std::vector<LayoutSample> samples{
      old_openpose(),
      body_25b(),
      alphapose("tracked.json", 3, 1),
      alphapose("nested.json", json::parse("[[0.0],[0.0]]"), 1),
      alphapose("confident.json", json::parse("[1.0]"), 6),
      alphapose_136(),
      alphapose_cmu(),
      mmpose_video(),
      mmpose_image(),
      mmpose_lines(),
      mmpose_whole_body(),
      rtmlib_frames(),
      rtmlib_film(),
      yolo(),
      coco_annotations(),
      coco_names(),
      mediapipe_json(),
      mediapipe_objects("by_number.json", true),
      mediapipe_objects("by_name.json", false),
      mediapipe_rows_by_id("rows_by_id.csv", false),
      mediapipe_rows_by_id("rows_by_name.csv", true),
      mediapipe_rows_of_people(),
      mediapipe_columns(),
      mediapipe_rows(),
      movenet(),
      deeplabcut_two(),
      sleap_two(),
  };
  return samples;
}

}  // namespace mcdbn::test
