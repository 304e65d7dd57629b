#include "comparison/known_people.hpp"

#include <algorithm>
#include <utility>

#include "base/interruption.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/motion_file.hpp"

namespace mcdbn {
namespace {

/// Empty if neither a list nor the file's name gave it.
std::string given_person(const TrainingClip& clip) {
  return clip.person.empty() ? person_of(clip.path) : clip.person;
}

std::string name_of(const TrainingClip& clip) {
  const std::string person = given_person(clip);
  return person.empty() ? std::filesystem::path(clip.path).filename().string() : person;
}

}  // namespace

KnownPeople::KnownPeople(std::vector<TrainingClip> clips)
    : clips_(std::move(clips)), names_(names_by_bones()) {}

std::optional<std::vector<std::string>> KnownPeople::names_by_bones() {
  std::vector<std::string> names;
  try {
    for (const TrainingClip& clip : clips_) {
      check_interruption();
      if (people_.number_of(read_skeleton(clip.path)) == names.size())
        names.push_back(name_of(clip));
    }
  } catch (const InputError&) {  // gone, or no longer what it was
    return {};
  }
  return names;
}

std::optional<std::string> KnownPeople::find(const std::filesystem::path& file) {
  if (names_) {
    const std::size_t number = people_.number_of(read_skeleton(file));
    return number < names_->size() ? (*names_)[number] : "";
  }
  const std::string person = person_of(file);
  if (person.empty()) return {};
  const bool known = std::ranges::any_of(
      clips_, [&](const TrainingClip& clip) { return given_person(clip) == person; });
  return known ? person : "";
}

}  // namespace mcdbn
