#include "motion_model/returned_sides.hpp"

#include <algorithm>
#include <cmath>

#include "camera/limb_spells.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion_model/recent_track.hpp"

namespace mcdbn {
namespace {

/// Time on either side of a spell that is compared, too: how limbs move there shows their sides.
constexpr double kAround_s = 2;
/// Least log-likelihood ratio, in favour of the exchanged sides. Chosen on detector-like tracks of
/// training people whose legs are hidden twice for 0.25 s.
constexpr double kClearly = 3;

}  // namespace

std::vector<SideSwap> swapped_spells(Track2d track,
                                     const std::function<double(const Track2d&)>& energy) {
  std::vector<SideSwap> swaps;
  const auto around = static_cast<Eigen::Index>(std::lround(kAround_s * track.fps));
  for (const SideSwap& spell : limb_spells(track)) {
    const Eigen::Index first = std::max<Eigen::Index>(0, spell.first_frame - around),
                       end = std::min<Eigen::Index>(track.frames(), spell.last_frame + 1 + around);
    const Track2d before = some_frames(track, first, end - first);
    Track2d exchanged = before;
    exchange_sides(exchanged, {moved(spell, -static_cast<int>(first))});
    try {
      if (energy(exchanged) > energy(before) - kClearly) continue;
    } catch (const InputError&) {  // not enough of a body
      continue;
    }
    replace_frames(track, first, exchanged);
    swaps.push_back(spell);
  }
  return swaps;
}

}  // namespace mcdbn
