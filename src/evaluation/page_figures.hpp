#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/evaluation_report.hpp"

namespace mcdbn {

/// What the page draws of each action: histograms over shared bins with the points of the curves
/// fitted to them (Fig. 8 and 11, 9, 10 and 12).
nlohmann::ordered_json page_figures(const EvaluationReport& report);

}  // namespace mcdbn
