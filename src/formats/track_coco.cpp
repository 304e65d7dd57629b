// COCO keypoints: annotations (an object with images and annotations) and results (a list with an
// entry for each person of each image, or with such a list of each image).
// Facts: cocodataset.org, "Data format" and "Results format".
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text_file.hpp"
#include "formats/image_numbers.hpp"
#include "formats/joint_naming.hpp"
#include "formats/result_entries.hpp"
#include "formats/track_formats.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

const char* const kName = "coco";
const std::vector<std::string> kSets{"COCO_17", "COCO_23", "HALPE_26"};

/// An entry of results: a number of an image, and one list of numbers.
bool is_result(const JsonPlace& entry) {
  return entry.has("image_id") && entry.has("keypoints") && entry["image_id"].value().is_number() &&
         !entry.has("box") && !entry.has("idx");
}

bool recognises(const TrackSource& source) {
  const auto content = source.json_if_any();
  if (!content) return false;
  if (const auto entry = first_result_entry(*content)) return is_result(*entry);
  return content->has("annotations") && content->has("images");
}

/// Annotations have 0 for a joint that is not labelled, 1 for a hidden one, 2 for a visible one.
void turn_flags_to_confidences(SeenPeople& people) {
  people.notices.emplace_back(
      "visibility flags, not confidences: 2 (visible) is taken as 1, 1 (hidden) as 0.5");
  for (auto& [number, frame] : people.frames)
    for (SeenPerson& person : frame)
      for (double& confidence : person.confidence) confidence /= 2;
}

bool are_flags(const SeenPeople& people) {
  double most = 0;
  for (const auto& [number, frame] : people.frames)
    for (const SeenPerson& person : frame)
      for (const double confidence : person.confidence) {
        if (confidence != 0 && confidence != 1 && confidence != 2) return false;
        most = std::max(most, confidence);
      }
  return most == 2;
}

void add_person(SeenPeople& people, const ImageNumbers& images, const JsonPlace& entry) {
  auto& frame = people.frames[images.of(entry["image_id"])];
  SeenPerson person = person_in_json(entry["keypoints"]);
  if (entry.has("track_id") && entry["track_id"].value().is_number())
    person.id = entry["track_id"].whole_number();
  frame.push_back(std::move(person));
}

void add_images(SeenPeople& people, const ImageNumbers& numbers, const JsonPlace& images) {
  ImageSize least{1 << 30, 1 << 30}, most;
  for (const JsonPlace& image : images.list()) {
    people.frames[numbers.of(image["id"])];
    if (!image.has("width") || !image.has("height")) continue;
    const auto side = [](const JsonPlace& place) {
      const long long value = place.whole_number();
      if (value < 1 || value > 1'000'000) place.fail("no usable number of pixels");
      return static_cast<int>(value);
    };
    const ImageSize size{side(image["width"]), side(image["height"])};
    least = {std::min(least.width_px, size.width_px), std::min(least.height_px, size.height_px)};
    most = {std::max(most.width_px, size.width_px), std::max(most.height_px, size.height_px)};
  }
  if (most.width_px == 0) return;
  people.image_size = most;
  if (!(least == most))
    people.notices.push_back(
        fmt::format("its images differ in size: taken as {} x {} px, which holds all of them",
                    most.width_px, most.height_px));
}

SeenPeople read_annotations(const JsonPlace& content) {
  const ImageNumbers images(content["images"].list(), "id");
  SeenPeople people;
  add_images(people, images, content["images"]);
  for (const JsonPlace& annotation : content["annotations"].list())
    if (annotation.has("keypoints") && annotation["keypoints"].size() > 0)
      add_person(people, images, annotation);
  return people;
}

/// The names that the file's category gives its joints; none: it gives no names.
std::vector<std::string> category_names(const JsonPlace& content) {
  std::vector<std::string> names;
  if (!content.has("categories") || content["categories"].size() == 0) return names;
  const JsonPlace category = content["categories"].at(0);
  if (category.has("keypoints"))
    for (const JsonPlace& name : category["keypoints"].list()) names.push_back(name.text());
  return names;
}

SeenPeople read(const TrackSource& source) {
  const JsonPlace content = source.json();
  SeenPeople people;
  if (content.is_list()) {
    const std::vector<JsonPlace> entries = result_entries(content);
    const ImageNumbers images(entries, "image_id");
    for (const JsonPlace& entry : entries) add_person(people, images, entry);
  } else {
    people = read_annotations(content);
  }
  if (are_flags(people)) turn_flags_to_confidences(people);
  name_joints_by_count(people, source.name(),
                       content.is_object() ? category_names(content) : std::vector<std::string>{});
  return people;
}

/// Results, with numbers of frames as numbers of images.
void write(const std::filesystem::path& path, const Track2d& track) {
  set_to_write(track, kSets, kName);
  json entries = json::array();
  for (const int frame : frames_to_list(track)) {
    const auto joints = static_cast<double>(track.joint_count());
    entries.push_back({{"image_id", frame},
                       {"category_id", 1},
                       {"keypoints", numbers_of(track, frame)},
                       {"score", track.confidence.row(frame).sum() / joints}});
  }
  write_text_file(path, entries.dump());
}

}  // namespace

TrackFormat track_coco_format() {
  return {kName, "COCO keypoints: annotations, or a list of results", kSets, recognises, read,
          write};
}

}  // namespace mcdbn
