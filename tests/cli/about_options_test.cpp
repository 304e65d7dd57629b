// Every option of info, devices and bench, and what it changes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "base/text_file.hpp"
#include "library_calls.hpp"
#include "mcdbn/device/device.hpp"
#include "option_table.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

struct BenchRow {
  json what;
  double multiply_adds;  ///< 0: not counted
};

/// Every step that bench measures, and its multiply-adds counted once more.
std::vector<BenchRow> bench_rows() {
  std::vector<BenchRow> rows;
  const auto crbm = [&](const char* layer, double v, double k, int batch) {
    const double order = 5, h = 300;
    const double biases_and_gradients = 2 * order * v * (v + h), passes = (1 + 2 * k) * v * h,
                 gradient_of_W = 2 * v * h;
    rows.push_back({{{"layer", layer},
                     {"visible", v},
                     {"order", order},
                     {"hidden", h},
                     {"batch", batch},
                     {"k", k}},
                    batch * (biases_and_gradients + passes + gradient_of_W)});
  };
  for (const int batch : {100, 1024}) {
    crbm("gaussian_crbm", 96, 5, batch);
    crbm("binary_crbm", 300, 1, batch);
    crbm("persistent_gaussian_crbm", 96, 5, batch);
    crbm("persistent_binary_crbm", 300, 1, batch);
    json mrbm = {{"visible", 600}, {"hidden", 150}, {"batch", batch}, {"steps", 10}};
    mrbm["layer"] = "mrbm";
    for (const int n : {2, 3}) {
      mrbm["modalities"] = n;
      mrbm["visible"] = 300 * n;
      // A direction: ten steps but for the first, which starts from zeros; the others' input.
      rows.push_back({mrbm, batch * n * (6.0 * 10 - 3 + 2 * (n - 1)) * 300 * 150});
    }
    mrbm["visible"] = 600;
    mrbm.erase("modalities");
    json joint = mrbm;
    joint.erase("steps");
    joint["layer"] = "joint_likelihood";
    joint["k"] = 1;
    rows.push_back({joint, batch * 5.0 * 600 * 150});
    mrbm["layer"] = "mrbm_chain";
    for (const double temperature : {0.0, 1.0}) {
      mrbm["temperature"] = temperature;
      rows.push_back({mrbm, batch * 2.0 * 10 * 300 * 150});
    }
  }
  for (const char* backend : {"own", "clblast"})
    for (const auto& [m, k] : {std::pair(100, 96), {100, 480}, {100, 1500}, {1024, 1500}})
      rows.push_back({{{"layer", "gemm"}, {"m", m}, {"n", 300}, {"k", k}, {"backend", backend}},
                      300.0 * m * k});
  const auto direction = [](double seen, double absent) {
    // Values and weights of what is seen; of what is not, errors too. Two steps of the mean field,
    // of which the first starts from zeros: two products down and one up.
    const double up = 2 * (1 + 10) * seen * 768, down = 3 * (768 * absent + 10 * absent * absent),
                 shared = 3 * (1 + 3) * 768.0 * 512;
    return 48 * (34 - 10) * (up + down + shared);
  };
  for (const int directions : {1, 2})
    rows.push_back({{{"layer", "fine_tuning"},
                     {"windows", 48},
                     {"window_frames", 34},
                     {"directions", directions}},
                    direction(43, 154) + (directions - 1) * direction(154, 43)});
  for (const int temperature : {0, 1})
    rows.push_back({{{"layer", "regeneration"},
                     {"frames", 1000},
                     {"samples", 10},
                     {"temperature", temperature},
                     {"k", temperature}},
                    0});
  for (const int k : {1, 30})
    rows.push_back({{{"layer", "generation"}, {"frames", 1000}, {"samples", 10}, {"k", k}},
                    1000.0 * 10 * (5 * 96 * (96 + 300) + 2 * (k + 1) * 96 * 300)});
  return rows;
}

