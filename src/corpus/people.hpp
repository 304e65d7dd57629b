#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

// The person in a clip: by its bones where the clip itself is at hand; else, as of a training clip
// that is gone, by the file's name.

/// Numbers people in the order in which they come, distinguished by the person given or else by the
/// bones of their skeletons: files of one capture session share them. Where the body stands in the
/// rest pose (the OFFSETs up to body_root) is no bone.
class PeopleCount {
 public:
  std::size_t number_of(const Skeleton& skeleton, const std::string& given = {});

 private:
  struct Person {
    std::string given;
    std::vector<double> bones;
  };
  std::vector<Person> people_;
};

/// The person in a clip by its name: `08` of CMU's 08_01.bvh, `s02` of walk_s02_01.bvh as
/// `synthesize` names them. Empty where the name has none.
std::string person_of(const std::filesystem::path& file);

/// The action in a clip by its name: `walk` of walk_s02_01.bvh as `synthesize` names them,
/// `bow` of Bandai's dataset-1_bow_active_001.bvh. Else the name of its folder.
std::string action_of(const std::filesystem::path& file);

}  // namespace mcdbn
