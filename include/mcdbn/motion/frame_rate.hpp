#pragma once

#include "mcdbn/base/settings.hpp"

namespace mcdbn {

/// Frames a second that motion, tracks and films may have, wherever a rate comes from: ten seconds
/// between frames are no motion any more, and no camera is faster than the other end.
inline constexpr Range kFrameRate_hz = within(0.1, 10'000);
/// Frame rates that cameras and motion capture have; a file with another is read with a notice.
inline constexpr Range kUsualFrameRate_hz = within(5, 300);

}  // namespace mcdbn
