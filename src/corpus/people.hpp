#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

// Who a clip shows. Its bones tell where the clip itself is at hand; of the clips that a model was
// trained on only the files' names are, so there the name has to tell.

/// Numbers people in the order in which they come, told by the bones of their skeletons: files of
/// one capture session share them.
class PeopleCount {
 public:
  std::size_t number_of(const Skeleton& skeleton);

 private:
  std::vector<std::vector<double>> bones_;  ///< of each person so far
};

/// Who a clip shows, where its name tells: `08` of CMU's 08_01.bvh, `s02` of walk_s02_01.bvh as
/// `synthesize` names them. Empty where it does not.
std::string person_of(const std::filesystem::path& file);

}  // namespace mcdbn
