#include <doctest/doctest.h>

#include <algorithm>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "evaluation/report_page.hpp"
#include "evaluation/report_tables.hpp"
#include "evaluation/sample_spread.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/evaluation/pearson.hpp"
#include "report_data.hpp"

namespace mcdbn {
namespace {

using nlohmann::ordered_json;

EvaluationReport report_of(std::vector<ReportClip> clips) {
  EvaluationReport report;
  report.model = "model.safetensors";
  report.protocol = "subject";
  report.clips = std::move(clips);
  report.actions = analyse_actions(report.clips, 7);
  return report;
}

EvaluationReport small_report() {
  return report_of({test::report_clip("a", "walk", 1), test::report_clip("b", "walk", 20, 15),
                    test::report_clip("c", "walk", 40, 30), test::report_clip("d", "jump", 60)});
}

bool has_verdict(const std::vector<Verdict>& list, Verdict::Kind kind, const std::string& words) {
  return std::any_of(list.begin(), list.end(), [&](const Verdict& verdict) {
    return verdict.kind == kind && verdict.text.find(words) != std::string::npos;
  });
}

const ReportTable& table_of(const std::vector<ReportTable>& tables, const std::string& file) {
  const auto found = std::find_if(tables.begin(), tables.end(),
                                  [&](const ReportTable& table) { return table.file == file; });
  REQUIRE(found != tables.end());
  return *found;
}

nlohmann::json cell(const ReportTable& table, std::size_t row, const std::string& column) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), column);
  REQUIRE(found != table.columns.end());
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

}  // namespace

TEST_CASE("analyse_action counts what the paper counts") {
  const EvaluationReport report = small_report();
  REQUIRE(report.actions.size() == 2);
  const ActionReport& walk = report.actions[0];
  CHECK(walk.name == "walk");
  CHECK(walk.clips == 3);
  CHECK(walk.frames == 65);
  CHECK(walk.flat.statistics.count == 9);
  CHECK(walk.flat.statistics.mean == doctest::Approx(0.98));
  CHECK(walk.channel.statistics.minimum == doctest::Approx(0.7));
  CHECK(walk.pairs_real.values.size() == 3);
  CHECK(walk.pairs_all.values.size() == 36);
  CHECK(walk.pairs_drawn.values.size() == 3);
  for (const double value : walk.pairs_drawn.values)
    CHECK(std::count(walk.pairs_all.values.begin(), walk.pairs_all.values.end(), value) == 1);
  // Root-relative, joints only, over the shorter clip.
  const ReportClip &a = report.clips[0], &b = report.clips[1];
  const MatrixD real_a = judged_positions(a, a.truth_mm), real_b = judged_positions(b, b.truth_mm);
  REQUIRE(real_a.cols() == 6);
  CHECK(real_a(4, 2) == a.truth_mm(4, 5) - a.truth_mm(4, 2));
  CHECK(walk.pairs_real.values[0] == doctest::Approx(pearson_flat(real_a.topRows(15), real_b)));
}

TEST_CASE("analyse_action: methods, best of the samples, diversity") {
  const EvaluationReport report = small_report();
  const ActionReport& jump = report.actions[1];
  CHECK(jump.model.mean.error.mpjpe_mm == doctest::Approx(21));
  REQUIRE(jump.best);
  CHECK(jump.best->mean.error.mpjpe_mm == doctest::Approx(20));
  std::vector<MatrixD> joints;
  for (const ReportMotion& sample : report.clips[3].samples)
    joints.push_back(sample.points_mm.leftCols(9));
  REQUIRE(jump.diversity_mm);
  CHECK(*jump.diversity_mm == doctest::Approx(diversity_mm(joints)));
  // A single clip has no pair of real ones.
  CHECK(jump.pairs_real.statistics.count == 0);
  CHECK(!jump.weibull_kl);

  const ReportClip single = test::report_clip("a", "walk", 1, 20, 1);
  const ActionReport one = analyse_action("walk", {&single}, 1);
  CHECK(!one.best);
  CHECK(!one.diversity_mm);
  const ReportClip three = test::report_clip("a", "walk", 1, 20, 3);
  CHECK_THROWS_AS(analyse_action("walk", {&single, &three}, 1), ShapeError);
  CHECK_THROWS_AS(analyse_action("walk", {}, 1), ShapeError);
}

