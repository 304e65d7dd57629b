#include "corpus/held_out_person.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "corpus/clip_groups.hpp"

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

std::string file_name(const TrainingClip& clip) {
  return std::filesystem::path(clip.path).filename().string();
}

/// Amount of data of a person.
struct Amount {
  std::set<std::string> clips;
  double duration = 0;
};

std::optional<std::size_t> with_least_data(const std::map<std::size_t, Amount>& people,
                                           std::size_t fewest_people) {
  if (fewest_people == 0 || people.size() < std::max<std::size_t>(fewest_people, 2)) return {};
  // Fewest frames first; one with a single clip only where none has more.
  const auto less_data = [](const auto& x, const auto& y) {
    const bool x_single = x.second.clips.size() < 2, y_single = y.second.clips.size() < 2;
    return x_single != y_single ? y_single : x.second.duration < y.second.duration;
  };
  return std::min_element(people.begin(), people.end(), less_data)->first;
}

}  // namespace

std::optional<std::size_t> person_to_hold_out(const TrainingSet& views, std::size_t fewest_people) {
  std::map<std::size_t, Amount> people;
  for (std::size_t i = 0; i < views.people.size(); ++i) {
    Amount& amount = people[views.people[i]];
    amount.clips.insert(views.clips[i].path);
    amount.duration += static_cast<double>(views.poses[i].rows());
  }
  return with_least_data(people, fewest_people);
}

std::optional<std::size_t> person_to_hold_out(const ClipStore& clips, std::size_t fewest_people) {
  const ClipGroups groups(clips);
  std::map<std::size_t, Amount> people;
  for (std::size_t i = 0; i < clips.count(); ++i) {
    Amount& amount = people[groups.people()[i]];
    amount.clips.insert(clips.record(i).clip.path);
    amount.duration += clips.record(i).seconds();
  }
  return with_least_data(people, fewest_people);
}

TrainingSet views_of(const TrainingSet& views, std::size_t person) {
  return selected(views, person, true);
}

TrainingSet views_without(const TrainingSet& views, std::size_t person) {
  return selected(views, person, false);
}

std::vector<std::string> clip_names(const TrainingSet& views) {
  std::set<std::string> names;
  for (const TrainingClip& clip : views.clips) names.insert(file_name(clip));
  return {names.begin(), names.end()};
}

std::vector<std::string> clip_names(const ClipStore& clips, std::size_t person) {
  const ClipGroups groups(clips);
  std::set<std::string> names;
  for (std::size_t i = 0; i < clips.count(); ++i)
    if (groups.people()[i] == person) names.insert(file_name(clips.record(i).clip));
  return {names.begin(), names.end()};
}

}  // namespace mcdbn
