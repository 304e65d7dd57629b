#pragma once

#include <vector>

#include "synthesis/synthesize_rig.hpp"

namespace mcdbn::synthesis {

/// What an action generates from. The random stream is the clip's own.
struct ClipSetup {
  Body body;
  Style style;
  Random random;
  double fps;
  int frame_count;

  double seconds() const { return frame_count / fps; }
};

// Each action stands or goes about the origin, facing +z; `synthesize` adds drift and heading.
std::vector<Frame> walk(ClipSetup& setup);
std::vector<Frame> jump(ClipSetup& setup);
std::vector<Frame> jumping_jacks(ClipSetup& setup);
/// @param hands 1: the right hand, 2: both
std::vector<Frame> wave(ClipSetup& setup, int hands);
std::vector<Frame> clap(ClipSetup& setup);
std::vector<Frame> throw_object(ClipSetup& setup);

}  // namespace mcdbn::synthesis
