// OpenPose: `--write_json`, a folder with a file for each frame, or one such file; and what others
// write in this layout (Pose2Sim's RTMPose: HALPE_26; tf-pose-estimation: COCO_18).
// Facts: OpenPose's doc/02_output.md.
#include <fmt/format.h>

#include "base/interruption.hpp"
#include "base/text_file.hpp"
#include "formats/frame_numbers.hpp"
#include "formats/frame_times.hpp"
#include "formats/joint_naming.hpp"
#include "formats/rate_and_size.hpp"
#include "formats/track_formats.hpp"

namespace mcdbn {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const char* const kName = "openpose";
const std::vector<std::string> kSets{"BODY_25", "BODY_25B", "COCO_18", "HALPE_26",
                                     "COCO_17", "COCO_23",  "H36M_17"};

bool is_frame(const JsonPlace& place) {
  return place.has("people") && place["people"].is_list();
}

/// Version 1.0 wrote `pose_keypoints`.
const char* body_key(const JsonPlace& person) {
  const bool old = !person.has("pose_keypoints_2d") && person.has("pose_keypoints");
  return old ? "pose_keypoints" : "pose_keypoints_2d";
}

/// Whether the first person whom a frame shows has such a key; none: it shows nobody.
std::optional<bool> has_body_key(const JsonPlace& frame) {
  if (!is_frame(frame)) return {};
  for (const JsonPlace& person : frame["people"].list())
    if (!shows_nobody(person.value())) return person.has(body_key(person));
  return {};
}

bool recognises(const TrackSource& source) {
  const auto first = source.first_json_if_any();
  if (!first) return false;
  // No other format has people in the files of a folder.
  if (first->is_object())
    return is_frame(*first) && (source.is_folder() || has_body_key(*first).value_or(true));
  if (!first->is_list() || first->size() == 0 || !is_frame(first->at(0))) return false;
  for (std::size_t i = 0; i < first->size(); ++i)
    if (const auto has_key = has_body_key(first->at(i))) return *has_key;
  return true;
}

/// None for -1, [-1] and no value.
std::optional<long long> person_id(const JsonPlace& person) {
  if (!person.has("person_id")) return {};
  JsonPlace id = person["person_id"];
  if (id.is_list()) {
    if (id.size() == 0) return {};
    id = id.at(0);
  }
  const long long number = id.whole_number();
  return number < 0 ? std::nullopt : std::optional(number);
}

std::vector<SeenPerson> people_of(const JsonPlace& frame) {
  std::vector<SeenPerson> people;
  for (const JsonPlace& person : frame["people"].list()) {
    const JsonPlace keypoints = person[body_key(person)];
    if (keypoints.is_list() && keypoints.size() == 0) continue;  // a face or a hand alone
    people.push_back(person_in_json(keypoints));
    people.back().id = person_id(person);
  }
  return people;
}

SeenPeople read(const TrackSource& source) {
  SeenPeople people;
  if (source.is_folder()) {
    people = people_of_folder(source, people_of);
  } else if (const JsonPlace content = source.json(); content.is_list()) {
    const std::vector<long long> numbers = numbers_of_frames(content, people);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (!people.frames.emplace(numbers[i], people_of(content.at(i))).second)
        content.at(i).fail(fmt::format("a second frame {}", numbers[i]));
  } else {
    const auto number = frame_numbers({source.path().stem().string()}).front();
    people.frames.emplace(number.value_or(0), people_of(content));
  }
  if (const auto first = source.first_json_if_any()) take_rate_and_size(*first, people);
  name_joints_by_count(people, source.name());
  return people;
}

std::string frame_text(const Track2d& track, int frame) {
  json people = json::array();
  if (shows_anyone(track, frame))
    people.push_back({{"person_id", {-1}},
                      {"pose_keypoints_2d", numbers_of(track, frame)},
                      {"face_keypoints_2d", json::array()},
                      {"hand_left_keypoints_2d", json::array()},
                      {"hand_right_keypoints_2d", json::array()},
                      {"pose_keypoints_3d", json::array()},
                      {"face_keypoints_3d", json::array()},
                      {"hand_left_keypoints_3d", json::array()},
                      {"hand_right_keypoints_3d", json::array()}});
  return json{{"version", 1.3}, {"people", people}}.dump();
}

/// A folder of a file for each frame.
void write(const fs::path& path, const Track2d& track) {
  set_to_write(track, kSets, kName);
  OutputFile folder(path);
  make_folder(folder.temporary());
  const std::string name =
      path.filename().empty() ? path.parent_path().filename().string() : path.filename().string();
  {
    const OutputsAtOnce into_folder;
    for (int frame = 0; frame < track.frames(); ++frame) {
      check_interruption();
      write_text_file(folder.temporary() / fmt::format("{}_{:012}_keypoints.json", name, frame),
                      frame_text(track, frame));
    }
  }
  folder.put_in_place();
}

}  // namespace

TrackFormat track_openpose_format() {
  return {kName, "OpenPose's JSON, a folder with a file a frame or one file",
          kSets, recognises,
          read,  write};
}

}  // namespace mcdbn
