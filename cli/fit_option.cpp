#include "fit_option.hpp"

#include <fmt/format.h>

namespace mcdbn::cli {

void add_fit_option(CLI::App& command, std::string& fit, const std::string& note) {
  command
      .add_option("--fit", fit,
                  fmt::format("track: fit the answer to the 2D track; none: leave the answer "
                              "unchanged ({})",
                              note))
      ->check(CLI::IsMember({kFitTrack, kFitNone}));
}

std::optional<TrackFitSettings> track_fit(const std::string& fit) {
  return fit == kFitNone ? std::nullopt : std::optional(TrackFitSettings{});
}

}  // namespace mcdbn::cli
