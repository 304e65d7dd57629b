#include "fitted_machines.hpp"

#include <fmt/format.h>

#include "base/random_matrix.hpp"
#include "library_calls.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "run_cli.hpp"

namespace mcdbn::test {
namespace {

bool is_binary(const std::string& kind) {
  return kind == "rbm" || kind == "dbn" || kind.starts_with("binary");
}

}  // namespace

const FittedMachines& FittedMachines::instance() {
  static const FittedMachines machines;
  return machines;
}

FittedMachines::FittedMachines() {
  const MatrixF noise = random_matrix(60, 5, 1);
  write_matrix(bits(), (noise.array() > 0.2F).cast<float>());
  // Columns of other sizes, so that scaling matters.
  MatrixF scaled = noise;
  for (Eigen::Index c = 0; c < 5; ++c) {
    const auto size = static_cast<float>(c);
    scaled.col(c) = (10.0F * size + (1.0F + size) * noise.col(c).array()).matrix();
  }
  write_matrix(values(), scaled);
}

std::string FittedMachines::model(const std::string& kind) const {
  const std::filesystem::path file = folder_ / (kind + ".safetensors");
  if (std::filesystem::exists(file)) return file.string();
  std::string options = short_fit(kind);
  if (kind.ends_with("crbm") || kind.ends_with("cdbn")) options += " --order 2";
  if (data_of(kind) == values()) options += " --standardize";
  CHECK(output_of(
            fmt::format("fit {} --machine {} -o {}{}", data_of(kind), kind, file.string(), options))
            .empty());
  return file.string();
}

std::string FittedMachines::data_of(const std::string& kind) const {
  return is_binary(kind) ? bits() : values();
}

std::string short_fit(const std::string& kind) {
  std::string options = " --hidden 5 --batch 20";
  if (!is_binary(kind)) options += " --gaussian-epochs 2";
  if (is_binary(kind) || kind.ends_with("dbn")) options += " --binary-epochs 2";
  return options + " --quiet";
}

std::string output_of(const std::string& call) {
  const CliResult result = run_cli(call);
  CAPTURE(call);
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  return result.standard_output;
}

MatrixF printed(const std::string& call) {
  const ScratchFolder folder;
  return read_matrix(folder.write("printed.csv", output_of(call)));
}

void check_refused(const std::string& call, int exit_code, const std::string& words) {
  const CliResult result = run_cli(call);
  CAPTURE(call);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == exit_code);
  CHECK(result.standard_output.empty());
  CHECK(result.standard_error.starts_with("mcdbn-cl: error: "));
  CHECK(result.standard_error.find(words) != std::string::npos);
}

SavedMachine loaded(const std::string& file) {
  return load_machine(usual_device(), file);
}

std::vector<OptionRow> refused_device_rows(const std::string& call) {
  return {{"--platform",
           [=] {
             check_refused(call + " --platform no-such-one --device no-such-name", 4,
                           "platform 'no-such-one', device 'no-such-name'");
           }},
          {"--device", [] {}}};
}

}  // namespace mcdbn::test
