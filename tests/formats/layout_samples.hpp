#pragma once

#include <string>
#include <vector>

namespace mcdbn::test {

/// A small file as some tool lays it out, of a figure that walks.
struct LayoutSample {
  std::string name;    ///< of the file
  std::string format;  ///< that recognises it
  std::string joint_set;
  int frames, people;
  std::string text;
};

const std::vector<LayoutSample>& layout_samples();

}  // namespace mcdbn::test
