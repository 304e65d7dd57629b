#include "fitting/clip_windows.hpp"

#include <algorithm>

#include "base/fade_in.hpp"

namespace mcdbn {

std::vector<ClipWindow> windows_of(Eigen::Index frames, const WindowSizes& sizes) {
  if (frames <= sizes.frames + 2 * sizes.overlap) return {{0, frames}};
  std::vector<ClipWindow> windows;
  for (Eigen::Index own = 0; own < frames; own += sizes.frames) {
    const Eigen::Index first = std::max<Eigen::Index>(0, own - sizes.overlap);
    const Eigen::Index last = std::min(frames, own + sizes.frames + sizes.overlap);
    windows.push_back({first, last - first});
  }
  return windows;
}

double share_of_window(const ClipWindow& window, Eigen::Index known, Eigen::Index t) {
  return fade_in(static_cast<double>(t), static_cast<double>(known - window.first));
}

}  // namespace mcdbn
