// NumPy arrays: [frames x joints x 2 to 4], [people x frames x joints x 2 to 4] as MMAction2 keeps
// them, the same with the frames first, also with axes of length 1 between (MoveNet's answers, one
// behind the other), or flat [frames x joints·2 or 3]; the joints by their count.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "base/npy.hpp"
#include "base/text_file.hpp"
#include "formats/joint_naming.hpp"
#include "formats/track_formats.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/joint_sets.hpp"

namespace mcdbn {
namespace {

const char* const kName = "npy";
const std::vector<std::string> kSets{"COCO_17", "COCO_18",  "BODY_25",      "BODY_25B",
                                     "COCO_23", "HALPE_26", "MEDIAPIPE_33", "H36M_17"};

bool recognises(const TrackSource& source) {
  return !source.is_folder() && source.text().starts_with("\x93NUMPY");
}

bool is_known_count(std::size_t joints) {
  return std::ranges::any_of(joint_sets(),
                             [&](const JointSet& set) { return set.keypoints.size() == joints; });
}

/// Without the axes of length 1 that are too many, as models put them before the joints.
std::vector<std::size_t> at_most_four(std::vector<std::size_t> shape) {
  while (shape.size() > 4) {
    const auto joints = shape.end() - 2;
    const auto one = std::find(shape.begin(), joints, std::size_t{1});
    if (one == joints) break;
    shape.erase(one);
  }
  return shape;
}

/// The shape with all four dimensions: [people, frames, joints, numbers a joint].
std::vector<std::size_t> full_shape(const std::vector<std::size_t>& given,
                                    const std::string& file) {
  std::vector<std::size_t> shape = at_most_four(given);
  if (shape.size() == 2) {
    for (const std::size_t numbers : {std::size_t{3}, std::size_t{2}, std::size_t{4}})
      if (shape[1] % numbers == 0 && is_known_count(shape[1] / numbers))
        return {1, shape[0], shape[1] / numbers, numbers};
  } else if (!shape.empty() && shape.back() >= 2 && shape.back() <= 4) {
    if (shape.size() == 3) return {1, shape[0], shape[1], shape[2]};
    if (shape.size() == 4) return shape;
  }
  throw InputError(fmt::format(
      "{}: an array of {}; frames x joints x 2 (x, y) or 3 (with confidence) is read, also with "
      "people before them",
      file, fmt::join(given, " x ")));
}

/// Where the confidence stands among a joint's numbers: the last, if those are not depths.
std::size_t stride_to_confidence(const NpyArray& array, std::size_t numbers) {
  if (numbers < 3) return 0;
  for (std::size_t i = numbers - 1; i < array.values.size(); i += numbers)
    if (array.values[i] < 0) return 0;
  return numbers - 1;
}

NpyArray array_in(const TrackSource& source) {
  try {
    return npy_array(source.text());
  } catch (const std::runtime_error& error) {
    throw InputError(fmt::format("{}: not a readable .npy file: {}", source.name(), error.what()));
  }
}

SeenPeople read(const TrackSource& source) {
  const NpyArray array = array_in(source);
  if (array.values.empty()) throw InputError(fmt::format("{}: no numbers", source.name()));
  const std::vector<std::size_t> shape = full_shape(array.shape, source.name());
  const std::size_t joints = shape[2], numbers = shape[3];
  const std::size_t confidence = stride_to_confidence(array, numbers);
  SeenPeople people;
  people.axes_are_unnamed = true;
  if (numbers > 2 && confidence == 0)
    people.notices.emplace_back(
        "the numbers behind x and y are not all positive: depths, left out");
  // More frames than people.
  const bool frames_first = shape[0] > shape[1];
  // A place among several is no number: detectors list each frame's people in an order of its own.
  const bool one_person = std::min(shape[0], shape[1]) == 1;
  auto value = array.values.begin();
  for (std::size_t outer = 0; outer < shape[0]; ++outer)
    for (std::size_t inner = 0; inner < shape[1]; ++inner) {
      const std::size_t frame = frames_first ? outer : inner;
      SeenPerson seen;
      for (std::size_t joint = 0; joint < joints;
           ++joint, value += static_cast<std::ptrdiff_t>(numbers)) {
        seen.x_px.push_back(value[0]);
        seen.y_px.push_back(value[1]);
        seen.confidence.push_back(confidence == 0 ? 1.0
                                                  : value[static_cast<std::ptrdiff_t>(confidence)]);
      }
      mark_missing(seen);
      if (one_person) seen.id = 0;
      people.frames[static_cast<long long>(frame)].push_back(std::move(seen));
    }
  name_joints_by_count(people, source.name());
  return people;
}

void write(const std::filesystem::path& path, const Track2d& track) {
  set_to_write(track, kSets, kName);
  NpyArray array{
      {static_cast<std::size_t>(track.frames()), static_cast<std::size_t>(track.joint_count()), 3},
      {}};
  for (int frame = 0; frame < track.frames(); ++frame) {
    const std::vector<double> numbers = numbers_of(track, frame);
    array.values.insert(array.values.end(), numbers.begin(), numbers.end());
  }
  write_text_file(path, npy_bytes(array));
}

}  // namespace

TrackFormat track_npy_format() {
  return {kName, "NumPy: frames x joints x 2 or 3, the joints by their count",
          kSets, recognises,
          read,  write};
}

}  // namespace mcdbn