TEST_CASE("mean_score leaves out what is not finite, figure by figure") {
  ClipScore a = test::score_of(10, 0.9, 0.5), b = test::score_of(30, 0.7, 0.1);
  a.foot_slide.regenerated_mm_s = NAN;
  b.foot_slide.regenerated_mm_s = 12;
  const ClipScore mean = mean_score({a, b});
  CHECK(mean.error.mpjpe_mm == doctest::Approx(20));
  CHECK(mean.foot_slide.regenerated_mm_s == doctest::Approx(12));
  CHECK(std::isnan(mean_score({}).pcc_flat));
}

TEST_CASE("a report names what was done to the tracks and to the answers") {
  EvaluationReport report = small_report();
  CHECK(summary_json(report).at("fit") == "none");
  report.fit = "track";
  report.damage = {5, 0.2, 1};
  CHECK(has_verdict(verdicts(report), Verdict::Kind::note, "the simpler ones' too, was fitted"));
  CHECK(has_verdict(verdicts(report), Verdict::Kind::note,
                    "5 px of noise, 20 % of the joints missing, an arm hidden for 1 s"));
  CHECK(has_verdict(verdicts(report), Verdict::Kind::note,
                    "By the flattened PCC, the mean pose, fitted to the track,"));
  const ordered_json summary = summary_json(report);
  CHECK(summary.at("fit") == "track");
  CHECK(summary.at("track_damage") ==
        ordered_json{{"noise_px", 5.0}, {"missing_share", 0.2}, {"hidden_s", 1.0}});
}

TEST_CASE("a report names the tracks' source, and whether the camera was known") {
  using Kind = Verdict::Kind;
  EvaluationReport report = small_report();
  CHECK(summary_json(report).at("tracks") == "exact");
  CHECK(summary_json(report).at("camera_known") == true);
  CHECK(!has_verdict(verdicts(report), Kind::note, "as a detector's"));
  report.tracks = "mediapipe";
  CHECK(summary_json(report).at("tracks") == "mediapipe");
  CHECK(has_verdict(
      verdicts(report), Kind::note,
      "as a detector's (mediapipe), of other people than the clips' and through cameras "
      "drawn around them; every method saw the same, and knew the camera."));
  report.camera_known = false;
  CHECK(summary_json(report).at("camera_known") == false);
  CHECK(has_verdict(verdicts(report), Kind::note, "every method saw the same, no camera known."));
}

TEST_CASE("verdicts put in words which method wins") {
  using Kind = Verdict::Kind;
  EvaluationReport report = small_report();
  CHECK(has_verdict(verdicts(report), Kind::good, "beats ridge regression"));
  CHECK(has_verdict(verdicts(report), Kind::note,
                    "By the flattened PCC, a pose that never moves reaches 0.9500"));
  CHECK(!has_verdict(verdicts(report), Kind::bad, "trained on"));
  CHECK(!has_verdict(verdicts(report), Kind::note, "fitted to the 2D track"));
  CHECK(!has_verdict(verdicts(report), Kind::note, "damaged"));
  CHECK(!has_verdict(verdicts(report), Kind::note, "show a person"));
  report.clips[0].known_person = "08";
  CHECK(has_verdict(verdicts(report), Kind::note, "1 of 4 clips show a person"));

  for (ReportClip& clip : report.clips)
    clip.others["ridge_window"].score = test::score_of(5, 0.999, 0.9);
  report.clips[2].trained_on = true;
  report.clips[3].others["mean_pose"].score.pcc_flat = 1.2;  // mean 1.0125
  report = report_of(report.clips);
  CHECK(has_verdict(verdicts(report), Kind::bad, "loses to ridge regression"));
  CHECK(has_verdict(verdicts(report), Kind::bad, "nearer on 0 of 4 clips"));
  CHECK(has_verdict(verdicts(report), Kind::bad, "On jump, ridge regression is nearer"));
  CHECK(has_verdict(verdicts(report), Kind::bad, "1 of 4 clips were trained on"));
  CHECK(has_verdict(verdicts(report), Kind::bad, "a pose that never moves (1.0125) is as good"));
}

