#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/evaluation_report.hpp"

namespace mcdbn {

/// A table as CSV files and the page show it.
struct ReportTable {
  std::string file;   ///< table_3.csv
  std::string title;  ///< what it is, for people
  std::vector<std::string> columns;
  std::vector<std::vector<nlohmann::json>> rows;  ///< text, numbers, null for what there is not
};

/// The paper's Tables 3 to 7 with corrected columns (the mode is the histogram's, the minimum has
/// its own column; the shape is the large parameter, the scale the one near 1), then scores of
/// every method, all fits, each clip, and 2D from 3D. The paper's Tables 3 and 6, and 5 and 7,
/// differ in the data set only; here both hold every action of the run. Every row gives how many
/// of its clips were trained on.
std::vector<ReportTable> report_tables(const EvaluationReport& report);

/// RFC 4180; numbers with six digits, an empty cell for null.
std::string csv_text(const ReportTable& table);

}  // namespace mcdbn
