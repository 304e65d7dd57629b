// Every option of info, devices and bench, and what it changes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "mcdbn/device/device.hpp"
#include "option_table.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

TEST_CASE("info: every option changes what its help says") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(6));
  check_options("info", {{"file",
                          [&] {
                            const CliResult result = run_cli("info " + clip.string());
                            CHECK(result.exit_code == 0);
                            CHECK(result.standard_output.find("\nframes                6\n") !=
                                  std::string::npos);
                            CHECK(run_cli("info absent.bvh").exit_code == 3);
                          }},
                         {"--json", [&] {
                            const CliResult result = run_cli("info --json " + clip.string());
                            CHECK(json::parse(result.standard_output).at("frames") == 6);
                          }}});
}

TEST_CASE("info says of a model what it was trained with") {
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
}

TEST_CASE("devices: every option changes what its help says") {
  if (!have_device()) return;
  check_options("devices",
                {{"--json", [] {
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
                                        {"local_memory_bytes", info.local_memory_bytes}});
                    }
                  }}});
}

TEST_CASE("bench: every option changes what its help says") {
  if (!have_device()) return;
  const auto steps = [](const std::string& options) {
    const CliResult result = run_cli("bench --json --seconds 0 " + options);
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    return json::parse(result.standard_output);
  };
  std::vector<OptionRow> rows = {
      {"--only",
       [&] {
         const json report = steps("--only gemm");
         CHECK(report.at("steps").size() == 8);
         for (const json& step : report.at("steps")) {
           CHECK(step.at("layer") == "gemm");
           CHECK(step.at("median_us").get<double>() > 0);
           const double flops = 2.0 * step.at("m").get<double>() * step.at("n").get<double>() *
                                step.at("k").get<double>();
           CHECK(step.at("gflops").get<double>() ==
                 doctest::Approx(flops / step.at("median_us").get<double>() * 1e-3));
           CHECK(step.at("percent_of_peak").get<double>() ==
                 doctest::Approx(100 * step.at("gflops").get<double>() /
                                 report.at("peak_gflops").get<double>()));
         }
         CHECK(run_cli("bench --only other").exit_code == 2);
       }},
      {"--json",
       [] {
         const CliResult text = run_cli("bench --seconds 0 --only gemm");
         CHECK(text.standard_output.find("GFLOP/s with fma alone") != std::string::npos);
         CHECK(count_lines(text.standard_output) == 9);
       }},
      {"--seconds", [] { CHECK(run_cli("bench --seconds -1").exit_code == 2); }},
      // Not run: it takes minutes.
      {"--tune", [] {}}};
  const std::string call = "bench --only gemm --seconds 0 --json";
  for (const OptionRow& row : device_rows(call, [] { return std::string(); })) rows.push_back(row);
  check_options("bench", rows);
}
