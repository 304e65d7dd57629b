#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "mcdbn/fitting/track_fit.hpp"

namespace mcdbn::cli {

/// Motions drawn to estimate an answer's uncertainty: so many give a deviation to within a tenth.
inline constexpr std::size_t kUncertaintyDraws = 50;

inline constexpr const char *kFitTrack = "track", *kFitNone = "none";

/// --fit track|none. @param note at the end of the help
void add_fit_option(CLI::App& command, std::string& fit, const std::string& note);
std::optional<TrackFitSettings> track_fit(const std::string& fit);

}  // namespace mcdbn::cli
