#include "formats/seen_people.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/numbers.hpp"
#include "formats/frame_numbers.hpp"
#include "formats/track_source.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/joint_sets.hpp"

namespace mcdbn {

long long SeenPeople::id_of_track(std::string_view name) {
  return track_ids.emplace(name, track_ids.size()).first->second;
}

std::string SeenPeople::name_of_track(long long id) const {
  for (const auto& [name, its_id] : track_ids)
    if (its_id == id) return name;
  return std::to_string(id);
}

std::optional<ImageSize> SeenPeople::size_of_image(const TrackReadOptions& options) const {
  if (options.image_size) return options.image_size;
  if (image_size && image_size_is_given) return image_size;
  return options.camera_image ? options.camera_image : image_size;
}

bool SeenPeople::takes_default_size(const TrackReadOptions& options) const {
  return !options.image_size && !options.camera_image && image_size && !image_size_is_given;
}

void require_joints(std::size_t joints, const std::string& file) {
  if (joints > kMostJoints)
    throw InputError(
        fmt::format("{}: {} joints of a person; at most {} are read", file, joints, kMostJoints));
}

SeenPeople people_of_set(std::string_view set) {
  SeenPeople people;
  people.keypoints = joint_set(set).keypoints;
  for (const Keypoint& keypoint : people.keypoints) people.joint_names.push_back(keypoint.name);
  return people;
}

SeenPerson person_of(const std::vector<double>& numbers, std::size_t joints, std::size_t stride) {
  SeenPerson person;
  for (std::size_t joint = 0; joint < joints; ++joint) {
    const double* at = numbers.data() + joint * stride;
    person.x_px.push_back(at[0]);
    person.y_px.push_back(at[1]);
    person.confidence.push_back(stride < 3 ? 1.0 : at[2]);
  }
  mark_missing(person);
  return person;
}

void mark_missing(SeenPerson& person) {
  for (std::size_t joint = 0; joint < person.x_px.size(); ++joint) {
    double &x = person.x_px[joint], &y = person.y_px[joint], &c = person.confidence[joint];
    if (std::isfinite(x) && std::isfinite(y) && c > 0 && (x != 0 || y != 0)) continue;
    x = y = kNan;
    c = 0;
  }
}

SeenPeople people_of_folder(const TrackSource& source,
                            std::vector<SeenPerson> (*people_of)(const JsonPlace& content)) {
  SeenPeople people;
  const auto numbers = numbers_of_files(source.json_files(), &people.notices);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto& file = source.json_files()[i];
    if (!numbers[i]) {
      people.notices.push_back(
          fmt::format("{} has no frame number and is left out", file.filename().string()));
      continue;
    }
    const nlohmann::json content = source.json_of(file);
    const JsonPlace place(content, file.string());
    if (!people.frames.emplace(*numbers[i], people_of(place)).second)
      place.fail(
          fmt::format("a second file of frame {}; give a folder of one camera", *numbers[i]));
  }
  return people;
}

std::vector<double> numbers_of(const Track2d& track, int frame) {
  std::vector<double> numbers;
  for (int joint = 0; joint < track.joint_count(); ++joint) {
    const double x = track.x_px(frame, joint), y = track.y_px(frame, joint);
    const double confidence = track.confidence(frame, joint);
    if (std::isfinite(x) && std::isfinite(y) && confidence > 0)
      numbers.insert(numbers.end(), {x, y, confidence});
    else
      numbers.insert(numbers.end(), {0.0, 0.0, 0.0});
  }
  return numbers;
}

bool shows_anyone(const Track2d& track, int frame) {
  return (track.confidence.row(frame).array() > 0).any();
}

std::vector<int> frames_to_list(const Track2d& track) {
  const int last = track.frames() - 1;
  int shown = 0;
  for (int frame = 0; frame <= last; ++frame) shown += shows_anyone(track, frame) ? 1 : 0;
  const bool sparse = last >= kSparse * shown;
  std::vector<int> frames;
  int step = 0;
  for (int frame = 0; frame <= last; ++frame) {
    if (!shows_anyone(track, frame) && frame != 0 && frame != last &&
        !(sparse && frame % kSparse == 0))
      continue;
    frames.push_back(frame);
    step = std::gcd(step, frame);
  }
  if (step > 1) frames.insert(frames.begin() + 1, 1);
  return frames;
}

const std::string& set_to_write(const Track2d& track, const std::vector<std::string>& sets,
                                const std::string& format) {
  const JointSet* set = joint_set_of(track.joint_names);
  const auto found = set == nullptr ? sets.end() : std::ranges::find(sets, set->name);
  if (found == sets.end())
    throw InputError(fmt::format(
        "the format {} has room for the joints of {} in their order, not for these {}: {}", format,
        fmt::join(sets, ", "), track.joint_count(), fmt::join(track.joint_names, ", ")));
  return *found;
}

}  // namespace mcdbn
