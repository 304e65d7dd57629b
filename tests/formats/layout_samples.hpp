#pragma once

#include <string>
#include <vector>

#include "mcdbn/camera/track.hpp"

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

/// The figure of a joint set, 4 frames with nothing missing, that the samples show.
Track2d sample_figure(const std::string& joint_set);

}  // namespace mcdbn::test
