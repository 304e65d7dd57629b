#include "formats/joint_naming.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/motion/humanoid_rig.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {
namespace {

struct CountedSets {
  std::size_t joints;
  std::vector<std::string> sets;     ///< candidates, the usual one first
  const char* whole_body = nullptr;  ///< what it is with face and hands, which follow the body
};

const std::vector<CountedSets>& counted_sets() {
  static const std::vector<CountedSets> sets{
      {17, {"COCO_17", "H36M_17"}},
      {18, {"COCO_18"}},
      {23, {"COCO_23"}},
      {25, {"BODY_25", "BODY_25B"}},
      {26, {"HALPE_26"}},
      {33, {"MEDIAPIPE_33"}},
      {133, {"COCO_23"}, "COCO-WholeBody"},
      {134, {"COCO_18"}, "COCO-WholeBody in OpenPose's order"},
      {135, {"BODY_25B"}, "OpenPose's BODY_135"},
      {136, {"HALPE_26"}, "Halpe-136"},
  };
  return sets;
}

/// {"x": […], "y": […], "visible": […]}
SeenPerson person_of_lists(const JsonPlace& keypoints) {
  SeenPerson person;
  person.x_px = keypoints["x"].numbers();
  person.y_px = keypoints["y"].numbers();
  person.confidence = keypoints.has("visible") ? keypoints["visible"].numbers()
                                               : std::vector<double>(person.x_px.size(), 1.0);
  if (person.y_px.size() != person.x_px.size() || person.confidence.size() != person.x_px.size())
    keypoints.fail("lists of different lengths");
  mark_missing(person);
  return person;
}

/// @return the numbers of [x, y, …]. @throws InputError if it holds fewer than two
std::vector<double> point_of(const JsonPlace& joint) {
  std::vector<double> numbers = joint.numbers();
  if (numbers.size() < 2) joint.fail(fmt::format("{} numbers; x and y are needed", numbers.size()));
  return numbers;
}

void set_length(SeenPeople& people, std::size_t joints) {
  for (auto& [number, frame] : people.frames)
    for (SeenPerson& person : frame)
      for (std::vector<double>* values : {&person.x_px, &person.y_px, &person.confidence})
        values->resize(joints);
}

/// Joints of every person. @throws InputError if they differ, or are too many
std::size_t joint_count(const SeenPeople& people, const std::string& file) {
  std::size_t count = 0;
  for (const auto& [number, frame] : people.frames)
    for (const SeenPerson& person : frame) {
      if (count != 0 && person.x_px.size() != count)
        throw InputError(fmt::format("{}: people of {} joints and, in frame {}, of {}", file, count,
                                     number, person.x_px.size()));
      count = person.x_px.size();
    }
  require_joints(count, file);
  return count;
}

/// Whether the names are those of a skeleton's joints: as such they are all of a person's limbs,
/// and more are known than as places that detectors see (whose `LeftFoot` may be the toes).
bool are_a_skeletons(const std::vector<std::string>& names) {
  if (are_a_detectors(names)) return false;
  const SkeletonRoles roles = roles_by_name(names);
  for (const auto& limb : kPersonsLimbs)
    for (const JointRole left : limb)
      if (!roles.has(left) || !roles.has(other_side(left))) return false;
  const auto places = std::ranges::count_if(
      keypoints_of(names), [](const Keypoint& keypoint) { return keypoint.role.has_value(); });
  return std::ssize(joint_roles()) - std::ssize(roles.missing()) > places;
}

}  // namespace

bool is_joint_count(std::size_t joints) {
  return std::ranges::find(counted_sets(), joints, &CountedSets::joints) != counted_sets().end();
}

void name_joints_by_count(SeenPeople& people, const std::string& file,
                          const std::vector<std::string>& names) {
  const std::size_t count = joint_count(people, file);
  if (count == 0) throw NoPersonSeen(file);
  const auto counted = std::ranges::find(counted_sets(), count, &CountedSets::joints);
  const bool more_than_body = counted != counted_sets().end() && counted->whole_body;
  if (names.size() == count && !more_than_body) {
    name_joints(people, names);
    return;
  }
  if (counted == counted_sets().end()) {
    people.notices.push_back(fmt::format("{} joints: no joint set of that count is known", count));
    for (std::size_t joint = 0; joint < count; ++joint)
      people.joint_names.push_back(fmt::format("joint_{}", joint));
    people.keypoints = keypoints_of(people.joint_names);
    return;
  }
  const std::string& usual = counted->sets.front();
  if (counted->sets.size() > 1) people.possible_sets = counted->sets;
  SeenPeople named = people_of_set(usual);
  people.joint_names = std::move(named.joint_names);
  people.keypoints = std::move(named.keypoints);
  if (more_than_body)
    people.notices.push_back(
        fmt::format("{} joints: {}, of which the {} of the body are taken ({}); face and hands are "
                    "left out",
                    count, counted->whole_body, people.joint_names.size(), usual));
  set_length(people, people.joint_names.size());
}

bool are_a_detectors(const std::vector<std::string>& names) {
  const auto known = std::ranges::count_if(names, [](const std::string& name) {
    return std::ranges::any_of(joint_sets(), [&](const JointSet& set) {
      return std::ranges::find(set.keypoints, name, &Keypoint::name) != set.keypoints.end();
    });
  });
  return 2 * known > static_cast<std::ptrdiff_t>(names.size());
}

void name_joints(SeenPeople& people, std::vector<std::string> names) {
  if (!are_a_skeletons(names)) people.keypoints = keypoints_of(names);
  people.joint_names = std::move(names);
}

SeenPerson person_in_json(const JsonPlace& keypoints) {
  if (keypoints.is_object()) return person_of_lists(keypoints);
  if (keypoints.size() > 0 && keypoints.at(0).is_list()) {
    SeenPerson person;
    for (const JsonPlace& joint : keypoints.list()) {
      const std::vector<double> numbers = point_of(joint);
      person.x_px.push_back(numbers[0]);
      person.y_px.push_back(numbers[1]);
      person.confidence.push_back(numbers.size() < 3 ? 1.0 : numbers[2]);
    }
    mark_missing(person);
    return person;
  }
  const std::vector<double> numbers = keypoints.numbers();
  if (numbers.size() % 3 != 0)
    keypoints.fail(
        fmt::format("{} numbers; x, y and confidence of each joint are needed", numbers.size()));
  return person_of(numbers, numbers.size() / 3, 3);
}

SeenPerson person_in_json(const JsonPlace& keypoints, const JsonPlace& scores) {
  SeenPerson person;
  person.confidence = scores.numbers();
  const std::vector<JsonPlace> joints = keypoints.list();
  if (person.confidence.size() != joints.size())
    scores.fail(fmt::format("{} scores of {} joints", person.confidence.size(), joints.size()));
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::vector<double> numbers = point_of(joints[i]);
    person.x_px.push_back(numbers[0]);
    person.y_px.push_back(numbers[1]);
    // Some write the score, or another share, behind x and y, too.
    if (numbers.size() > 2 && numbers[2] != person.confidence[i])
      person.has_depths = person.has_depths || numbers[2] < 0 || numbers[2] > 1;
  }
  mark_missing(person);
  return person;
}

}  // namespace mcdbn
