#include "corpus/held_out_person.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace mcdbn {
namespace {

TrainingSet selected(const TrainingSet& views, std::size_t person, bool that_person) {
  TrainingSet result{views.modalities, {}, {}, {}, {}, {}};
  for (std::size_t i = 0; i < views.poses.size(); ++i) {
    if ((views.people[i] == person) != that_person) continue;
    result.tracks.push_back(views.tracks[i]);
    result.poses.push_back(views.poses[i]);
    result.clips.push_back(views.clips[i]);
    result.people.push_back(views.people[i]);
    if (!views.groups.empty()) result.groups.push_back(views.groups[i]);
    if (!views.tracks_seen.empty()) result.tracks_seen.push_back(views.tracks_seen[i]);
  }
  return result;
}

}  // namespace

std::optional<std::size_t> person_to_hold_out(const TrainingSet& views, std::size_t fewest_people) {
  struct Amount {
    std::set<std::string> clips;
    Eigen::Index frames = 0;
  };
  std::map<std::size_t, Amount> people;
  for (std::size_t i = 0; i < views.people.size(); ++i) {
    people[views.people[i]].clips.insert(views.clips[i].path);
    people[views.people[i]].frames += views.poses[i].rows();
  }
  if (fewest_people == 0 || people.size() < std::max<std::size_t>(fewest_people, 2)) return {};
  // Fewest frames first; one with a single clip only where nobody has more.
  const auto missed_less = [](const auto& x, const auto& y) {
    const bool x_single = x.second.clips.size() < 2, y_single = y.second.clips.size() < 2;
    return x_single != y_single ? y_single : x.second.frames < y.second.frames;
  };
  return std::min_element(people.begin(), people.end(), missed_less)->first;
}

TrainingSet views_of(const TrainingSet& views, std::size_t person) {
  return selected(views, person, true);
}

TrainingSet views_without(const TrainingSet& views, std::size_t person) {
  return selected(views, person, false);
}

std::vector<std::string> clip_names(const TrainingSet& views) {
  std::set<std::string> names;
  for (const TrainingClip& clip : views.clips)
    names.insert(std::filesystem::path(clip.path).filename().string());
  return {names.begin(), names.end()};
}

}  // namespace mcdbn
