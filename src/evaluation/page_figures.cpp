#include "evaluation/page_figures.hpp"

#include <algorithm>
#include <cmath>

namespace mcdbn {
namespace {

using nlohmann::ordered_json;

constexpr int kCurvePoints = 121;

struct Series {
  const char* label;
  const CorrelationReport* correlations;
  bool all_fits;  ///< else the Weibull alone, as the paper draws it
};

struct Range {
  double low = 1, high = -1;
  int bins = 24;

  double bin_width() const { return (high - low) / bins; }
};

/// Few values get few bins, so that bars do not stand alone.
int bins_for(int count) {
  return std::clamp(static_cast<int>(2 * std::sqrt(count)), 8, 24);
}

Range range_of(const std::vector<Series>& all) {
  Range range;
  for (const Series& series : all) {
    const SummaryStatistics& statistics = series.correlations->statistics;
    if (statistics.count == 0) continue;
    range.bins = bins_for(statistics.count);
    const bool first = range.low > range.high;
    range.low = first ? statistics.minimum : std::min(range.low, statistics.minimum);
    range.high = first ? statistics.maximum : std::max(range.high, statistics.maximum);
  }
  if (range.high - range.low < 1e-4) range.low -= 5e-5, range.high += 5e-5;
  return range;
}

/// Expected counts in a bin around each x, so that curve and bars share an axis.
ordered_json curve_json(const DistributionFit& fit, const Range& range, int count) {
  ordered_json points = ordered_json::array();
  for (int i = 0; i < kCurvePoints; ++i) {
    const double x = range.low + (range.high - range.low) * i / (kCurvePoints - 1);
    const double y = fit.density(x) * range.bin_width() * count;
    points.push_back(std::isfinite(y) ? ordered_json(std::round(y * 1e4) / 1e4)
                                      : ordered_json(nullptr));
  }
  return {{"family", family_name(fit.family)}, {"aic", fit.aic()}, {"points", std::move(points)}};
}

ordered_json series_json(const Series& series, const Range& range) {
  const CorrelationReport& correlations = *series.correlations;
  const int count = correlations.statistics.count;
  ordered_json json = {
      {"label", series.label},
      {"count", count},
      {"counts", histogram_of(correlations.values, range.low, range.high, range.bins).counts},
      {"curves", ordered_json::array()}};
  for (const DistributionFit& fit : correlations.fits)
    if (series.all_fits || fit.family == DistributionFamily::weibull)
      json["curves"].push_back(curve_json(fit, range, count));
  return json;
}

ordered_json figure_json(const ActionReport& action, const char* paper, const char* title,
                         const std::vector<Series>& all) {
  const Range range = range_of(all);
  ordered_json json = {{"action", action.name},
                       {"paper", paper},
                       {"title", title},
                       {"low", range.low},
                       {"high", range.high}};
  json["series"] = ordered_json::array();
  for (const Series& series : all)
    if (series.correlations->statistics.count > 0)
      json["series"].push_back(series_json(series, range));
  return json;
}

}  // namespace

ordered_json page_figures(const EvaluationReport& report) {
  ordered_json figures = ordered_json::array();
  for (const ActionReport& action : report.actions) {
    figures.push_back(figure_json(action, "Fig. 8, 11", "Truth against regeneration, flattened PCC",
                                  {{"regenerations", &action.flat, true}}));
    figures.push_back(figure_json(action, "the strict figure",
                                  "Truth against regeneration, mean PCC per channel",
                                  {{"regenerations", &action.channel, true}}));
    figures.push_back(figure_json(action, "Fig. 9", "Every two regenerations of the action",
                                  {{"pairs of regenerations", &action.pairs_all, true}}));
    figures.push_back(figure_json(
        action, "Fig. 10, 12",
        "Every two real clips, and as many pairs "
        "of regenerations",
        {{"real", &action.pairs_real, false}, {"regenerated", &action.pairs_drawn, false}}));
  }
  return figures;
}

}  // namespace mcdbn
