#include "evaluation/report_tables.hpp"

#include <fmt/format.h>

#include <cmath>

namespace mcdbn {
namespace {

using nlohmann::json;
using Row = std::vector<json>;

json number(double value) {
  return std::isfinite(value) ? json(value) : json(nullptr);
}

void append(Row& row, const Row& more) {
  row.insert(row.end(), more.begin(), more.end());
}

Row statistics_cells(const ActionReport& action, const char* measure,
                     const SummaryStatistics& statistics) {
  return {action.name,
          action.trained_clips,
          measure,
          statistics.count,
          number(statistics.mean),
          number(statistics.standard_deviation),
          number(statistics.mode),
          number(statistics.median),
          number(statistics.minimum),
          number(statistics.maximum)};
}

ReportTable statistics_table(const EvaluationReport& report, int number) {
  ReportTable table{fmt::format("table_{}.csv", number),
                    fmt::format("Table {}: correlation of truth and regeneration", number),
                    {"action", "training_clips", "measure", "samples", "mean", "standard_deviation",
                     "mode", "median", "minimum", "maximum"},
                    {}};
  for (const ActionReport& action : report.actions) {
    table.rows.push_back(statistics_cells(action, "pcc_flat", action.flat.statistics));
    table.rows.push_back(statistics_cells(action, "pcc_channel", action.channel.statistics));
  }
  return table;
}

/// Shape and scale, each with its 95 % interval.
Row weibull_cells(const CorrelationReport& correlations) {
  const DistributionFit* fit = correlations.weibull();
  if (!fit) return Row(6, nullptr);
  Row cells;
  for (const FittedParameter& parameter : fit->parameters) {
    const Interval interval = confidence_95(parameter);
    append(cells, {number(parameter.value), number(interval.low), number(interval.high)});
  }
  return cells;
}

std::string best_family(const std::vector<DistributionFit>& fits,
                        double (DistributionFit::*of)() const) {
  const DistributionFit* best = nullptr;
  for (const DistributionFit& fit : fits)
    if (!best || (fit.*of)() < (best->*of)()) best = &fit;
  return best ? family_name(best->family) : "";
}

ReportTable regenerated_pairs_table(const EvaluationReport& report) {
  ReportTable table{"table_4.csv",
                    "Table 4: Weibull fits to all pairs of regenerated clips",
                    {"action", "training_clips", "pairs", "shape", "shape_low_95", "shape_high_95",
                     "scale", "scale_low_95", "scale_high_95", "best_by_aic", "best_by_bic"},
                    {}};
  for (const ActionReport& action : report.actions) {
    Row row{action.name, action.trained_clips, action.pairs_all.statistics.count};
    append(row, weibull_cells(action.pairs_all));
    append(row, {best_family(action.pairs_all.fits, &DistributionFit::aic),
                 best_family(action.pairs_all.fits, &DistributionFit::bic)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable real_and_regenerated_table(const EvaluationReport& report, int table_number) {
  ReportTable table{
      fmt::format("table_{}.csv", table_number),
      fmt::format("Table {}: Weibull fits to pairs of real and of regenerated clips", table_number),
      {"action", "training_clips", "pairs", "real_shape", "real_shape_low_95", "real_shape_high_95",
       "real_scale", "real_scale_low_95", "real_scale_high_95", "regenerated_shape",
       "regenerated_shape_low_95", "regenerated_shape_high_95", "regenerated_scale",
       "regenerated_scale_low_95", "regenerated_scale_high_95", "kl_nats"},
      {}};
  for (const ActionReport& action : report.actions) {
    Row row{action.name, action.trained_clips, action.pairs_real.statistics.count};
    append(row, weibull_cells(action.pairs_real));
    append(row, weibull_cells(action.pairs_drawn));
    row.push_back(action.weibull_kl ? number(*action.weibull_kl) : json(nullptr));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Row score_cells(const ClipScore& score) {
  Row cells;
  for (const ScoreFigure& figure : score_figures()) cells.push_back(number(figure.of(score)));
  return cells;
}

void append_figure_names(ReportTable& table) {
  for (const ScoreFigure& figure : score_figures()) table.columns.emplace_back(figure.name);
}

ReportTable methods_table(const EvaluationReport& report) {
  ReportTable table{"methods.csv",
                    "The model and the simpler methods, by action",
                    {"action", "training_clips", "method"},
                    {}};
  append_figure_names(table);
  table.columns.emplace_back("diversity_mm");
  const auto add = [&](const ActionReport& action, const MethodReport& method) {
    Row row{action.name, action.trained_clips, method.name};
    append(row, score_cells(method.mean));
    const bool sampled = &method == &action.model && action.diversity_mm;
    row.push_back(sampled ? number(*action.diversity_mm) : json(nullptr));
    table.rows.push_back(std::move(row));
  };
  for (const ActionReport& action : report.actions) {
    add(action, action.model);
    if (action.best) add(action, *action.best);
    for (const MethodReport& other : action.others) add(action, other);
  }
  return table;
}

ReportTable fits_table(const EvaluationReport& report) {
  ReportTable table{
      "fits.csv",
      "Every fitted distribution",
      {"action", "training_clips", "values", "family", "aic", "bic", "parameter_1",
       "standard_error_1", "parameter_2", "standard_error_2", "parameter_3", "standard_error_3"},
      {}};
  const auto add = [&](const ActionReport& action, const char* values,
                       const CorrelationReport& correlations) {
    for (const DistributionFit& fit : correlations.fits) {
      Row row{action.name,       action.trained_clips, values, family_name(fit.family),
              number(fit.aic()), number(fit.bic())};
      for (const FittedParameter& parameter : fit.parameters)
        append(row, {number(parameter.value), number(parameter.standard_error)});
      row.resize(table.columns.size(), nullptr);
      table.rows.push_back(std::move(row));
    }
  };
  for (const ActionReport& action : report.actions) {
    add(action, "pcc_flat", action.flat);
    add(action, "pcc_channel", action.channel);
    add(action, "pairs_real", action.pairs_real);
    add(action, "pairs_regenerated", action.pairs_all);
    add(action, "pairs_regenerated_drawn", action.pairs_drawn);
  }
  return table;
}

ReportTable clips_table(const EvaluationReport& report) {
  ReportTable table{
      "clips.csv", "Every clip", {"clip", "action", "trained_on", "method", "frames"}, {}};
  append_figure_names(table);
  const auto add = [&](const ReportClip& clip, const std::string& method, const ClipScore& score) {
    Row row{clip.name, clip.action, clip.trained_on ? "yes" : "no", method, clip.frames()};
    append(row, score_cells(score));
    table.rows.push_back(std::move(row));
  };
  for (const ReportClip& clip : report.clips) {
    for (std::size_t i = 0; i < clip.samples.size(); ++i)
      add(clip, clip.samples.size() == 1 ? "model" : fmt::format("sample {}", i + 1),
          clip.samples[i].score);
    for (const auto& [name, motion] : clip.others) add(clip, name, motion.score);
  }
  return table;
}

ReportTable tracks_table(const EvaluationReport& report) {
  ReportTable table{"tracks.csv",
                    "2D from 3D: every clip's regenerated track",
                    {"clip", "action", "trained_on", "track_error_px", "mean_track_error_px"},
                    {}};
  for (const ReportClip& clip : report.clips)
    table.rows.push_back({clip.name, clip.action, clip.trained_on ? "yes" : "no",
                          number(clip.track.track_error_px),
                          number(clip.track.mean_track_error_px)});
  return table;
}

std::string csv_cell(const json& value) {
  if (value.is_null()) return "";
  if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
  if (!value.is_string()) return value.dump();
  auto text = value.get<std::string>();
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  quoted += '"';
  return quoted;
}

}  // namespace

std::vector<ReportTable> report_tables(const EvaluationReport& report) {
  return {statistics_table(report, 3),
          regenerated_pairs_table(report),
          real_and_regenerated_table(report, 5),
          statistics_table(report, 6),
          real_and_regenerated_table(report, 7),
          methods_table(report),
          fits_table(report),
          clips_table(report),
          tracks_table(report)};
}

std::string csv_text(const ReportTable& table) {
  std::string text;
  const auto add_line = [&text](const auto& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (i > 0) text += ',';
      text += csv_cell(json(cells[i]));
    }
    text += '\n';
  };
  add_line(table.columns);
  for (const auto& row : table.rows) add_line(row);
  return text;
}

}  // namespace mcdbn
