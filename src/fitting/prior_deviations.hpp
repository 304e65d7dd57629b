#pragma once

#include "mcdbn/features/modalities.hpp"
#include "mcdbn/fitting/pose_prior.hpp"
#include "mcdbn/fitting/track_fit_settings.hpp"

namespace mcdbn {

/// How far a prior's orientations may be off about each axis, from the deviations of their six
/// numbers: two unit vectors that a turn of deviation s about every axis moves by 2 s² each, summed
/// over their coordinates. At least a tenth of a degree; the settings' deviation if the prior has
/// none.
/// @return [frames x orientations] radians
MatrixD turn_deviations_rad(const PosePrior& prior, const Modalities& features,
                            const TrackFitSettings& settings);

/// turn_deviations_rad() as the fit uses them: at least the settings' typical ones. A prior with
/// smaller deviations has larger errors than these on people that it was not trained on.
MatrixD fitted_turn_deviations_rad(const PosePrior& prior, const Modalities& features,
                                   const TrackFitSettings& settings);

/// Deviation of the error of the prior's root acceleration, RMS over the clip, within the time that
/// errors last. @return m/s² on a 1.7 m body
double root_acceleration_deviation_m_s2(const PosePrior& prior, const Modalities& features,
                                        const TrackFitSettings& settings);

/// root_acceleration_deviation_m_s2() as the fit uses it: at least the settings' typical one.
double fitted_root_acceleration_deviation_m_s2(const PosePrior& prior, const Modalities& features,
                                               const TrackFitSettings& settings);

}  // namespace mcdbn
