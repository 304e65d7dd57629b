#pragma once

#include <filesystem>
#include <string>

#include "evaluation/evaluation_report.hpp"

namespace mcdbn {

/// One self-contained HTML page: verdicts, figures with their fitted curves, tables, and a viewer
/// of truth and regeneration. Motion is rounded to millimetres; where it would not fit into
/// kPageBudget_bytes, samples, then frames, then clips are left out, which the page reports;
/// without any clip there is no viewer.
std::string report_page(const EvaluationReport& report);

inline constexpr std::size_t kPageBudget_bytes = 4'500'000;  ///< of motion

/// summary.json, a CSV file for each of report_tables, and report.html. The folder is made.
/// @throws InputError if it cannot be written
void write_report(const std::filesystem::path& folder, const EvaluationReport& report);

}  // namespace mcdbn
