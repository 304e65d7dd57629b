#pragma once

#include "mcdbn/features/modalities.hpp"
#include "mcdbn/fitting/track_fit.hpp"

namespace mcdbn {

/// How far a prior's orientations may be off about each axis, from the deviations of their six
/// numbers: two unit vectors that a turn of deviation s about every axis moves by 2 s² each, summed
/// over their coordinates. At least a tenth of a degree; the settings' deviation if the prior has
/// none.
/// @return [frames x orientations] radians
MatrixD turn_deviations_rad(const PosePrior& prior, const Modalities& features,
                            const TrackFitSettings& settings);

/// The same as the fit takes them: no smaller than the settings' typical ones. A prior with smaller
/// deviations has larger errors than these on people that it was not trained on.
MatrixD fitted_turn_deviations_rad(const PosePrior& prior, const Modalities& features,
                                   const TrackFitSettings& settings);

/// How much the change of the prior's root velocity is off: its deviation, RMS over the clip,
/// within the time that errors last. @return m/s² on a 1.7 m body
double root_acceleration_deviation_m_s2(const PosePrior& prior, const Modalities& features,
                                        const TrackFitSettings& settings);

/// The same as the fit takes it, for the same reason: no smaller than the settings' typical one.
double fitted_root_acceleration_deviation_m_s2(const PosePrior& prior, const Modalities& features,
                                               const TrackFitSettings& settings);

}  // namespace mcdbn