TEST_CASE("summary: the agreed fields, the single answer apart, null for NaN") {
  EvaluationReport report = small_report();
  for (ReportClip& clip : report.clips)
    clip.others[kMeanField] = {clip.truth_mm, test::score_of(15, 0.99, 0.85)};
  report.clips[0].samples[0].score.pcc_channel = NAN;
  report = report_of(report.clips);
  const ordered_json summary = summary_json(report);
  CHECK(summary.at("clips") == 4);
  CHECK(summary.at("frames") == 85);
  CHECK(summary.at("model").at("mpjpe_mm").get<double>() == doctest::Approx(21));
  CHECK(summary.at("model_mean_field").at("mpjpe_mm").get<double>() == doctest::Approx(15));
  CHECK(summary.at("baselines").size() == 2);
  CHECK(summary.at("baselines").at("ridge_window").at("pcc_channel").get<double>() ==
        doctest::Approx(0.6));
  CHECK(summary.at("actions").at(0).at("pcc_channel").at("left_out") == 1);
  CHECK(summary.at("actions").at(1).at("weibull_kl_nats").is_null());
  CHECK(ordered_json::parse(summary.dump()) == summary);
}

TEST_CASE("a root error that no clip has is null, and an empty cell") {
  EvaluationReport report = small_report();
  for (ReportClip& clip : report.clips) {
    for (ReportMotion& sample : clip.samples) sample.score.root_mm = NAN;
    for (auto& [name, other] : clip.others) other.score.root_mm = NAN;
  }
  report = report_of(report.clips);
  const ordered_json summary = summary_json(report);
  CHECK(summary.at("model").at("root_mm").is_null());
  CHECK(summary.at("baselines").at("ridge_window").at("root_mm").is_null());
  for (const char* file : {"methods.csv", "clips.csv"})
    CHECK(cell(table_of(report_tables(report), file), 0, "root_mm").is_null());
}

TEST_CASE("tables: corrected columns, one row an action, training clips marked") {
  EvaluationReport report = small_report();
  report.clips[1].trained_on = true;
  report = report_of(report.clips);
  const auto tables = report_tables(report);
  const ReportTable& statistics = table_of(tables, "table_3.csv");
  REQUIRE(statistics.rows.size() == 4);
  const SummaryStatistics& flat = report.actions[0].flat.statistics;
  CHECK(cell(statistics, 0, "mode") == flat.mode);
  CHECK(cell(statistics, 0, "minimum") == flat.minimum);
  CHECK(cell(statistics, 0, "training_clips") == 1);
  CHECK(cell(statistics, 2, "training_clips") == 0);

  const ReportTable& pairs = table_of(tables, "table_4.csv");
  const DistributionFit* weibull = report.actions[0].pairs_all.weibull();
  REQUIRE(weibull);
  CHECK(cell(pairs, 0, "shape") == weibull->parameters[0].value);
  CHECK(cell(pairs, 0, "scale") == weibull->parameters[1].value);
  CHECK(cell(pairs, 0, "shape_low_95") < cell(pairs, 0, "shape"));
  CHECK(cell(pairs, 0, "shape_high_95") > cell(pairs, 0, "shape"));
  CHECK(cell(table_of(tables, "table_5.csv"), 1, "kl_nats").is_null());
  CHECK(table_of(tables, "table_6.csv").columns == statistics.columns);
  CHECK(table_of(tables, "table_7.csv").rows.size() == 2);
  CHECK(cell(table_of(tables, "methods.csv"), 0, "diversity_mm") ==
        *report.actions[0].diversity_mm);
  CHECK(cell(table_of(tables, "methods.csv"), 1, "diversity_mm").is_null());
  CHECK(cell(table_of(tables, "clips.csv"), 5, "trained_on") == "yes");
  for (const ReportTable& table : tables)
    for (const auto& row : table.rows) CHECK(row.size() == table.columns.size());
}

