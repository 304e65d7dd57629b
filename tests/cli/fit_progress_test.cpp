// What a fit reports of its speed and of the time to come, where kernels are compiled first.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <vector>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/device/device.hpp"
#include "run_cli.hpp"

namespace fit_progress_test {

using namespace mcdbn::test;

namespace {

constexpr const char* kNotice = "compiling kernels for these sizes, once";

std::string table_of_bits(int rows, int columns) {
  std::string text;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      text += fmt::format("{}{}", (row * column + row) % 3 == 0 ? 1 : 0,
                          column + 1 < columns ? ',' : '\n');
  return text;
}

/// The seconds that the first line of progress gives as left.
double first_estimate_s(const std::string& messages) {
  std::smatch found;
  const std::regex left(R"(windows/s  (?:(\d+) min )?(\d+) s left)");
  REQUIRE(std::regex_search(messages, found, left));
  return (found[1].matched ? 60 * std::stod(found[1]) : 0) + std::stod(found[2]);
}

std::vector<double> speeds_in(const std::filesystem::path& metrics) {
  std::vector<double> speeds;
  std::istringstream lines(mcdbn::read_text_file(metrics));
  for (std::string line; std::getline(lines, line);)
    speeds.push_back(nlohmann::json::parse(line).at("windows_per_s"));
  return speeds;
}

}  // namespace

TEST_CASE("fit: compiling kernels is reported, and is no part of the speed or of the time left") {
  if (mcdbn::matching_devices({"Portable", "0"}).empty()) return;
  const ScratchFolder folder;
  const auto data = folder.write("data.csv", table_of_bits(1800, 64)).string();
  const std::string out = (folder / "rbm.safetensors").string();
  // PoCL takes seconds where its cache is empty.
  const auto fit = [&](const std::string& cache, const std::string& options) {
    return run_cli(fmt::format("fit '{}' --machine rbm --binary-gibbs-steps 15 --binary-epochs 20 "
                               "--platform Portable --device 0 -o '{}' {}",
                               data, out, options),
                   fmt::format("POCL_CACHE_DIR='{}'", (folder / cache).string()));
  };
  std::filesystem::create_directory(folder / "cache");
  const auto begin = std::chrono::steady_clock::now();
  const CliResult result = fit("cache", "");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const auto notice = result.standard_error.find(kNotice);
  CHECK(notice != std::string::npos);
  CHECK(result.standard_error.rfind(kNotice) == notice);
  CHECK(first_estimate_s(result.standard_error) < 2 * took.count());
  std::vector<double> speeds = speeds_in(folder / "rbm.metrics.jsonl");
  REQUIRE(speeds.size() == 20);
  const double first = speeds.front();
  std::nth_element(speeds.begin(), speeds.begin() + 10, speeds.end());
  CHECK(first > speeds[10] / 20);

  std::filesystem::create_directory(folder / "other cache");
  CHECK(fit("other cache", "--quiet").standard_error.empty());
}

}  // namespace fit_progress_test
