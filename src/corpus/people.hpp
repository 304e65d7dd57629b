#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

// Who a clip shows. Its bones tell where the clip itself is at hand; of the clips that a model was
// trained on only the files' names are, so there the name has to tell.

/// Numbers people in the order in which they come, told by what is said of them or else by the
/// bones of their skeletons: files of one capture session share them.
class PeopleCount {
 public:
  std::size_t number_of(const Skeleton& skeleton, const std::string& said = {});

 private:
  struct Person {
    std::string said;
    std::vector<double> bones;
  };
  std::vector<Person> people_;
};

/// Who a clip shows, where its name tells: `08` of CMU's 08_01.bvh, `s02` of walk_s02_01.bvh as
/// `synthesize` names them. Empty where it does not.
std::string person_of(const std::filesystem::path& file);

/// What a clip shows, where its name tells: `walk` of walk_s02_01.bvh as `synthesize` names them,
/// `bow` of Bandai's dataset-1_bow_active_001.bvh. Else the name of its folder.
std::string action_of(const std::filesystem::path& file);

}  // namespace mcdbn
