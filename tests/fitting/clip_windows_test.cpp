// How a clip is cut into windows that are solved one by one.

#include "fitting/clip_windows.hpp"

#include <doctest/doctest.h>

#include <algorithm>

namespace clip_windows_test {

using namespace mcdbn;

TEST_CASE("clip windows: they cover the clip, and have as many frames of their own") {
  for (const WindowSizes sizes : {kAllFrames, kFewFrames, WindowSizes{7, 2}})
    for (Eigen::Index frames = 1; frames < 5 * sizes.frames; frames += 3) {
      CAPTURE(frames);
      const std::vector<ClipWindow> windows = windows_of(frames, sizes);
      Eigen::Index known = 0, least = frames, most = 0;
      for (std::size_t i = 0; i < windows.size(); ++i) {
        const bool last = i + 1 == windows.size();
        const Eigen::Index own_end = last ? frames : windows[i].end() - sizes.overlap;
        REQUIRE(windows[i].first == std::max<Eigen::Index>(0, known - sizes.overlap));
        REQUIRE(windows[i].end() <= frames);
        least = std::min(least, own_end - known);
        most = std::max(most, own_end - known);
        known = own_end;
      }
      CHECK(windows.back().end() == frames);
      CHECK(most - least <= 1);
      if (windows.size() > 1) CHECK(most <= sizes.frames);
      CHECK((windows.size() == 1) == (frames <= sizes.frames + 2 * sizes.overlap));
    }
}

TEST_CASE("clip windows: no more of them than it takes") {
  CHECK(windows_of(361).size() == 2);
  CHECK(windows_of(600).size() == 2);
  CHECK(windows_of(601).size() == 3);
}

}  // namespace clip_windows_test