/// A step's figures are what was measured, and follow from the time.
void check_bench_step(json step, const BenchRow& row, double peak_gflops) {
  CAPTURE(step.dump());
  const auto take = [&](const char* name) {
    const double value = step.at(name).get<double>();
    step.erase(name);
    return value;
  };
  const double us = take("median_us");
  CHECK(us > 0);
  CHECK(take("launches") >= 1);
  if (row.multiply_adds > 0) {
    const double gflops = take("gflops");
    CHECK(gflops == doctest::Approx(2 * row.multiply_adds / us * 1e-3));
    CHECK(take("percent_of_peak") == doctest::Approx(100 * gflops / peak_gflops));
  }
  if (row.what.contains("frames")) CHECK(take("us_per_frame") == doctest::Approx(us / 1000));
  CHECK(step == row.what);
}

void check_bench_lines(const std::string& text) {
  CAPTURE(text);
  CHECK(count_lines(text) == 1 + 8 + 2);
  CHECK(std::regex_search(
      text, std::regex("^.+, \\d+ compute units: \\d+\\.\\d GFLOP/s with fma alone\n"
                       "gemm  m 100  n 300  k 96  backend own {32} +\\d+\\.\\d us +\\d+ launches "
                       "+\\d+\\.\\d GFLOP/s +\\d+\\.\\d % of peak\n")));
  CHECK(std::regex_search(
      text, std::regex("\nregeneration  frames 1000  samples 10  temperature 1.0  k 1 {16} +"
                       "\\d+\\.\\d us +\\d+ launches +\\d+\\.\\d\\d us a frame\n$")));
}

/// What it prints until the shortest epoch is measured; the longest takes minutes.
std::string bench_of_first_epoch() {
  const ScratchFolder folder;
  const std::string output = (folder / "output").string();
  const fs::path script = folder.write(
      "first_epoch.sh", fmt::format("'{}' bench --only epoch --seconds 0 >'{}' & program=$!\n"
                                    "while kill -0 $program 2>/dev/null && [ ! -s '{}' ]; do\n"
                                    "  sleep 0.05\ndone\n"
                                    "kill -KILL $program 2>/dev/null\nwait $program\n",
                                    MCDBN_CLI, output, output));
  run_program("/bin/sh", fmt::format("'{}'", script.string()));
  return mcdbn::read_text_file(output);
}

}  // namespace

/// COCO results of two people over 40 frames, the second one smaller.
static std::string two_people() {
  json entries = json::array();
  for (int frame = 0; frame < 40; ++frame)
    for (const double size : {300.0, 100.0}) {
      json numbers = json::array();
      for (int joint = 0; joint < 17; ++joint) {
        const double right = joint % 2 == 0 ? -0.1 : 0.1;
        numbers.insert(numbers.end(), {700 - size + size * right, 400 + size * joint / 17, 0.9});
      }
      entries.push_back({{"image_id", frame}, {"category_id", 1}, {"keypoints", numbers}});
    }
  return entries.dump();
}

