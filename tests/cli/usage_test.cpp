#include <doctest/doctest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "base/capture_bound.hpp"
#include "fitting/blas_kernels.hpp"
#include "option_table.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;

namespace {

constexpr const char* kNoDrivers = "OCL_ICD_VENDORS=/nonexistent OCL_ICD_FILENAMES=";

/// The error is one line that begins with the program's name, and stdout stays empty.
void check_one_line_error(const CliResult& result, int exit_code) {
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == exit_code);
  CHECK(result.standard_output.empty());
  CHECK(count_lines(result.standard_error) == 1);
  CHECK(result.standard_error.starts_with("mcdbn-cl: error: "));
}

}  // namespace

TEST_CASE("help and version go to stdout") {
  const CliResult version = run_cli("--version");
  CHECK(version.exit_code == 0);
  CHECK(version.standard_output == "mcdbn-cl " MCDBN_VERSION "\n");
  CHECK(version.standard_error.empty());

  const CliResult help = run_cli("--help");
  CHECK(help.exit_code == 0);
  CHECK(help.standard_error.empty());
  CHECK(help.standard_output.find("Exit codes") != std::string::npos);
}

TEST_CASE("a CPU that OpenBLAS does not know gets the kernels of one that it does") {
  const std::string cores = run_cli("--version", "OPENBLAS_VERBOSE=2").standard_error;
  CAPTURE(cores);
  if (cores.ends_with("Core: Prescott\n")) CHECK(mcdbn::known_cpu_like_this().empty());
}

TEST_CASE("every command's help shows an example, and every command takes --quiet") {
  const std::map<std::string, std::string> commands = commands_in_help();
  for (const auto& [command, description] : commands) {
    CAPTURE_BOUND(command);
    CHECK(description.find_first_not_of(' ') != std::string::npos);
    const CliResult result = run_cli(command + " --help");
    CHECK(result.exit_code == 0);
    CHECK(result.standard_output.find("\n  mcdbn-cl " + command + " ") != std::string::npos);
    CHECK(result.standard_output.find("\n  --quiet ") != std::string::npos);
    CHECK(result.standard_output.find(" in [") == std::string::npos);  // as CLI11 writes ranges
  }
  CHECK(commands.size() >= 3);
}

TEST_CASE("evaluate's help gives the defaults of the paper's protocol") {
  // As one line: where the help breaks lines does not count.
  std::istringstream words(run_cli("evaluate --help").standard_output);
  std::string help;
  for (std::string word; words >> word;) help += word + " ";
  CHECK(help.find("(default: 1; 10 with --protocol paper)") != std::string::npos);
  CHECK(help.find("with --regeneration-sampled; else 0); 1 with --protocol paper") !=
        std::string::npos);
}

TEST_CASE("wrong usage is exit code 2") {
  check_one_line_error(run_cli(""), 2);
  check_one_line_error(run_cli("frobnicate"), 2);
  check_one_line_error(run_cli("--frobnicate"), 2);
  check_one_line_error(run_cli("project"), 2);
  check_one_line_error(run_cli("project a.bvh -o a.csv --fps minus"), 2);
  check_one_line_error(run_cli("project a.bvh -o a.csv --camera c.yaml --camera-azimuth 3"), 2);
  CHECK(run_cli("frobnicate").standard_error.find("frobnicate") != std::string::npos);
}

TEST_CASE("a command that does not exist is exit code 2 with those that do, asked for help too") {
  for (const char* call : {"invent", "invent --help", "--help invent", "invent -h",
                           "invent --version", "invent --json"}) {
    CAPTURE(call);
    const CliResult result = run_cli(call);
    check_one_line_error(result, 2);
    CHECK(result.standard_error.find("unknown command invent; there are devices, synthesize") !=
          std::string::npos);
    for (const char* command : {"project", "render", "train", "regenerate", "evaluate", "info"})
      CHECK(result.standard_error.find(std::string(", ") + command) != std::string::npos);
  }
  CHECK(run_cli("train --help").exit_code == 0);
}

TEST_CASE("devices lists what there is") {
  if (!have_device()) return;
  const CliResult text = run_cli("devices");
  CHECK(text.exit_code == 0);
  CHECK(text.standard_error.empty());
  const auto listed = nlohmann::json::parse(run_cli("devices --json").standard_output);
  REQUIRE(!listed.at("devices").empty());
  for (const auto& device : listed.at("devices")) {
    CHECK(device.at("compute_units").get<int>() > 0);
    CHECK(device.at("global_memory_bytes").get<double>() > 0);
    CHECK(device.at("opencl_c_version").get<std::string>().starts_with("OpenCL C "));
    CHECK(text.standard_output.find(device.at("name").get<std::string>()) != std::string::npos);
    CHECK(text.standard_output.find(device.at("driver").get<std::string>()) != std::string::npos);
  }
}

TEST_CASE("no OpenCL platform is exit code 4 and the message names what to install") {
  const CliResult result = run_cli("devices", kNoDrivers);
  check_one_line_error(result, 4);
  CHECK(result.standard_error.find("pocl-opencl-icd") != std::string::npos);
  // Programs read an empty list.
  const CliResult listed = run_cli("devices --json", kNoDrivers);
  CHECK(listed.exit_code == 4);
  CHECK(nlohmann::json::parse(listed.standard_output) ==
        nlohmann::json{{"devices", nlohmann::json::array()}});
  CHECK(listed.standard_error == result.standard_error);
}

TEST_CASE("a full disk behind stdout is a failure") {
  if (!have_device()) return;
  const CliResult result = run_cli("devices >/dev/full");
  CHECK(result.exit_code == 1);
  CHECK(count_lines(result.standard_error) == 1);
}
