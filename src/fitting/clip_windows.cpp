#include "fitting/clip_windows.hpp"

#include <algorithm>

#include "base/fade_in.hpp"

namespace mcdbn {

std::vector<ClipWindow> windows_of(Eigen::Index frames) {
  if (frames <= kWindowFrames + 2 * kOverlapFrames) return {{0, frames}};
  std::vector<ClipWindow> windows;
  for (Eigen::Index own = 0; own < frames; own += kWindowFrames) {
    const Eigen::Index first = std::max<Eigen::Index>(0, own - kOverlapFrames);
    const Eigen::Index last = std::min(frames, own + kWindowFrames + kOverlapFrames);
    windows.push_back({first, last - first});
  }
  return windows;
}

double share_of_window(const ClipWindow& window, Eigen::Index known, Eigen::Index t) {
  return fade_in(static_cast<double>(t), static_cast<double>(known - window.first));
}

}  // namespace mcdbn
