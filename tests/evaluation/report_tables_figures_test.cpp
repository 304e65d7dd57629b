// The CSV files and the page hold the figures of summary.json (report_figures_test.cpp has those by
// hand), each in its own column.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <sstream>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "by_hand.hpp"
#include "evaluation/report_page.hpp"
#include "numbered_report.hpp"

namespace mcdbn {
namespace {

using namespace test;
using nlohmann::json;
using Row = std::map<std::string, std::string>;

/// A CSV file without quotes as rows of column name → cell.
std::vector<Row> read_csv(const std::filesystem::path& file) {
  std::istringstream lines(read_text_file(file));
  std::vector<std::string> columns;
  std::vector<Row> rows;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells{""};
    for (const char c : line) {
      if (c == ',')
        cells.emplace_back();
      else
        cells.back() += c;
    }
    if (columns.empty()) {
      columns = cells;
      continue;
    }
    REQUIRE(cells.size() == columns.size());
    Row row;
    for (std::size_t i = 0; i < cells.size(); ++i) row[columns[i]] = cells[i];
    rows.push_back(row);
  }
  return rows;
}

void check_cell(const Row& row, const std::string& column, const json& wanted) {
  CAPTURE(column);
  REQUIRE(row.count(column) == 1);
  if (wanted.is_null())
    CHECK(row.at(column).empty());
  else
    CHECK(row.at(column) == fmt::format("{:.6g}", wanted.get<double>()));
}

void check_statistics(const Row& row, const json& statistics) {
  check_cell(row, "samples", statistics.at("count"));
  for (const char* name : {"mean", "standard_deviation", "mode", "median", "minimum", "maximum"})
    check_cell(row, name, statistics.at(name));
}

/// Shape and scale with their intervals.
void check_weibull(const Row& row, const std::string& prefix, const json& correlations) {
  for (const json& fit : correlations.at("fits"))
    if (fit.at("family") == "Weibull")
      for (const char* name : {"shape", "scale"}) {
        const json& parameter = fit.at("parameters").at(name);
        check_cell(row, prefix + name, parameter.at("value"));
        check_cell(row, prefix + name + "_low_95", parameter.at("low_95"));
        check_cell(row, prefix + name + "_high_95", parameter.at("high_95"));
      }
  if (correlations.at("fits").empty()) CHECK(row.at(prefix + "shape").empty());
}

void check_figures(const Row& row, const std::vector<double>& numbers) {
  for (const auto& [name, value] : numbered_figures(numbers))
    if (name != "foot_slide_of_truth_mm_s") check_cell(row, name, value);
}

std::string best_by(const json& fits, const char* criterion) {
  std::string best;
  double least = 1e300;
  for (const json& fit : fits)
    if (fit.at(criterion).get<double>() < least) {
      least = fit.at(criterion);
      best = fit.at("family");
    }
  return best;
}

/// The data inside of the page.
json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const auto start = page.find(open) + open.size();
  return json::parse(page.substr(start, page.find("</script>", start) - start));
}

struct Written {
  ScratchFolder folder;
  EvaluationReport report = numbered_report();
  json summary;
  Written() {
    write_report(folder / "report", report);
    summary = json::parse(read_text_file(folder / "report/summary.json"));
  }
  std::vector<Row> rows(const std::string& file) const {
    return read_csv(folder / ("report/" + file));
  }
};

}  // namespace

