// MMPose and RTMPose: predictions of its demos (`instance_info`), of MMPoseInferencer (a list of
// frames with instances; of an image a list of instances; a folder of those), and lists of
// keypoints with scores: of one person, or of all as rtmlib answers. Ultralytics' YOLO has the
// keypoints' x, y and visible as lists of their own.
// Facts: MMPose's demo/topdown_demo_with_mmdet.py and mmpose/structures/utils.py; rtmlib's README;
// Ultralytics' Results.summary().
#include <fmt/format.h>

#include <algorithm>

#include "base/text_file.hpp"
#include "formats/frame_numbers.hpp"
#include "formats/frame_times.hpp"
#include "formats/image_numbers.hpp"
#include "formats/joint_naming.hpp"
#include "formats/rate_and_size.hpp"
#include "formats/track_formats.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

const char* const kName = "mmpose";
const std::vector<std::string> kSets{"COCO_17", "COCO_23",      "HALPE_26", "BODY_25",
                                     "H36M_17", "MEDIAPIPE_33", "COCO_18"};

const char* scores_key(const JsonPlace& instance) {
  for (const char* key : {"keypoint_scores", "scores"})
    if (instance.has(key)) return key;
  return nullptr;
}

bool is_instance(const JsonPlace& place) {
  return place.has("keypoints") && (scores_key(place) != nullptr || place["keypoints"].has("x"));
}

/// The first entry of a list that shows anybody: before it no person may have been found.
std::optional<JsonPlace> first_shown(const JsonPlace& list) {
  for (std::size_t i = 0; list.is_list() && i < list.size(); ++i)
    if (const JsonPlace entry = list.at(i); !shows_nobody(entry.value())) return entry;
  return {};
}

/// Whether the keypoints of a JSON object with scores are lists in lists, at least so deep.
bool nests_keypoints(const JsonPlace& instance, int lists) {
  if (scores_key(instance) == nullptr) return false;
  std::optional<JsonPlace> place = instance["keypoints"];
  for (int depth = 1; depth < lists && place; ++depth) place = first_shown(*place);
  return place && place->is_list();
}

/// rtmlib answers with all people of an image at once: people x joints x 2, people x joints.
bool holds_people(const JsonPlace& instance) {
  return nests_keypoints(instance, 3);
}

/// frames x people x joints x 2
bool holds_frames_of_people(const JsonPlace& instance) {
  return nests_keypoints(instance, 4);
}

/// The key of a frame's people; none: no frame.
const char* people_key(const JsonPlace& place) {
  for (const char* key : {"instances", "predictions"})
    if (place.has(key) && place[key].is_list()) return key;
  return nullptr;
}

bool is_frame(const JsonPlace& place) {
  return people_key(place) != nullptr;
}

/// Frames or instances, in lists.
bool holds_instances(const JsonPlace& place, int depth = 0) {
  constexpr int kDepth = 4;
  if (is_instance(place) || is_frame(place)) return true;
  const auto first = depth < kDepth ? first_shown(place) : std::nullopt;
  return first && holds_instances(*first, depth + 1);
}

/// An object with lists of instances under the numbers or names of images.
bool is_by_image(const JsonPlace& content) {
  if (!content.is_object() || content.size() == 0) return false;
  const std::vector<std::string> keys = content.keys();
  const auto numbers = frame_numbers(keys);
  if (!std::ranges::all_of(numbers, [](const auto& number) { return number.has_value(); }))
    return false;
  for (const std::string& key : keys)
    if (const JsonPlace image = content[key]; !shows_nobody(image.value()))
      return image.is_list() && holds_instances(image);
  return false;
}

bool recognises(const TrackSource& source) {
  const auto content = source.first_json_if_any();
  if (!content) return false;
  return content->has("instance_info") || content->has("predictions") ||
         holds_instances(*content) || is_by_image(*content);
}

/// @param scores of the joints, or one of the person, which is none of its joints'
SeenPerson person_with(const JsonPlace& keypoints, const JsonPlace& scores) {
  return scores.is_list() ? person_in_json(keypoints, scores) : person_in_json(keypoints);
}

std::vector<SeenPerson> people_at_once(const JsonPlace& keypoints, const JsonPlace& scores) {
  std::vector<SeenPerson> people;
  for (std::size_t i = 0; i < keypoints.size(); ++i)
    people.push_back(person_with(keypoints.at(i), scores.at(i)));
  return people;
}

SeenPerson person_of_instance(const JsonPlace& instance) {
  const char* scores = scores_key(instance);
  SeenPerson person = scores == nullptr ? person_in_json(instance["keypoints"])
                                        : person_with(instance["keypoints"], instance[scores]);
  for (const char* key : {"track_id", "instance_id"})
    if (instance.has(key) && instance[key].value().is_number())
      person.id = instance[key].whole_number();
  return person;
}

std::vector<SeenPerson> people_of_instance(const JsonPlace& instance) {
  if (instance["keypoints"].size() == 0) return {};
  if (holds_people(instance))
    return people_at_once(instance["keypoints"], instance[scores_key(instance)]);
  return {person_of_instance(instance)};
}

/// People of a list of instances, or of nested lists, as an image of a batch has.
std::vector<SeenPerson> people_of(const JsonPlace& instances) {
  std::vector<SeenPerson> people;
  for (const JsonPlace& instance : instances.list())
    for (SeenPerson& person :
         instance.is_list() ? people_of(instance) : people_of_instance(instance))
      people.push_back(std::move(person));
  return people;
}

std::vector<SeenPerson> people_of_frame(const JsonPlace& frame) {
  if (frame.value().is_null()) return {};
  const char* key = people_key(frame);
  return people_of(frame.is_list() ? frame : frame[key == nullptr ? "instances" : key]);
}

