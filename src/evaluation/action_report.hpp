#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/report_clip.hpp"
#include "evaluation/summary_statistics.hpp"
#include "mcdbn/evaluation/distribution_fit.hpp"

namespace mcdbn {

/// Correlations of one kind, with their statistics and fits (smallest AIC first).
struct CorrelationReport {
  std::vector<double> values;
  SummaryStatistics statistics;
  std::vector<DistributionFit> fits;

  /// The Weibull among the fits. Null where there is none.
  const DistributionFit* weibull() const;
};

/// @param values NaN are counted as left out
CorrelationReport correlation_report(std::vector<double> values);

/// Mean scores of one way to regenerate.
struct MethodReport {
  std::string name;
  ClipScore mean;
};

/// Everything in a report about one action (docs/paper.md, "Tables and figures").
struct ActionReport {
  std::string name;
  int clips = 0, frames = 0, trained_clips = 0;
  std::size_t samples = 0;  ///< of each clip

  CorrelationReport flat, channel;  ///< truth against every regeneration: Tables 3 and 6
  CorrelationReport pairs_real;     ///< every two real clips: Fig. 10, 12
  CorrelationReport pairs_all;      ///< every two regenerations: Fig. 9, Table 4
  /// Random pairs of pairs_all, as many as there are real pairs: Fig. 10, 12, Tables 5, 7.
  CorrelationReport pairs_drawn;
  /// KL(real ‖ regenerated) of the fitted Weibulls (eq 53), where both could be fitted.
  std::optional<double> weibull_kl;

  MethodReport model;                  ///< mean over clips and samples
  std::vector<MethodReport> others;    ///< mean field (if sampled) and baselines
  std::optional<MethodReport> best;    ///< the sample nearest to the truth, of several
  std::optional<double> diversity_mm;  ///< mean distance between two samples, of several
};

using ReportProgress = std::function<void(const std::string& what, double fraction)>;

/// @param clips of one action: one at least, each with the same joints and number of samples
/// @param seed of the drawn pairs  @throws ShapeError
ActionReport analyse_action(const std::string& name, const std::vector<const ReportClip*>& clips,
                            std::uint64_t seed);

/// One report an action, in the order of first appearance.
std::vector<ActionReport> analyse_actions(const std::vector<ReportClip>& clips, std::uint64_t seed,
                                          const ReportProgress& progress = {});

}  // namespace mcdbn
