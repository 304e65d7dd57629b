#include "fitting/prior_errors.hpp"

#include <cmath>

namespace mcdbn {

SlowProcess prior_errors(const PosteriorClip& clip, const RayNoise& noise,
                         const TrackFitSettings& settings) {
  SlowProcess process(settings.lasting_s, clip.frame_time_s);
  if (noise.exact) process.point *= settings.exact;
  return process;
}

double share_of_parent(const PosteriorClip& clip, const TrackFitSettings& settings,
                       Eigen::Index frame, int turn) {
  const int parent = clip.parents[static_cast<std::size_t>(turn)];
  return parent < 0 ? 0
                    : settings.likeness * clip.turn_deviation_rad(frame, turn) /
                          clip.turn_deviation_rad(frame, parent);
}

double own_deviation_rad(const PosteriorClip& clip, const TrackFitSettings& settings,
                         Eigen::Index frame, int turn) {
  const bool alone = clip.parents[static_cast<std::size_t>(turn)] < 0;
  const double own = alone ? 1 : std::sqrt(1 - settings.likeness * settings.likeness);
  return own * clip.turn_deviation_rad(frame, turn);
}

}  // namespace mcdbn