TEST_CASE("csv_text quotes what needs it") {
  const ReportTable table{
      "x.csv", "", {"name", "value"}, {{"a,\"b\"", 0.123456789}, {"c", nullptr}}};
  CHECK(csv_text(table) == "name,value\n\"a,\"\"b\"\"\",0.123457\nc,\n");
}

TEST_CASE("write_report: every file, a page of its own without network") {
  const test::ScratchFolder folder;
  EvaluationReport report = small_report();
  report.clips[0].name = "</script><b>";
  report.clips[1].name = "<!--<script>alert(1)</script>";
  write_report(folder / "report", report);
  for (const char* file :
       {"summary.json", "table_3.csv", "table_4.csv", "table_5.csv", "table_6.csv", "table_7.csv",
        "methods.csv", "fits.csv", "clips.csv", "tracks.csv"})
    CHECK(std::filesystem::exists(folder / "report" / file));
  const std::string page = read_text_file(folder / "report" / "report.html");
  CHECK(page.starts_with("<!doctype html>"));
  CHECK(page.find("{{") == std::string::npos);
  CHECK(page.find("</script><b>") == std::string::npos);
  CHECK(page.find("<!--<script>") == std::string::npos);
  CHECK(page.find("<script>alert") == std::string::npos);
  CHECK(page.find("\\u003cscript>alert(1)") != std::string::npos);
  for (const char* reference : {"src=", "http:", "https:", "@import", "url("}) {
    std::string text = page;
    const std::string svg = "http://www.w3.org/2000/svg";
    for (std::size_t at; (at = text.find(svg)) != std::string::npos;) text.erase(at, svg.size());
    CAPTURE(reference);
    CHECK(text.find(reference) == std::string::npos);
  }
  const test::ScratchFolder blocked;
  blocked.write("file", "");
  CHECK_THROWS_AS(write_report(blocked / "file", report), InputError);
}

TEST_CASE("a page whose clips are all too long for its viewer has none, and says so") {
  ReportClip clip;
  clip.name = "endless";
  clip.point_names = {"Hips", "Head"};
  clip.parents = {-1, 0};
  clip.joints = 2;
  // Numbers of a dozen characters each: a sixth of the frames is too much.
  clip.truth_mm = MatrixD::Random(220'000, 6) * 1e17;
  clip.track_px = MatrixD::Zero(220'000, 4);
  clip.samples = {{clip.truth_mm, test::score_of(20, 0.9, 0.8)}};
  EvaluationReport report;
  report.clips = {clip};
  const std::string page = report_page(report);
  CHECK(page.find("To keep this page small there is no viewer: the clips are too long for it.") !=
        std::string::npos);
  CHECK(page.find("the viewer shows") == std::string::npos);
  CHECK(page.find("\"clips\":[]") != std::string::npos);
}

TEST_CASE("the page stays within its budget, and names what it leaves out") {
  std::vector<ReportClip> clips;
  for (unsigned i = 0; i < 20; ++i)
    clips.push_back(test::report_clip("clip" + std::to_string(i), "walk", 10 * i, 2500, 4));
  const EvaluationReport report = report_of(clips);
  const std::string page = report_page(report);
  CHECK(page.size() < 5'000'000);
  CHECK(page.find("To keep this page small the viewer shows") != std::string::npos);
  const std::string small = report_page(small_report());
  CHECK(small.find("To keep this page small") == std::string::npos);
  // What a method is, in words, and of those that are shown alone.
  CHECK(small.find("A linear map from 11 frames of 2D to the pose.") != std::string::npos);
  CHECK(small.find("Boltzmann") == std::string::npos);
}

}  // namespace mcdbn