TEST_CASE("report tables: statistics and Weibull fits stand in their columns") {
  const Written written;
  CHECK(written.summary == json(summary_json(written.report)));
  for (const std::size_t a : {0U, 1U}) {
    const json& action = written.summary.at("actions").at(a);
    const std::string name = action.at("name");
    for (const char* file : {"table_3.csv", "table_6.csv"}) {
      const auto rows = written.rows(file);
      REQUIRE(rows.size() == 4);
      for (const std::size_t i : {0U, 1U}) {
        const Row& row = rows[2 * a + i];
        const char* measure = i == 0 ? "pcc_flat" : "pcc_channel";
        CHECK(row.at("action") == name);
        CHECK(row.at("measure") == measure);
        check_cell(row, "training_clips", action.at("training_clips"));
        check_statistics(row, action.at(measure));
      }
    }
    const Row pairs = written.rows("table_4.csv").at(a);
    const json& regenerated = action.at("pairwise_regenerated");
    CHECK(pairs.at("action") == name);
    check_cell(pairs, "pairs", regenerated.at("count"));
    check_weibull(pairs, "", regenerated);
    CHECK(pairs.at("best_by_aic") == best_by(regenerated.at("fits"), "aic"));
    CHECK(pairs.at("best_by_bic") == best_by(regenerated.at("fits"), "bic"));
    for (const char* file : {"table_5.csv", "table_7.csv"}) {
      const Row row = written.rows(file).at(a);
      CHECK(row.at("action") == name);
      check_cell(row, "training_clips", action.at("training_clips"));
      check_cell(row, "pairs", action.at("pairwise_real").at("count"));
      check_weibull(row, "real_", action.at("pairwise_real"));
      check_weibull(row, "regenerated_", action.at("pairwise_regenerated_drawn"));
      check_cell(row, "kl_nats", action.at("weibull_kl_nats"));
    }
  }
}

TEST_CASE("report tables: scores of methods and clips, and every fit") {
  const Written written;
  const auto methods = written.rows("methods.csv");
  REQUIRE(methods.size() == 10);
  const std::vector<std::pair<std::string, std::vector<double>>> walk = {
      {"model", sample_numbers(written.report, "walk")},
      {"best of 2", {12, 32, 42}},
      {"mean_field", {kMeanFieldNumber}},
      {"mean_pose", {kMeanPoseNumber}},
      {"ridge_window", {kRidgeNumber}}};
  for (std::size_t i = 0; i < walk.size(); ++i) {
    CHECK(methods[i].at("action") == "walk");
    CHECK(methods[i].at("method") == walk[i].first);
    check_figures(methods[i], walk[i].second);
    check_cell(methods[i], "diversity_mm",
               i == 0 ? written.summary.at("actions").at(0).at("diversity_mm") : json(nullptr));
  }
  CHECK(methods[6].at("method") == "best of 2");
  check_figures(methods[6], {22, 52});

  const auto clips = written.rows("clips.csv");
  REQUIRE(clips.size() == 25);
  for (std::size_t c = 0; c < 5; ++c) {
    const ReportClip& clip = written.report.clips[c];
    const double number = 10 * static_cast<double>(c + 1);
    const std::vector<std::pair<std::string, double>> answers = {{"sample 1", number + 3},
                                                                 {"sample 2", number + 2},
                                                                 {"mean_field", kMeanFieldNumber},
                                                                 {"mean_pose", kMeanPoseNumber},
                                                                 {"ridge_window", kRidgeNumber}};
    for (std::size_t i = 0; i < 5; ++i) {
      const Row& row = clips[5 * c + i];
      CHECK(row.at("clip") == clip.name);
      CHECK(row.at("action") == clip.action);
      CHECK(row.at("trained_on") == (c == 2 ? "yes" : "no"));
      CHECK(row.at("method") == answers[i].first);
      CHECK(row.at("frames") == std::to_string(clip.truth_mm.rows()));
      check_figures(row, {answers[i].second});
    }
  }

  const auto tracks = written.rows("tracks.csv");
  REQUIRE(tracks.size() == 5);
  for (std::size_t c = 0; c < 5; ++c) {
    CHECK(tracks[c].at("clip") == written.report.clips[c].name);
    CHECK(tracks[c].at("action") == written.report.clips[c].action);
    CHECK(tracks[c].at("trained_on") == (c == 2 ? "yes" : "no"));
    const json& error = written.summary.at("per_clip").at(c).at("track_from_pose");
    CHECK(error.at("track_error_px") == 12.5 * static_cast<double>(c + 1));
    CHECK(error.at("mean_track_error_px") == 41.0 + static_cast<double>(c));
    check_cell(tracks[c], "track_error_px", error.at("track_error_px"));
    check_cell(tracks[c], "mean_track_error_px", error.at("mean_track_error_px"));
  }
  CHECK(written.summary.at("track_from_pose") ==
        json{{"track_error_px", 37.5}, {"mean_track_error_px", 43.0}});

  std::size_t at = 0;
  const auto fits = written.rows("fits.csv");
  for (const json& action : written.summary.at("actions"))
    for (const auto& [label, field] : std::vector<std::pair<std::string, std::string>>{
             {"pcc_flat", "pcc_flat"},
             {"pcc_channel", "pcc_channel"},
             {"pairs_real", "pairwise_real"},
             {"pairs_regenerated", "pairwise_regenerated"},
             {"pairs_regenerated_drawn", "pairwise_regenerated_drawn"}})
      for (const json& fit : action.at(field).at("fits")) {
        REQUIRE(at < fits.size());
        const Row& row = fits[at++];
        CHECK(row.at("action") == action.at("name"));
        CHECK(row.at("values") == label);
        CHECK(row.at("family") == fit.at("family"));
        check_cell(row, "aic", fit.at("aic"));
        check_cell(row, "bic", fit.at("bic"));
      }
  CHECK(at == fits.size());
}

