#include "fitting/prior_draws.hpp"

#include <cmath>

#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"

namespace mcdbn {

std::vector<PosteriorPoint> prior_draws(const PosteriorClip& clip, const TrackFitSettings& settings,
                                        std::size_t count, std::uint64_t seed) {
  const double own = std::sqrt(1 - settings.parent_correlation * settings.parent_correlation);
  std::vector<PosteriorPoint> draws;
  for (std::size_t draw = 0; draw < count; ++draw) {
    RandomSequence random(mixed_seed({seed, draw}), random_streams::kPosteriorDraws);
    PosteriorPoint point = PosteriorPoint::zero(clip);
    Eigen::Matrix3Xd turns(3, std::ssize(clip.parents));  // in deviations
    for (Eigen::Index k = 0; k < turns.cols(); ++k) {
      for (double& axis : turns.col(k)) axis = random.normal();
      const int parent = clip.parents[static_cast<std::size_t>(k)];
      if (parent >= 0)
        turns.col(k) = own * turns.col(k) + settings.parent_correlation * turns.col(parent);
      point.turns.middleCols<3>(3 * k) = clip.turn_deviation_rad.col(k) * turns.col(k).transpose();
    }
    if (clip.body_unknown)
      for (double& length : point.log_lengths)
        length = settings.people_log_deviation * random.normal();
    draws.push_back(std::move(point));
  }
  return draws;
}

}  // namespace mcdbn
