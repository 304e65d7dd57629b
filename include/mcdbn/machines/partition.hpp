#pragma once

#include <cstdint>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// Annealed importance sampling (Neal 2001; Salakhutdinov and Murray 2008).
struct AisSettings {
  std::size_t temperatures = 1000;
  std::size_t chains = 100;
  std::uint64_t seed = 1;

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"temperatures", within(1, 1e6), "temperatures",
                  "intermediate distributions, from the base distribution to the machine: with "
                  "more the chains' weights differ less"},
          self.temperatures);
    visit(Setting{"chains", within(2, 1e6), "chains",
                  "chains whose weights are averaged: the standard error falls with the square "
                  "root of their number"},
          self.chains);
    visit(Setting{"seed", any_seed(), "", "seed of all random numbers"}, self.seed);
  }
};

struct LogPartition {
  double value = 0;
  /// Standard error of `value`, from the spread of the chains' weights. Too small where there are
  /// few temperatures, which leave the weights uneven.
  double standard_error = 0;
};

/// log Z = log Σ_{v,h} exp(−E(v, h | H)) (an integral over Gaussian units), so that log p(v | H) =
/// −F(v | H) − log Z, v being over visible_deviation. The base distribution has no weights; its
/// visible biases are the machine's own where units are Gaussian, and those of visible_mean, within
/// 0.05 … 0.95, where they are binary. Temperatures lie evenly between.
/// @param history [order·visible], oldest frame first; empty for an RBM
/// @throws ShapeError, ConfigError for settings out of their range
LogPartition log_partition(const Crbm& crbm, const AisSettings& settings = {},
                           const RowVectorF& history = {});

}  // namespace mcdbn
