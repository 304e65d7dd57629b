#include "formats/image_shares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

bool are_shares(const std::vector<std::vector<SeenPerson>>& frames, bool depths,
                const std::string& file) {
  // World landmarks have the hips at the origin and y down: the head is half a metre above it, and
  // one hip is always left of it, also of a body seen from its side. No picture of use shows a body
  // that much above the image, and some of it left of it as well.
  constexpr double kLeft = -0.02, kAbove = -0.2;
  long long all = 0, small = 0, left = 0, above = 0;
  for_each_seen_joint(frames, [&](double x, double y, double) {
    ++all;
    small += std::max(std::abs(x), std::abs(y)) <= kLargestShare ? 1 : 0;
    left += x < kLeft ? 1 : 0;
    above += y < kAbove ? 1 : 0;
  });
  if (2 * small <= all) return false;
  if (20 * left >= all && 5 * above >= all)
    throw InputError(
        fmt::format("{}: its coordinates lie about 0: a body in space (world landmarks, metres), "
                    "not places in an image",
                    file));
  // The second of three coordinates may be a depth: what lies above 0 is then no head.
  if (depths) require_image_places(frames, depths, file);
  return true;
}

void require_image_places(const std::vector<std::vector<SeenPerson>>& frames, bool depths,
                          const std::string& file) {
  // Feet alone may be in the picture, and all that a detector guesses above them outside. Those
  // that give depths (MediaPipe) need the trunk; points in space about their origin are outside
  // unless both x and y are above 0: three of four.
  const double most_outside = depths ? 0.5 : 0.9;
  constexpr double kBeyond = 0.02;  // of the extent: detectors guess a little beyond the edge
  double extent = 0;
  for_each_seen_joint(frames, [&](double x, double y, double) {
    extent = std::max({extent, std::abs(x), std::abs(y)});
  });
  long long all = 0, outside = 0;
  for_each_seen_joint(frames, [&](double x, double y, double) {
    ++all;
    outside += std::min(x, y) < -kBeyond * extent ? 1 : 0;
  });
  if (static_cast<double>(outside) > most_outside * static_cast<double>(all))
    throw InputError(
        fmt::format("{}: {} of {} joints lie left of or above the image: points in space, not "
                    "places in an image",
                    file, outside, all));
}

void shares_to_px(std::vector<SeenPerson>& people, const ImageSize& size) {
  for (SeenPerson& person : people)
    for (std::size_t joint = 0; joint < person.x_px.size(); ++joint) {
      person.x_px[joint] *= size.width_px;
      person.y_px[joint] *= size.height_px;
    }
}

}  // namespace mcdbn
