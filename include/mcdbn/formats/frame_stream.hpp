#pragma once

#include <iosfwd>
#include <memory>

#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// Writes motion frame by frame, as it comes; each frame is flushed.
class FrameStream {
 public:
  virtual ~FrameStream() = default;
  /// @param skeleton whose bones may become other in length from frame to frame
  /// @param channels [1 x channels]  @param seen whether anybody was: only JSON has it
  /// @throws InputError if it cannot be written
  virtual void write(const Skeleton& skeleton, const RowVectorD& channels, bool seen) = 0;
  /// No more frames will come.
  virtual void finish() = 0;
};

/// BVH. The hierarchy, with the bones of the first frame, and the number of frames stand before the
/// frames: the number is written as 1. Where `rewritable`, finish() writes both anew, with the
/// bones of the last frame and the true number, over the same bytes: both are padded to a fixed
/// width.
/// @param out stays open  @param rewritable whether its beginning can be written again
std::unique_ptr<FrameStream> bvh_stream(std::ostream& out, double fps, bool rewritable);

/// CSV: a header, then for each frame its number, its time and where each joint is in the world, in
/// file units: frame, time_s, JOINT_x, JOINT_y, JOINT_z …
std::unique_ptr<FrameStream> csv_stream(std::ostream& out, double fps);

/// JSON lines: {"frame": 0, "time_s": 0, "seen": true, "channels": […],
/// "joints": {"Hips": [x, y, z], …}}, channels in the BVH's order.
std::unique_ptr<FrameStream> json_stream(std::ostream& out, double fps);

}  // namespace mcdbn
