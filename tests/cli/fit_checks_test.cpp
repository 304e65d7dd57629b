// fit: what it refuses, and what it warns of.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "base/random_matrix.hpp"
#include "fitted_machines.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "tiny_pipeline.hpp"

namespace fit_checks_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

TEST_CASE("fit: data and flags that do not fit are refused") {
  const ScratchFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  folder.write("bits.csv", "a,b\n0,1\n1,0\n1,1\n");
  folder.write("wide.csv", "0,1,1\n");
  folder.write("holes.csv", "0,1\n,1\n");
  folder.write("odd.csv", "0,1\n1,x\n");
  folder.write("large.csv", "0,1\n1,2.5\n");
  const std::string out = " -o " + path("m.safetensors") + " --machine ";
  check_refused("fit " + path("odd.csv") + out + "rbm", 3, "odd.csv:2: 'x' in column 2");
  check_refused("fit " + path("bits.csv") + " " + path("wide.csv") + out + "rbm", 3,
                "wide.csv: 3 columns, 2 in");
  check_refused("fit " + path("holes.csv") + out + "rbm", 3, "holes.csv: row 2, column 1 is nan");
  check_refused("fit " + path("large.csv") + out + "rbm", 3,
                "large.csv: row 2, column 2 is 2.5; binary units need");
  check_refused("fit " + path("bits.csv") + out + "cdbn --order 2", 3,
                "no file has more than 4 rows");
  check_refused("fit x.npy" + out + "rbm --order 2", 2, "--order: --machine rbm has no history");
  check_refused("fit x.npy" + out + "crbm --layers 2", 2, "--layers: --machine crbm has no layers");
  check_refused("fit x.npy" + out + "dbn --standardize", 2, "--standardize: --machine dbn");
  check_refused("fit x.npy" + out + "gaussian-rbm --gaussian v", 2,
                "--gaussian: --machine gaussian-rbm has no modalities");
  check_refused("fit x.npy" + out + "rbm --binary-rate 0", 2, "--binary-rate must be");
  check_refused("fit" + out + "mrbm --modality a=x.npy --modality b=x.npy --standardize", 2,
                "--standardize: no modality is --gaussian");
  CHECK(!fs::exists(folder / "m.safetensors"));
}

TEST_CASE("fit: a rate that is too high trips the guard, which names what to lower") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string file = (folder / "m.safetensors").string();
  const CliResult result =
      run_cli(fmt::format("fit {} --machine gaussian-rbm -o {} --hidden 5 --batch 20 "
                          "--gaussian-rate 5 --gaussian-epochs 200 --quiet",
                          FittedMachines::instance().values(), file));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 1);
  CHECK(result.standard_error.find("lower --gaussian-rate (now 5)") != std::string::npos);
  CHECK(result.standard_error.ends_with("Gaussian units need 0 and 1: give --standardize\n"));
  CHECK(!fs::exists(file));
}

TEST_CASE("fit: data that Gaussian units cannot learn as they are bring a warning") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  const mcdbn::MatrixF noise = random_matrix(60, 3, 1);
  mcdbn::write_matrix(path("usual.csv"), noise);
  mcdbn::write_matrix(path("wide.csv"), mcdbn::MatrixF(30.0F * noise));
  mcdbn::write_matrix(path("px.csv"), mcdbn::MatrixF((600.0F + 30.0F * noise.array()).matrix()));
  const auto warnings = [&](const std::string& options) {
    const CliResult result = run_cli(
        fmt::format("fit {} --hidden 3 --batch 20 --quiet -o {}", options, path("m.safetensors")));
    CAPTURE(options);
    CHECK(result.exit_code == 0);
    return result.standard_error;
  };
  const auto warns_of = [&](const std::string& options, const std::string& file) {
    const std::string text = warnings(options);
    CAPTURE(text);
    CHECK(text.starts_with(fmt::format("mcdbn-cl: warning: {}: column 1 has mean ", file)));
    CHECK(text.ends_with("give --standardize\n"));
  };
  const std::string rbm = " --machine gaussian-rbm --gaussian-epochs 1";
  warns_of(path("px.csv") + rbm, path("px.csv"));
  warns_of(path("wide.csv") + rbm, path("wide.csv"));
  warns_of(path("wide.csv") + " " + path("usual.csv") + rbm, path("wide.csv") + " and 1 more");
  warns_of(fmt::format("--machine mrbm --modality a={} --modality b={} --gaussian a --gaussian b "
                       "--mrbm-epochs 1",
                       path("usual.csv"), path("px.csv")),
           path("px.csv"));
  CHECK(warnings(path("usual.csv") + rbm).empty());
  CHECK(warnings(path("px.csv") + rbm + " --standardize").empty());
  const std::string learnt = " --gaussian-deviation-rate 1e-6";
  CHECK(warnings(path("wide.csv") + rbm + learnt).empty());
  warns_of(path("px.csv") + rbm + learnt, path("px.csv"));
}

