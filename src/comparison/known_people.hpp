#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "corpus/people.hpp"
#include "mcdbn/corpus/training_clip.hpp"

namespace mcdbn {

/// Whom a model was trained on: by their bones if all of its training clips can still be read, else
/// by the names of their files.
class KnownPeople {
 public:
  explicit KnownPeople(std::vector<TrainingClip> clips);

  /// The person of a test clip, if a training clip shows the same one, or that clip's file name
  /// where the person has none; empty if none does. Nothing if only names could tell, and the test
  /// clip's name has no person.
  /// @throws InputError if the file cannot be read
  std::optional<std::string> find(const std::filesystem::path& file);

 private:
  /// By their number; nothing if a clip is gone.
  std::optional<std::vector<std::string>> names_by_bones();

  std::vector<TrainingClip> clips_;
  PeopleCount people_;
  std::optional<std::vector<std::string>> names_;
};

}  // namespace mcdbn
