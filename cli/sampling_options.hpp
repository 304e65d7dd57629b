#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "mcdbn/machines/regeneration.hpp"

namespace mcdbn::cli {

/// How variations are drawn; what is not given is as the model was trained for.
struct SamplingOptions {
  std::optional<std::size_t> samples, gibbs_steps, mrbm_gibbs_steps;
  std::optional<double> temperature;

  /// The first option that asks for more than the mean-field answer; null if none does.
  const char* drawing_flag() const;
  /// @throws ConfigError for several samples of which none would be drawn
  RegenerationOptions regeneration(const Mcdbn& network, std::uint64_t seed) const;
};

void add_sampling_options(CLI::App& command, SamplingOptions& options, const char* samples_help);

}  // namespace mcdbn::cli
