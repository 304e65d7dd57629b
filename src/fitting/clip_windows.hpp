#pragma once

#include <Eigen/Core>
#include <vector>

namespace mcdbn {

/// Consecutive frames of a clip that are solved together.
struct ClipWindow {
  Eigen::Index first = 0, frames = 0;

  Eigen::Index end() const { return first + frames; }
};

/// How a clip is cut.
struct WindowSizes {
  /// Most frames of a window, without overlap. Memory and time of its equations grow with them.
  Eigen::Index frames;
  /// Frames of its neighbours on either side: several times as long as an error lasts. Frames
  /// further away have no influence.
  Eigen::Index overlap;
};
inline constexpr WindowSizes kAllFrames{300, 30};
/// Where there are but a few frames a second. The window that all others wait for is short; its
/// frames still span more seconds than one of kAllFrames.
inline constexpr WindowSizes kFewFrames{150, 10};

/// Every frame is in one window at least; neighbours share twice the overlap. All have as many of
/// their own, so that the one which determines what all share is not a short rest.
std::vector<ClipWindow> windows_of(Eigen::Index frames, const WindowSizes& sizes = kAllFrames);

/// How much of a window counts in its frame `t`, beside the windows before it: it comes in over the
/// frames that both have. @param known frames of the clip that stand already
double share_of_window(const ClipWindow& window, Eigen::Index known, Eigen::Index t);

}  // namespace mcdbn
