// What regenerate prints of how sure it is, against the file that it writes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "base/near.hpp"
#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

namespace uncertainty_line_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

/// RMS over all frames and axes, by joint, of a file of --uncertainty.
std::map<std::string, double> rms_by_joint(const fs::path& file) {
  std::istringstream text(mcdbn::read_text_file(file));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> names = cells_of(line);
  std::map<std::string, double> squares;
  int frames = 0;
  for (; std::getline(text, line); ++frames) {
    const std::vector<std::string> cells = cells_of(line);
    REQUIRE(cells.size() == names.size());
    for (std::size_t i = 1; i < cells.size(); ++i)
      squares[names[i].substr(0, names[i].find('_'))] += std::pow(std::stod(cells[i]), 2);
  }
  for (auto& [joint, square] : squares) square = std::sqrt(square / (3 * frames));
  return squares;
}

}  // namespace

TEST_CASE("regenerate prints how far off joints are, and names the one that is the least sure") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string track = (folder / "track.csv").string();
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const std::string clip = (pipeline.motion() / "walk_s02_01.bvh").string();
  REQUIRE(run_cli(fmt::format("project '{}' -o '{}'", clip, track)).exit_code == 0);
  const CliResult result = run_cli(
      fmt::format("regenerate --model '{}' --input '{}' -o '{}' --fit none --uncertainty '{}'",
                  pipeline.model().string(), track, (folder / "out.bvh").string(),
                  (folder / "sure.csv").string()));
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  std::smatch printed;
  REQUIRE(std::regex_search(result.standard_error, printed,
                            std::regex(R"(standard deviation of (\S+) in the file's unit along )"
                                       R"(each axis, (\S+) most, by (\S+))")));
  std::map<std::string, double> rms = rms_by_joint(folder / "sure.csv");
  // Joints are where they are from the root, so the root is not among them.
  REQUIRE(rms.erase("Hips") == 1);
  double squares = 0, most = 0;
  for (const auto& [joint, value] : rms) {
    squares += value * value / static_cast<double>(rms.size());
    most = std::max(most, value);
  }
  constexpr double kThreeDigits = 0.01;
  CHECK(std::stod(printed[1]) == near(std::sqrt(squares), kThreeDigits));
  CHECK(std::stod(printed[3]) == near(most, kThreeDigits));
  REQUIRE(rms.count(printed[2]) == 1);
  CHECK(rms.at(printed[2]) == near(most, kThreeDigits));
  CHECK(most > 1.1 * std::sqrt(squares));
}

}  // namespace uncertainty_line_test
