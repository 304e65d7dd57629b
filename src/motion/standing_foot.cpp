#include "standing_foot.hpp"

#include <algorithm>
#include <cmath>

namespace mcdbn {
namespace {

/// What fewer of the frames around say is not worth an equation, and drags feet that are on their
/// way: it is never nothing, as the weights have long tails.
constexpr double kHardlyStands = 0.05;

}  // namespace

std::vector<FootDepth> standing_depths(const std::vector<SeenFoot>& foot, double still,
                                       double around_frames) {
  const auto count = static_cast<std::ptrdiff_t>(foot.size());
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(3 * around_frames));
  std::vector<FootDepth> result(foot.size());
  for (std::ptrdiff_t t = 0; t < count; ++t) {
    double sum = 0, standing = 0, all = 0;
    const std::ptrdiff_t last = std::min(count - 1, t + reach);
    for (std::ptrdiff_t k = std::max<std::ptrdiff_t>(0, t - reach); k <= last; ++k) {
      if (k == t) continue;
      const double away = static_cast<double>(k - t) / around_frames;
      const double near = std::exp(-0.5 * away * away);
      all += near;
      if (!(foot[k].surely > 0)) continue;
      const double moved = (foot[t].ray - foot[k].ray).norm() / still;
      const double weight = near * foot[k].surely / (1 + moved * moved);
      sum += weight * foot[k].depth;
      standing += weight;
    }
    const double surely = foot[t].surely * standing / all;
    if (surely > kHardlyStands) result[t] = {sum / standing, surely};
  }
  return result;
}

}  // namespace mcdbn
