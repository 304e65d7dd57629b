#include "formats/image_shares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

bool are_shares(const std::vector<std::vector<SeenPerson>>& frames, const std::string& file) {
  // World landmarks have the hips at the origin and y down: the head is half a metre above it, and
  // one hip is always left of it, also of a body seen from its side. Of a body in a picture that
  // much is above the image, and some of it left of it as well, in no picture of use.
  constexpr double kLeft = -0.02, kAbove = -0.2;
  long long all = 0, small = 0, left = 0, above = 0;
  for (const auto& people : frames)
    for (const SeenPerson& person : people)
      for (std::size_t joint = 0; joint < person.x_px.size(); ++joint) {
        if (!(person.confidence[joint] > 0)) continue;
        const double x = person.x_px[joint], y = person.y_px[joint];
        ++all;
        small += std::max(std::abs(x), std::abs(y)) <= kLargestShare ? 1 : 0;
        left += x < kLeft ? 1 : 0;
        above += y < kAbove ? 1 : 0;
      }
  if (2 * small <= all) return false;
  if (20 * left >= all && 5 * above >= all)
    throw InputError(
        fmt::format("{}: its coordinates lie about 0: a body in space (world landmarks, metres), "
                    "not places in an image",
                    file));
  return true;
}

void shares_to_px(std::vector<SeenPerson>& people, const ImageSize& size) {
  for (SeenPerson& person : people)
    for (std::size_t joint = 0; joint < person.x_px.size(); ++joint) {
      person.x_px[joint] *= size.width_px;
      person.y_px[joint] *= size.height_px;
    }
}

}  // namespace mcdbn