/// Frames with instances, lists of instances, or an instance of each frame.
void add_frames(SeenPeople& people, const JsonPlace& list) {
  const std::vector<long long> numbers = numbers_of_frames(list, people);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const JsonPlace frame = list.at(i);
    const long long number = numbers[i];
    if (is_instance(frame)) {
      auto& seen = people.frames[number];
      for (SeenPerson& person : people_of_instance(frame)) seen.push_back(std::move(person));
      continue;
    }
    if (!people.frames.emplace(number, people_of_frame(frame)).second)
      frame.fail(fmt::format("a second frame {}", number));
  }
}

/// Frames, or the instances of one image.
void add_list(SeenPeople& people, const JsonPlace& list) {
  bool one_image = true;
  for (const JsonPlace& entry : list.list())
    one_image = one_image && is_instance(entry) && !holds_people(entry) && !gives_frame(entry);
  if (one_image)
    people.frames.emplace(0, people_of(list));
  else
    add_frames(people, list);
}

void add_images(SeenPeople& people, const JsonPlace& content) {
  const ImageNumbers numbers(content.keys());
  for (const std::string& name : content.keys()) {
    const JsonPlace image = content[name];
    const long long number = numbers.of(image, name);
    if (!people.frames.emplace(number, people_of_frame(image)).second)
      image.fail(fmt::format("a second frame {}", number));
  }
}

/// All frames at once, frames x joints x 2 or frames x people x joints x 2, with their scores.
void add_film(SeenPeople& people, const JsonPlace& keypoints, const JsonPlace& scores) {
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const JsonPlace frame = keypoints.at(i);
    const bool several = frame.size() > 0 && frame.at(0).size() > 0 && frame.at(0).at(0).is_list();
    people.frames.emplace(static_cast<long long>(i),
                          several || frame.size() == 0
                              ? people_at_once(frame, scores.at(i))
                              : std::vector{person_with(frame, scores.at(i))});
  }
}

/// The dataset's names for its joints; none: the file does not give them.
std::vector<std::string> names_in(const JsonPlace& content) {
  std::vector<std::string> names;
  if (!content.has("meta_info") || !content["meta_info"].has("keypoint_id2name")) return names;
  const JsonPlace by_number = content["meta_info"]["keypoint_id2name"];
  for (std::size_t i = 0; by_number.is_object() && by_number.has(std::to_string(i).c_str()); ++i)
    names.push_back(by_number[std::to_string(i)].text());
  return names;
}

void add_content(SeenPeople& people, const JsonPlace& content) {
  if (content.has("instance_info"))
    add_list(people, content["instance_info"]);
  else if (content.has("predictions"))
    add_list(people, content["predictions"]);
  else if (is_frame(content))
    people.frames.emplace(0, people_of_frame(content));
  else if (is_by_image(content))
    add_images(people, content);
  else if (content.is_object() && holds_people(content))
    add_film(people, content["keypoints"], content[scores_key(content)]);
  else if (content.is_object())
    people.frames.emplace(0, people_of_instance(content));
  else
    add_list(people, content);
}

/// Of bodies in space, which have scores as well.
bool any_depths(const SeenPeople& people) {
  return std::ranges::any_of(people.frames, [](const auto& frame) {
    return std::ranges::any_of(frame.second, &SeenPerson::has_depths);
  });
}

/// A file of a folder.
std::vector<SeenPerson> people_of_image(const JsonPlace& content) {
  // In a file of a whole film the same lists would be its frames.
  if (is_instance(content) && holds_people(content) && !holds_frames_of_people(content))
    return people_of_instance(content);
  SeenPeople image;
  add_content(image, content);
  if (image.frames.size() != 1) content.fail("not of one image, as the files of a folder are");
  return std::move(image.frames.begin()->second);
}

SeenPeople read(const TrackSource& source) {
  SeenPeople people;
  if (source.is_folder())
    people = people_of_folder(source, people_of_image);
  else if (source.is_json_lines())
    add_frames(people, source.json());
  else
    add_content(people, source.json());
  people.has_depths_only = any_depths(people);
  const auto first = source.first_json_if_any();
  if (first) take_rate_and_size(*first, people);
  name_joints_by_count(people, source.name(),
                       first ? names_in(*first) : std::vector<std::string>{});
  return people;
}

void write(const std::filesystem::path& path, const Track2d& track) {
  const std::string& set = set_to_write(track, kSets, kName);
  json names = json::object();
  for (int joint = 0; joint < track.joint_count(); ++joint)
    names[std::to_string(joint)] = track.joint_names[joint];
  json frames = json::array();
  for (int frame = 0; frame < track.frames(); ++frame) {
    json keypoints = json::array(), scores = json::array(), instances = json::array();
    const std::vector<double> numbers = numbers_of(track, frame);
    for (std::size_t i = 0; i < numbers.size(); i += 3) {
      keypoints.push_back({numbers[i], numbers[i + 1]});
      scores.push_back(numbers[i + 2]);
    }
    if (shows_anyone(track, frame))
      instances.push_back({{"keypoints", keypoints}, {"keypoint_scores", scores}});
    frames.push_back({{"frame_id", frame + 1}, {"instances", instances}});
  }
  const json content{{"meta_info", {{"dataset_name", set}, {"keypoint_id2name", names}}},
                     {"instance_info", frames}};
  write_text_file(path, content.dump());
}

}  // namespace

TrackFormat track_mmpose_format() {
  return {kName, "MMPose's and RTMPose's JSON, a file of frames or a folder of images",
          kSets, recognises,
          read,  write};
}

}  // namespace mcdbn
