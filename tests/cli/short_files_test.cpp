// Files too short for a machine's history, beside files that are long enough.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "fitted_machines.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "run_cli.hpp"
#include "tiny_pipeline.hpp"

namespace short_files_test {

using namespace mcdbn::test;
using mcdbn::MatrixF;

TEST_CASE("fit, transform and score name each file that has no row with the machine's history") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const MatrixF values = mcdbn::read_matrix(machines.values());
  const auto first_rows = [&](Eigen::Index count) {
    const auto file = folder / fmt::format("{}.npy", count);
    mcdbn::write_matrix(file, MatrixF(values.topRows(count)));
    return file.string();
  };
  const std::string data =
      fmt::format("{} {} {} {}", first_rows(1), machines.values(), first_rows(2), first_rows(3));
  const std::string model = machines.model("crbm");  // of order 2
  for (const std::string& call :
       {fmt::format("transform --model {} {} --quiet", model, data),
        fmt::format("score --model {} {} --quiet", model, data),
        fmt::format("fit {} --machine crbm --order 2 --standardize -o {}{}", data,
                    (folder / "m.safetensors").string(), short_fit("crbm"))}) {
    CAPTURE(call);
    const CliResult result = run_cli(call);
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    CHECK(count_lines(result.standard_error) == 2);
    for (const auto& [file, rows] : {std::pair{"1.npy", "1 row;"}, {"2.npy", "2 rows;"}})
      CHECK(result.standard_error.find(fmt::format(
                "mcdbn-cl: warning: {}: {} none has the machine's history of 2 rows before it\n",
                (folder / file).string(), rows)) != std::string::npos);
  }
  // The three rows give one, as they do alone.
  const auto rows_of = [&](const std::string& files) {
    return printed(fmt::format("transform --model {} {}", model, files));
  };
  CHECK(rows_of(data).rows() == 60 - 2 + 1);
  CHECK(rows_of(data).bottomRows(1).isApprox(rows_of(first_rows(3)), 1e-5F));
}

}  // namespace short_files_test
