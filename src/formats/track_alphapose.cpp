// AlphaPose: one list with an entry for each person of each image, or with such a list of each
// image; `--format cmu` and `open` make an object with an entry for each image.
// Facts: AlphaPose's docs/output.md and alphapose/utils/pPose_nms.py.
#include <fmt/format.h>

#include "base/text_file.hpp"
#include "formats/image_numbers.hpp"
#include "formats/joint_naming.hpp"
#include "formats/result_entries.hpp"
#include "formats/track_formats.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

const char* const kName = "alphapose";
const std::vector<std::string> kSets{"HALPE_26", "COCO_17", "COCO_18", "COCO_23"};

bool is_entry(const JsonPlace& entry) {
  return entry.has("image_id") && entry.has("keypoints") &&
         (entry["image_id"].value().is_string() || entry.has("box") || entry.has("idx"));
}

bool is_image(const JsonPlace& image) {
  return image.has("bodies") || image.has("people");
}

bool recognises(const TrackSource& source) {
  const auto content = source.json_if_any();
  if (!content || content->size() == 0) return false;
  if (const auto entry = first_result_entry(*content)) return is_entry(*entry);
  return content->is_object() && is_image((*content)[content->keys().front()]);
}

/// A number, [number] or [[number], …]: the first one.
std::optional<long long> track_number(JsonPlace idx) {
  for (int depth = 0; depth < 3 && idx.is_list() && idx.size() > 0; ++depth) idx = idx.at(0);
  if (!idx.value().is_number()) return {};
  return idx.whole_number();
}

SeenPeople read_list(const JsonPlace& content) {
  const std::vector<JsonPlace> entries = result_entries(content);
  const ImageNumbers images(entries, "image_id");
  SeenPeople people;
  for (const JsonPlace& entry : entries) {
    SeenPerson person = person_in_json(entry["keypoints"]);
    if (entry.has("idx")) person.id = track_number(entry["idx"]);
    people.frames[images.of(entry["image_id"])].push_back(std::move(person));
  }
  return people;
}

SeenPeople read_images(const JsonPlace& content) {
  const ImageNumbers images(content.keys());
  SeenPeople people;
  for (const std::string& name : content.keys()) {
    const JsonPlace image = content[name];
    auto& frame = people.frames[images.of(image, name)];
    const bool bodies = image.has("bodies");
    for (const JsonPlace& body : image[bodies ? "bodies" : "people"].list())
      frame.push_back(person_in_json(body[bodies ? "joints" : "pose_keypoints_2d"]));
  }
  return people;
}

SeenPeople read(const TrackSource& source) {
  const JsonPlace content = source.json();
  SeenPeople people = content.is_list() ? read_list(content) : read_images(content);
  name_joints_by_count(people, source.name());
  return people;
}

void write(const std::filesystem::path& path, const Track2d& track) {
  set_to_write(track, kSets, kName);
  json entries = json::array();
  for (const int frame : frames_to_list(track))
    entries.push_back({{"image_id", fmt::format("{}.jpg", frame)},
                       {"category_id", 1},
                       {"keypoints", numbers_of(track, frame)},
                       {"score", track.confidence.row(frame).sum()},
                       {"idx", {0.0}}});
  write_text_file(path, entries.dump());
}

}  // namespace

TrackFormat track_alphapose_format() {
  return {kName, "AlphaPose's results, one list", kSets, recognises, read, write};
}

}  // namespace mcdbn