TEST_CASE("fit: flags of settings that the machine has not are refused, settings of a file not") {
  const ScratchFolder folder;
  const std::string file = (folder / "m.safetensors").string();
  const auto refused = [&](const std::string& options, const std::string& words) {
    check_refused(fmt::format("fit -o {} --machine {}", file, options), 2, words);
  };
  const std::string of_gaussian = " is of layers with Gaussian visible units",
                    of_binary = " is of layers with binary visible units";
  refused("rbm x.npy --gaussian-epochs 3", "--machine rbm: --gaussian-epochs" + of_gaussian);
  refused("rbm x.npy --gaussian-persistent", "--gaussian-persistent" + of_gaussian);
  refused("crbm x.npy --binary-rate 0.1", "--binary-rate" + of_binary);
  refused("gaussian-dbn x.npy --widths 4 --binary-rate 0.1", "--binary-rate" + of_binary);
  refused("rbm x.npy --mrbm-epochs 2", "--mrbm-epochs is of MRBMs");
  refused("mrbm --modality a=x.npy --modality b=y.npy --gaussian-rate 0.1",
          "--gaussian-rate" + of_gaussian);
  refused("rbm x.npy --binary-rate-A 0.1", "--binary-rate-A is of layers with history");
  refused("crbm x.npy --gaussian-deviation-rate 0.1",
          "--gaussian-deviation-rate is of Gaussian units without history");
  refused("rbm x.npy --binary-fast-rate 0.1",
          "--binary-fast-rate is of persistent chains, and --binary-persistent is off");
  refused("rbm x.npy --binary-cosine",
          "--binary-cosine is of rates that fall, and --binary-final-rate is 1");
  refused("rbm x.npy --binary-sparsity-target 0.02",
          "--binary-sparsity-target is of the pull to that target, and --binary-sparsity-strength "
          "is 0");
  const std::string mrbm = "mrbm --modality a=x.npy --modality b=y.npy ";
  const std::string no_chains =
      " is of Gibbs chains, and --mrbm-joint-likelihood and --mrbm-perceptron-loss are off";
  refused(mrbm + "--mrbm-gibbs-steps 20", "--mrbm-gibbs-steps" + no_chains);
  refused(mrbm + "--mrbm-sample-visible", "--mrbm-sample-visible" + no_chains);
  for (const char* rule : {"", "--mrbm-perceptron-loss "})
    refused(mrbm + rule + "--mrbm-persistent",
            "--mrbm-persistent is of the joint likelihood's chains, and --mrbm-joint-likelihood "
            "is off");
  for (const std::string rule : {"--mrbm-joint-likelihood", "--mrbm-perceptron-loss"})
    refused(mrbm + rule + " --mrbm-mean-field-steps 50",
            fmt::format("--mrbm-mean-field-steps is of multi-prediction, and {} is on", rule));
  refused(mrbm + "--mrbm-joint-likelihood --mrbm-perceptron-loss",
          "--mrbm-perceptron-loss is another rule than --mrbm-joint-likelihood, which is on");
  CHECK(!fs::exists(file));
  if (!have_device()) return;
  const fs::path settings =
      folder.write("fit.toml",
                   "[binary]\nepochs = 2\nfast-rate = 0.1\ncosine = true\nsparsity-target = 0.02\n"
                   "[gaussian]\nrate = 0.1\n[mrbm]\nepochs = 2\n");
  output_of(fmt::format("fit {} --machine rbm --hidden 3 --quiet --config {} -o {}",
                        FittedMachines::instance().bits(), settings.string(), file));
  // A switch that is off, and what the others give an effect.
  output_of(
      fmt::format("fit --machine mrbm --modality a={0} --modality b={0} --hidden 3 --quiet "
                  "--mrbm-epochs 1 --mrbm-joint-likelihood --no-mrbm-perceptron-loss "
                  "--mrbm-persistent --mrbm-gibbs-steps 2 -o {1}",
                  FittedMachines::instance().bits(), file));
}

}  // namespace fit_checks_test
