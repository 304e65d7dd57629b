#include "fitting/clip_windows.hpp"

#include <algorithm>

#include "base/fade_in.hpp"

namespace mcdbn {

std::vector<ClipWindow> windows_of(Eigen::Index frames, const WindowSizes& sizes) {
  if (frames <= sizes.frames + 2 * sizes.overlap) return {{0, frames}};
  const Eigen::Index count = (frames + sizes.frames - 1) / sizes.frames;
  std::vector<ClipWindow> windows;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index first = std::max<Eigen::Index>(0, i * frames / count - sizes.overlap);
    const Eigen::Index end = std::min(frames, (i + 1) * frames / count + sizes.overlap);
    windows.push_back({first, end - first});
  }
  return windows;
}

double share_of_window(const ClipWindow& window, Eigen::Index known, Eigen::Index t) {
  return fade_in(static_cast<double>(t), static_cast<double>(known - window.first));
}

}  // namespace mcdbn
