#include <algorithm>

#include "camera/body_places.hpp"
#include "formats/csv_table.hpp"
#include "formats/joint_naming.hpp"
#include "formats/landmarks.hpp"
#include "mcdbn/camera/joint_sets.hpp"

namespace mcdbn {
namespace {

/// Names that are only numbers ("L0", "landmark_12") carry no information beyond their count.
bool are_only_numbered(const std::vector<std::string>& names) {
  return std::ranges::all_of(names, [](const std::string& name) {
    const auto digit = name.find_first_of("0123456789");
    if (digit == std::string::npos) return false;
    const std::string word = lower(name.substr(0, digit));
    return word.size() <= 1 || word.starts_with("landmark") || word.starts_with("joint") ||
           word.starts_with("kp") || word.starts_with("keypoint") || word.starts_with("lm") ||
           word.starts_with("pose") || word.starts_with("point");
  });
}

/// Where each joint of the set stands among the names, in whatever spelling; none if they are not
/// the set's joints.
std::vector<std::size_t> places_of_set(const JointSet& set, const std::vector<std::string>& names) {
  std::vector<std::string> places;
  places.reserve(names.size());
  for (const std::string& name : names) places.push_back(place_name_of(name));
  std::vector<std::size_t> order;
  for (const Keypoint& keypoint : set.keypoints) {
    const auto found = std::ranges::find(places, place_name_of(keypoint.name));
    if (found == places.end()) return {};
    order.push_back(static_cast<std::size_t>(found - places.begin()));
    found->clear();  // none stands for two
  }
  return order;
}

void put_in_order(SeenPeople& people, const std::vector<std::size_t>& order) {
  for (auto& [number, frame] : people.frames)
    for (SeenPerson& person : frame)
      for (std::vector<double>* values : {&person.x_px, &person.y_px, &person.confidence}) {
        std::vector<double> ordered;
        ordered.reserve(order.size());
        for (const std::size_t at : order) ordered.push_back(values->at(at));
        *values = std::move(ordered);
      }
}

}  // namespace

bool is_person_column(std::string_view name) {
  const std::string known = plain(name);
  return known == "person" || known == "personid" || known == "poseid" || known == "trackid" ||
         known == "track";
}

void name_landmarks(SeenPeople& people, const std::string& file,
                    const std::vector<std::string>& names) {
  if (are_only_numbered(names)) return name_joints_by_count(people, file);
  name_joints_by_count(people, file, names);
  if (people.joint_names != names) return;
  for (const JointSet& set : joint_sets()) {
    if (set.keypoints.size() != names.size()) continue;
    const std::vector<std::size_t> order = places_of_set(set, names);
    if (order.empty()) continue;
    put_in_order(people, order);
    SeenPeople named = people_of_set(set.name);
    people.joint_names = std::move(named.joint_names);
    people.keypoints = std::move(named.keypoints);
    return;
  }
}

}  // namespace mcdbn
