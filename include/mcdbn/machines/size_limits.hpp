#pragma once

#include "mcdbn/base/settings.hpp"

/// How large machines may be: for settings, and for sizes in a file before memory is allocated.
/// Products of three of them still fit into 64 bits.
namespace mcdbn::size_limits {

inline constexpr Range kUnits = within(1, 100'000);   ///< of a layer
inline constexpr Range kHistory = within(0, 1000);    ///< frames that a machine sees of the past
inline constexpr Range kLookAhead = within(0, 1000);  ///< frames
/// Machines of a stack: at most as many as have random numbers of their own (layers_of() in
/// base/random_streams.hpp).
inline constexpr Range kLayers = within(1, 64);
inline constexpr Range kMeanFieldSteps = within(1, 1000);
inline constexpr Range kGibbsSteps = within(0, 1000);

}  // namespace mcdbn::size_limits
