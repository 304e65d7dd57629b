#include "fitting/standing_foot.hpp"

#include "fitting/rows_around.hpp"

namespace mcdbn {
namespace {

/// What fewer of the frames around say is not worth an equation, and drags feet that are on their
/// way: it is never nothing, as the weights have long tails.
constexpr double kHardlyStands = 0.05;

}  // namespace

std::vector<FootDepth> standing_depths(const std::vector<SeenFoot>& foot, double still,
                                       double around_frames) {
  const auto count = static_cast<Eigen::Index>(foot.size());
  std::vector<FootDepth> result(foot.size());
  for (Eigen::Index t = 0; t < count; ++t) {
    const auto around = RowsAround::without_itself(count, t, around_frames);
    double sum = 0, standing = 0, all = 0;
    auto other = foot.begin() + around.first;
    for (const double near : around.weights) {
      const double moved = (foot[t].ray - other->ray).norm() / still;
      const double weight = near * other->surely / (1 + moved * moved);
      sum += weight * other->depth;
      standing += weight;
      all += near;
      ++other;
    }
    const double surely = foot[t].surely * standing / all;
    if (surely > kHardlyStands) result[t] = {sum / standing, surely};
  }
  return result;
}

}  // namespace mcdbn