TEST_CASE("info: every option changes what its help describes") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(6));
  const fs::path track = folder.write("track.json", two_people());
  const auto info_of = [&](const std::string& options) {
    const CliResult result = run_cli("info --json " + track.string() + options);
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    return json::parse(result.standard_output);
  };
  const json plain = info_of("");
  CHECK(plain.at("format") == "coco");
  CHECK(plain.at("joint_set") == "COCO_17");
  CHECK(plain.at("roles").at("left_knee") == "left_knee");
  CHECK(plain.at("fps") == 30);
  CHECK(plain.at("people_seen") == 2);
  REQUIRE(plain.at("people").size() == 2);
  CHECK(plain.at("people")[0].at("height_px").get<double>() > 200);
  CHECK(plain.at("people")[0].at("seen_frames") == 40);
  CHECK(plain.at("people")[0].at("jitter_px") == 0);
  CHECK(plain.at("notices").size() == 2);
  check_options(
      "info",
      {{"file",
        [&] {
          const CliResult result = run_cli("info " + clip.string());
          CHECK(result.exit_code == 0);
          CHECK(result.standard_output.find("\nframes                6\n") != std::string::npos);
          CHECK(run_cli("info absent.bvh").exit_code == 3);
        }},
       {"--format",
        [&] {
          CHECK(info_of(" --format coco") == plain);
          const CliResult other = run_cli("info --format sleap " + track.string());
          CHECK(other.exit_code == 3);
          CHECK(other.standard_error.find("no column frame_idx") != std::string::npos);
        }},
       {"--person",
        [&] {
          const json second = info_of(" --person 2").at("people");
          CHECK(second == json::array({plain.at("people")[1]}));
          CHECK(info_of(" --person all") == plain);
          CHECK(info_of(" --person largest").at("people") == json::array({plain.at("people")[0]}));
          CHECK(run_cli("info --person 3 " + track.string()).exit_code == 3);
          CHECK(run_cli("info --person tall " + track.string()).exit_code == 2);
        }},
       {"--fps",
        [&] {
          CHECK(info_of(" --fps 50").at("fps") == 50);
          CHECK(info_of(" --fps 50").at("duration_s") == 0.8);
        }},
       {"--image-size",
        [&] {
          const json sized = info_of(" --image-size 1000 800");
          CHECK(sized.at("width_px") == 1000);
          CHECK(sized.at("height_px") == 800);
        }},
       {"--quiet", [&] { CHECK(info_of(" --quiet") == plain); }},
       {"--json", [&] {
          const CliResult result = run_cli("info --json " + clip.string());
          CHECK(json::parse(result.standard_output).at("frames") == 6);
        }}});
}

TEST_CASE("info gives a model's training settings") {
  if (!have_device()) return;
  const fs::path model = TinyPipeline::instance().model();
  const json about = json::parse(run_cli("info --json " + model.string()).standard_output);
  CHECK(about.at("kind") == "trained model");
  CHECK(about.at("training_clips") == json{"walk_s01_01.bvh", "walk_s01_02.bvh"});
  CHECK(about.at("hidden") == 8);
  CHECK(about.at("mrbm-hidden") == 8);
  CHECK(about.at("order") == 10);
  CHECK(about.at("layers") == 1);
  CHECK(about.at("seed") == 1);
  CHECK(about.at("fps") == 30);
  CHECK(about.at("look_ahead") == 5);
  CHECK(about.at("mean_field_steps") == 2);  // fine-tuning's
  CHECK(about.at("camera.azimuth") == 30);
  CHECK(about.at("camera.elevation") == 10);
  CHECK(about.at("camera.fov") == 45);
  CHECK(about.at("tracks") == "exact");
  CHECK(about.at("skeleton") == "own");
  CHECK(about.at("stages") == "both");
  const std::string text = run_cli("info " + model.string()).standard_output;
  CHECK(text.starts_with("camera.azimuth         30\n"));
  CHECK(text.find("\ngaussian.history-noise 0\n") != std::string::npos);
}

TEST_CASE("devices: every option changes what its help describes") {
  if (!have_device()) return;
  check_options(
      "devices",
      {{"--json",
        [] {
          const json listed = json::parse(run_cli("devices --json").standard_output);
          const auto devices = mcdbn::list_devices();
          REQUIRE(listed.at("devices").size() == devices.size());
          for (std::size_t i = 0; i < devices.size(); ++i) {
            const json& one = listed.at("devices").at(i);
            const mcdbn::DeviceInfo& info = devices[i];
            CHECK(one == json{{"platform_index", info.platform_index},
                              {"platform", info.platform_name},
                              {"device_index", info.device_index},
                              {"name", info.name},
                              {"vendor", info.vendor},
                              {"driver", info.driver_version},
                              {"opencl_c_version", info.opencl_c_version},
                              {"type", info.is_gpu ? "gpu" : "cpu"},
                              {"compute_units", info.compute_units},
                              {"global_memory_bytes", info.global_memory_bytes},
                              {"largest_buffer_bytes", info.largest_buffer_bytes},
                              {"local_memory_bytes", info.local_memory_bytes},
                              {"largest_work_group", info.largest_group},
                              {"largest_work_group_sides", info.largest_group_sides},
                              {"preferred_vector_width", info.preferred_vector_width},
                              {"native_vector_width", info.native_vector_width}});
          }
        }},
       {"--quiet", [] {
          CHECK(run_cli("devices --quiet").standard_output == run_cli("devices").standard_output);
        }}});
}