TEST_CASE("report page: the same tables, and figures counted by hand") {
  const Written written;
  const json data = data_of(read_text_file(written.folder / "report/report.html"));
  CHECK(data.at("summary") == written.summary);
  for (const json& table : data.at("tables")) {
    const auto rows = written.rows(table.at("file"));
    REQUIRE(rows.size() == table.at("rows").size());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t c = 0; c < table.at("columns").size(); ++c) {
        const json& cell = table.at("rows").at(r).at(c);
        const std::string& text = rows[r].at(table.at("columns").at(c));
        if (cell.is_string())
          CHECK(cell == text);
        else
          check_cell(rows[r], table.at("columns").at(c), cell);
      }
  }
  const ActionReport& walk = written.report.actions[0];
  const json& figures = data.at("figures");
  REQUIRE(figures.size() == 8);
  const std::vector<std::vector<const CorrelationReport*>> shown = {
      {&walk.flat}, {&walk.channel}, {&walk.pairs_all}, {&walk.pairs_real, &walk.pairs_drawn}};
  for (std::size_t f = 0; f < 4; ++f) {
    double low = 1e300, high = -1e300;
    std::size_t count = 0;
    for (const CorrelationReport* one : shown[f])
      for (const double value : one->values)
        low = std::min(low, value), high = std::max(high, value);
    for (const CorrelationReport* one : shown[f]) count = one->values.size();
    const int bins = std::clamp(static_cast<int>(2 * std::sqrt(count)), 8, 24);
    CHECK(figures.at(f).at("action") == "walk");
    CHECK(figures.at(f).at("low") == low);
    CHECK(figures.at(f).at("high") == high);
    REQUIRE(figures.at(f).at("series").size() == shown[f].size());
    for (std::size_t s = 0; s < shown[f].size(); ++s) {
      const json& series = figures.at(f).at("series").at(s);
      CHECK(series.at("counts") == json(counts_by_hand(shown[f][s]->values, low, high, bins)));
      CHECK(series.at("curves").size() == (f == 3 ? 1 : 5));
      for (std::size_t i = 0; i < series.at("curves").size(); ++i) {
        const DistributionFit& fit = f == 3 ? *shown[f][s]->weibull() : shown[f][s]->fits[i];
        const json& curve = series.at("curves").at(i);
        CHECK(curve.at("family") == family_name(fit.family));
        std::vector<double> parameters;
        for (const FittedParameter& parameter : fit.parameters)
          parameters.push_back(parameter.value);
        const double x = low + 0.5 * (high - low);
        const double wanted =
            std::exp(log_likelihood_by_hand(family_name(fit.family), parameters, {x})) *
            (high - low) / bins * static_cast<double>(shown[f][s]->values.size());
        CHECK(std::abs(curve.at("points").at(60).get<double>() - wanted) <= 6e-5);
      }
    }
  }
  CHECK(figures.at(3).at("series").at(0).at("label") == "real");
  CHECK(figures.at(3).at("series").at(1).at("label") == "regenerated");
}

}  // namespace mcdbn
