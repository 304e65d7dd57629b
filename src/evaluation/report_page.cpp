#include "evaluation/report_page.hpp"

#include <fmt/format.h>

#include "base/text_file.hpp"
#include "evaluation/method_names.hpp"
#include "evaluation/page_figures.hpp"
#include "evaluation/page_files.hpp"
#include "evaluation/page_motion.hpp"
#include "evaluation/report_tables.hpp"

namespace mcdbn {
namespace {

using nlohmann::ordered_json;

/// Names of files may hold any bytes; what is not UTF-8 is replaced.
std::string text_of(const ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

/// JSON that may stand inside of a script element.
std::string embeddable(const ordered_json& json) {
  std::string text = text_of(json, -1);
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;)
    text.replace(at, 1, "\\u003c");
  return text;
}

/// What the viewer does not show, in words; empty if it shows everything.
std::string omission(const EvaluationReport& report, const PageMotion& motion) {
  if (motion.clips.empty() && motion.left_out_clips > 0)
    return "To keep this page small there is no viewer: the clips are too long for it. The figures "
           "count everything.";
  std::string text;
  const std::size_t samples = report.clips.empty() ? 0 : report.clips.front().samples.size();
  if (motion.samples < samples)
    text += fmt::format("{} of {} samples of each clip; ", motion.samples, samples);
  if (!motion.others) text += "no simpler methods; ";
  if (motion.frame_step > 1) text += fmt::format("one frame in {}; ", motion.frame_step);
  if (motion.left_out_clips > 0)
    text += fmt::format("{} of {} clips; ", report.clips.size() - motion.left_out_clips,
                        report.clips.size());
  return text.empty() ? text
                      : "To keep this page small the viewer shows " +
                            text.substr(0, text.size() - 2) + ". The figures count everything.";
}

/// Six digits, as in the CSV files.
nlohmann::json rounded(const nlohmann::json& cell) {
  if (!cell.is_number_float()) return cell;
  return nlohmann::json::parse(fmt::format("{:.6g}", cell.get<double>()));
}

ordered_json tables_json(const EvaluationReport& report) {
  std::vector<ReportTable> all = report_tables(report);
  ordered_json tables = ordered_json::array();
  for (ReportTable& table : all) {
    for (auto& row : table.rows)
      for (nlohmann::json& cell : row) cell = rounded(cell);
    tables.push_back({{"file", table.file},
                      {"title", table.title},
                      {"columns", table.columns},
                      {"rows", table.rows}});
  }
  return tables;
}

ordered_json figures_of_scores() {
  ordered_json list = ordered_json::array();
  for (const ScoreFigure& figure : score_figures())
    list.push_back({{"name", figure.name},
                    {"title", figure.title},
                    {"smaller_is_better", figure.smaller_is_better}});
  return list;
}

/// What the page calls each method, by the summary's name for it.
ordered_json methods_json(const EvaluationReport& report) {
  ordered_json methods = ordered_json::object();
  for (const MethodReport& method : overall_methods(report)) {
    const MethodName name = method_name(method.name);
    methods[method.name == kMeanField ? "model_mean_field" : method.name] = {
        {"title", name.title}, {"sentence", name.sentence}};
  }
  return methods;
}

ordered_json page_data(const EvaluationReport& report) {
  PageMotion motion = page_motion(report.clips, kPageBudget_bytes);
  return {{"summary", summary_json(report)}, {"scores", figures_of_scores()},
          {"methods", methods_json(report)}, {"figures", page_figures(report)},
          {"tables", tables_json(report)},   {"omission", omission(report, motion)},
          {"clips", std::move(motion.clips)}};
}

/// `text` with every {{file}} replaced by that file, and {{data}} by the data.
std::string filled(const std::string& text, const std::string& data) {
  std::string page;
  std::size_t start = 0;
  for (std::size_t open; (open = text.find("{{", start)) != std::string::npos;) {
    const std::size_t close = text.find("}}", open);
    const std::string name = text.substr(open + 2, close - open - 2);
    page += text.substr(start, open - start);
    page += name == "data" ? data : page_files().at(name);
    start = close + 2;
  }
  return page + text.substr(start);
}

}  // namespace

std::string report_page(const EvaluationReport& report) {
  return filled(page_files().at("page.html"), embeddable(page_data(report)));
}

void write_report(const std::filesystem::path& folder, const EvaluationReport& report) {
  make_folder(folder);
  write_text_file(folder / "summary.json", text_of(summary_json(report), 2) + "\n");
  for (const ReportTable& table : report_tables(report))
    write_text_file(folder / table.file, csv_text(table));
  write_text_file(folder / "report.html", report_page(report));
}

}  // namespace mcdbn
