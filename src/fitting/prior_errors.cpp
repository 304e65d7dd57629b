#include "fitting/prior_errors.hpp"

#include <cmath>

namespace mcdbn {

PriorErrors::PriorErrors(const PosteriorClip& clip, const RayNoise& noise,
                         const TrackFitSettings& settings)
    : clip_(clip),
      likeness_(noise.steady ? settings.exact_likeness : settings.likeness),
      process_(noise.measured ? settings.measured_lasting_s : settings.lasting_s,
               clip.frame_time_s) {
  if (noise.exact) process_.point *= settings.exact;
}

double PriorErrors::share_of_parent(Eigen::Index frame, int turn) const {
  const int parent = parent_of(turn);
  return parent < 0 ? 0
                    : likeness_ * clip_.turn_deviation_rad(frame, turn) /
                          clip_.turn_deviation_rad(frame, parent);
}

double PriorErrors::own_deviation_rad(Eigen::Index frame, int turn) const {
  const double own = parent_of(turn) < 0 ? 1 : std::sqrt(1 - likeness_ * likeness_);
  return own * clip_.turn_deviation_rad(frame, turn);
}

}  // namespace mcdbn