TEST_CASE("bench: every option changes what its help describes") {
  if (!have_device()) return;
  std::vector<OptionRow> rows = {
      {"--json",
       [] {
         const CliResult result = run_cli("bench --json --seconds 0");
         CAPTURE(result.standard_error);
         REQUIRE(result.exit_code == 0);
         const json report = json::parse(result.standard_output);
         const mcdbn::DeviceInfo& info = usual_device().info();
         CHECK(report.at("device") == info.name);
         CHECK(report.at("driver") == info.driver_version);
         CHECK(report.at("compute_units") == info.compute_units);
         const std::vector<BenchRow> wanted = bench_rows();
         REQUIRE(report.at("steps").size() == wanted.size());
         for (std::size_t i = 0; i < wanted.size(); ++i)
           check_bench_step(report.at("steps").at(i), wanted[i],
                            report.at("peak_gflops").get<double>());
       }},
      {"--only",
       [] {
         check_bench_lines(run_cli("bench --seconds 0 --only gemm regeneration").standard_output);
         CHECK(bench_of_first_epoch().find("\nepoch  frames 1000  batch 100  ") !=
               std::string::npos);
         CHECK(run_cli("bench --only other").exit_code == 2);
       }},
      {"--seconds", [] { CHECK(run_cli("bench --seconds -1").exit_code == 2); }},
      {"--roofline",
       [] {
         const json report =
             json::parse(run_cli("bench --json --roofline --seconds 0 --only joint_likelihood")
                             .standard_output);
         for (const json& step : report.at("steps")) {
           CAPTURE(step.dump());
           double flops = 0, us = step.at("roofline").at("between_launches_us");
           for (const json& kernel : step.at("roofline").at("kernels")) {
             us += kernel.at("us").get<double>();
             if (!kernel.contains("bytes")) continue;
             flops += kernel.at("flops").get<double>();
             CHECK(kernel.at("flops_per_byte") ==
                   doctest::Approx(kernel["flops"].get<double>() / kernel["bytes"].get<double>()));
             CHECK(kernel.at("gflops") == doctest::Approx(kernel["flops"].get<double>() /
                                                          kernel["us"].get<double>() * 1e-3));
           }
           CHECK(us > 0);
           CHECK(flops == doctest::Approx(step.at("gflops").get<double>() *
                                          step.at("median_us").get<double>() * 1e3));
         }
         const std::string text =
             run_cli("bench --roofline --seconds 0 --only joint_likelihood").standard_output;
         CHECK(text.find("\n  joint_chain  ") != std::string::npos);
         CHECK(text.find("\n  between launches  ") != std::string::npos);
       }},
      {"--trace",
       [] {
         const ScratchFolder folder;
         const fs::path file = folder / "trace.json";
         run_cli(
             fmt::format("bench --trace '{}' --seconds 0 --only joint_likelihood", file.string()));
         const json events = json::parse(mcdbn::read_text_file(file)).at("traceEvents");
         const auto count = [&](const std::string& name) {
           return std::count_if(events.begin(), events.end(),
                                [&](const json& event) { return event.at("name") == name; });
         };
         CHECK(count("thread_name") == 2);  // both sizes of mini-batch
         CHECK(count("joint_chain") == 2);
         CHECK(count("joint_likelihood_update") == 2);
       }},
      {"--quiet",
       [] {
         const CliResult result = run_cli("bench --quiet --seconds 0 --only gemm regeneration");
         CHECK(result.standard_error.empty());
         check_bench_lines(result.standard_output);
       }},
      // Not run: it takes minutes.
      {"--tune", [] {}}};
  const std::string call = "bench --only mrbm_chain --seconds 0 --json";
  for (const OptionRow& row : device_rows(call, [] { return std::string(); })) rows.push_back(row);
  check_options("bench", rows);
}
