#pragma once

#include <cstddef>
#include <vector>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Numbers people in the order in which they come, told by the bones of their skeletons: files of
/// one capture session share them.
class PeopleCount {
 public:
  std::size_t number_of(const Skeleton& skeleton);

 private:
  std::vector<std::vector<double>> bones_;  ///< of each person so far
};

}  // namespace mcdbn
