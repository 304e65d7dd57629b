// sample, score and transform: what they make of a fitted machine, and what each option changes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/text_file.hpp"
#include "fitted_machines.hpp"
#include "library_calls.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "mcdbn/machines/energy.hpp"
#include "mcdbn/machines/partition.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using mcdbn::MatrixF;
using mcdbn::read_matrix;
using mcdbn::Sequences;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

Sequences on_device(const std::vector<MatrixF>& clips) {
  return Sequences::from_host(usual_device(), clips);
}

/// The rows of two clips from `first` on.
MatrixF rows_of(const Sequences& two, Eigen::Index first) {
  const auto clips = two.to_host();
  const Eigen::Index count = clips[0].rows() - first;
  MatrixF rows(2 * count, clips[0].cols());
  rows << clips[0].bottomRows(count), clips[1].bottomRows(count);
  return rows;
}

mcdbn::Cdbn stack_of(const mcdbn::SavedMachine& saved) {
  if (const auto* stack = std::get_if<mcdbn::Cdbn>(&saved.machine)) return *stack;
  return {{std::get<mcdbn::Crbm>(saved.machine)}};
}

json parsed(const std::string& call) {
  return json::parse(output_of(call));
}

/// An MRBM of three modalities, the second one scaled, in a file, and 60 rows of each.
class MrbmFiles {
 public:
  const mcdbn::Mrbm& mrbm() const { return std::get<mcdbn::Mrbm>(saved.machine); }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string model() const { return file("m.safetensors"); }
  std::string modality(const std::string& name) const {
    return " --modality " + name + "=" + file(name + ".npy");
  }

 private:
  mcdbn::SavedMachine written() const {
    const FittedMachines& machines = FittedMachines::instance();
    const MatrixF bits = read_matrix(machines.bits()), values = read_matrix(machines.values());
    mcdbn::write_matrix(file("a.npy"), bits.leftCols(2));
    mcdbn::write_matrix(file("v.npy"), values);
    mcdbn::write_matrix(file("b.npy"), bits.rightCols(3));
    const auto random = mcdbn::MrbmParameters::random(
        {{{"a", 2}, {"v", 5, mcdbn::VisibleKind::gaussian}, {"b", 3}}, 4}, 1.0, {7});
    const mcdbn::SavedMachine made{mcdbn::Mrbm(usual_device(), random),
                                   {{}, mcdbn::ColumnScale::of(std::vector{values}), {}}};
    mcdbn::save_machine(model(), made);
    return made;
  }

  ScratchFolder folder_;

 public:
  const mcdbn::SavedMachine saved = written();
  /// The rows as the machine sees them.
  const std::vector<MatrixF> seen = {read_matrix(file("a.npy")),
                                     saved.scales[1].apply(read_matrix(file("v.npy"))),
                                     read_matrix(file("b.npy"))};
};

}  // namespace

TEST_CASE("transform: the hidden probabilities, and the reconstruction in the data's own units") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  for (const std::string kind : {"rbm", "crbm", "cdbn"}) {
    CAPTURE(kind);
    const auto saved = loaded(machines.model(kind));
    MatrixF data = read_matrix(machines.data_of(kind));
    if (!saved.scales.empty()) data = saved.scales[0].apply(data);
    const mcdbn::Cdbn stack = stack_of(saved);
    const auto history = static_cast<Eigen::Index>(stack.total_order());
    const Sequences twice = on_device({data, data});
    const std::string call = fmt::format("transform --quiet --model {0} {1} {1}",
                                         machines.model(kind), machines.data_of(kind));
    CHECK(printed(call) == rows_of(stack.up_pass(twice), history));
    const std::size_t steps = kind == "cdbn" ? 3 : 1;
    const MatrixF again = rows_of(mcdbn::reconstruct(stack, twice, steps), history);
    CHECK(printed(fmt::format("{} --inverse --steps {}", call, steps)) ==
          (saved.scales.empty() ? again : saved.scales[0].undo(again)));
  }
}

TEST_CASE("transform: every option changes what its help describes") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const std::string use = "transform --model " + machines.model("crbm");
  const std::string call = use + " " + machines.values();
  std::vector<OptionRow> rows = refused_device_rows(call);
  rows.push_back({"--model", [&] {
                    check_refused("transform --model absent.safetensors x.npy", 3, "absent");
                  }});
  rows.push_back({"data", [&] {
                    const std::string wide = folder.write("wide.csv", "1,2\n").string();
                    check_refused(use + " " + wide, 3,
                                  "2 columns; the machine has 5 visible units");
                  }});
  const CliResult plain = run_cli(call);
  const MatrixF code = read_matrix(folder.write("plain.csv", plain.standard_output));
  rows.push_back({"--output", [&] {
                    const std::string file = (folder / "code.npy").string();
                    CHECK(output_of(call + " -o " + file).empty());
                    CHECK(read_matrix(file) == code);
                    check_refused(call + " -o code.txt", 2, "--output code.txt");
                  }});
  rows.push_back({"--quiet", [&] {
                    CHECK(plain.standard_error.find("the first 2 rows of each file are history") !=
                          std::string::npos);
                    CHECK(run_cli(call + " --quiet").standard_error.empty());
                  }});
  rows.push_back({"--tensor", [&] { check_refused(call + " --tensor", 2, "--tensor"); }});
  // What these do has a test case of its own.
  rows.push_back({"--inverse", [] {}});
  rows.push_back({"--modality", [] {}});  // that of MRBMs in fit_test.cpp
  rows.push_back({"--infer", [&] {
                    check_refused(use + " --infer x", 3, "no MRBM");
                    check_refused(call + " --infer x", 2, "data: --infer takes what --modality");
                    check_refused(use + " --infer x --inverse", 2, "--inverse excludes --infer");
                  }});
  rows.push_back({"--steps", [&] { check_refused(call + " --steps 2", 2, "--inverse"); }});
  check_options("transform", rows);
}

TEST_CASE("score: what it prints is the library's, row by row in its file") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const std::string file = (folder / "rows.npy").string();
  const json report =
      parsed(fmt::format("score --model {} {} --json --seed 4 --log-partition --chains 50 "
                         "--temperatures 20 -o {}",
                         machines.model("rbm"), machines.bits(), file));
  const auto rbm = std::get<mcdbn::Crbm>(loaded(machines.model("rbm")).machine);
  const Sequences data = on_device({read_matrix(machines.bits())});
  const MatrixF energy = mcdbn::free_energy(rbm, data).values.to_host(),
                pseudo = mcdbn::pseudo_log_likelihood(rbm, data, 4).values.to_host(),
                again = mcdbn::reconstruct(rbm, data).values.to_host();
  const auto partition = mcdbn::log_partition(rbm, {.temperatures = 20, .chains = 50, .seed = 4});
  const MatrixF errors = (again - data.values.to_host()).cwiseAbs2().rowwise().mean();
  const double log_likelihood = -energy.cast<double>().mean() - partition.value;
  const MatrixF table = read_matrix(file);
  REQUIRE(table.rows() == 60);
  REQUIRE(table.cols() == 4);
  CHECK(table.col(0) == energy.col(0));
  CHECK((table.col(1) - errors).cwiseAbs().maxCoeff() < 1e-6F);
  CHECK(table.col(2) == pseudo.col(0));
  CHECK(table.cast<double>().col(3).mean() == doctest::Approx(log_likelihood));
  CHECK(report.at("rows") == 60);
  CHECK(report.at("log_partition") == partition.value);
  CHECK(report.at("log_partition_error") == partition.standard_error);
  CHECK(report.at("free_energy") == doctest::Approx(energy.cast<double>().mean()));
  CHECK(report.at("reconstruction_error") == doctest::Approx(errors.mean()));
  CHECK(report.at("pseudo_log_likelihood") == doctest::Approx(pseudo.cast<double>().mean()));
  CHECK(report.at("log_likelihood") == doctest::Approx(log_likelihood));
}

TEST_CASE("score: the log-likelihood of scaled data is that of the data as they are") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const std::string model = machines.model("gaussian-rbm");
  const json report = parsed(fmt::format("score --model {} {} --json --log-partition --chains 9",
                                         model, machines.values()));
  const double scale = loaded(model).scales[0].deviation.cast<double>().array().log().sum();
  CHECK(scale > 1.0);
  CHECK(report.at("log_likelihood").get<double>() ==
        doctest::Approx(-report.at("free_energy").get<double>() -
                        report.at("log_partition").get<double>() - scale));
  CHECK_FALSE(report.contains("pseudo_log_likelihood"));
}

TEST_CASE("score: the log-likelihood of a machine that learnt deviations counts them") {
  if (!have_device()) return;
  const ScratchFolder folder;
  mcdbn::CrbmParameters apart;  // columns that hang together with nothing are normal
  apart.shape = {3, 2, 0, mcdbn::VisibleKind::gaussian};
  apart.W = MatrixF::Zero(3, 2);
  apart.A = MatrixF::Zero(0, 3);
  apart.B = MatrixF::Zero(0, 2);
  apart.a = MatrixF::Zero(1, 3);
  apart.b = MatrixF::Zero(1, 2);
  apart.visible_mean = MatrixF::Zero(1, 3);
  apart.visible_deviation.resize(1, 3);
  apart.visible_deviation << 3.0F, 0.5F, 2.0F;
  const std::string model = (folder / "machine.safetensors").string();
  mcdbn::save_machine(model, {mcdbn::Crbm(usual_device(), apart), {}});
  MatrixF data(2, 3);
  data << 3, 1, -2, 0, 0.5, 1;
  mcdbn::write_matrix(folder / "data.npy", data);
  double expected = 0;
  for (Eigen::Index r = 0; r < 2; ++r)
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double sd = apart.visible_deviation(0, c), u = data(r, c) / sd;
      expected -= (u * u / 2 + std::log(sd) + 0.5 * std::log(2 * M_PI)) / 2;
    }
  const json report = parsed(fmt::format("score --model {} {} --json --log-partition", model,
                                         (folder / "data.npy").string()));
  CHECK(report.at("log_likelihood").get<double>() == doctest::Approx(expected).epsilon(1e-4));
}

TEST_CASE("score and transform: what a machine cannot take is refused as fit refuses it") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  MatrixF data = read_matrix(machines.bits());
  const std::string file = (folder / "data.npy").string();
  for (const auto& [value, words] :
       {std::pair{NAN, "row 2, column 1 is nan"}, std::pair{2.0F, "binary units need"}}) {
    data(1, 0) = value;
    mcdbn::write_matrix(file, data);
    for (const char* command : {"score", "transform"})
      check_refused(fmt::format("{} --model {} {}", command, machines.model("rbm"), file), 3,
                    words);
  }
}

TEST_CASE("score: an MRBM's free energy of all modalities, and each one's reconstruction") {
  if (!have_device()) return;
  const MrbmFiles files;
  const std::string call = "score --model " + files.model(), out = files.file("rows.npy");
  // In another order than the machine's.
  const json report = parsed(call + files.modality("b") + files.modality("v") +
                             files.modality("a") + " --json -o " + out);
  std::vector<mcdbn::Matrix> units;
  for (const MatrixF& values : files.seen)
    units.push_back(mcdbn::Matrix::from_host(usual_device(), values));
  const std::vector<mcdbn::Rows> rows(units.begin(), units.end());
  const MatrixF energy = mcdbn::free_energy(files.mrbm(), rows).to_host(), table = read_matrix(out);
  const auto again = mcdbn::reconstruct(files.mrbm(), rows);
  REQUIRE(table.rows() == 60);
  REQUIRE(table.cols() == 4);
  CHECK(table.col(0) == energy.col(0));
  CHECK(report.size() == 5);
  CHECK(report.at("rows") == 60);
  CHECK(report.at("free_energy") == doctest::Approx(energy.cast<double>().mean()));
  for (Eigen::Index m = 0; m < 3; ++m) {
    const auto i = static_cast<std::size_t>(m);
    const MatrixF errors = (again[i].to_host() - files.seen[i]).cwiseAbs2().rowwise().mean();
    CHECK((table.col(m + 1) - errors).cwiseAbs().maxCoeff() < 1e-6F);
    CHECK(report.at("reconstruction_error_" + files.mrbm().shape().modalities[i].name) ==
          doctest::Approx(errors.mean()));
  }
  check_refused(call + files.modality("a") + files.modality("v"), 2, "--modality b=FILE: wanted");
  check_refused(call + " x.npy", 2, "data: those of an MRBM");
  check_refused(call + files.modality("a") + " --log-partition", 2, "an MRBM has none");
}

TEST_CASE("score: every option changes what its help describes") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const std::string call = "score --model " + machines.model("rbm") + " " + machines.bits();
  std::vector<OptionRow> rows = refused_device_rows(call);
  rows.push_back({"--model", [&] { check_refused("score x.npy", 2, "--model"); }});
  rows.push_back(
      {"data", [&] { CHECK(parsed(call + " " + machines.bits() + " --json").at("rows") == 120); }});
  rows.push_back({"--tensor", [&] { check_refused(call + " --tensor", 2, "--tensor"); }});
  rows.push_back({"--log-partition", [&] {
                    const std::string other = "score --log-partition --model ";
                    check_refused(other + machines.model("cdbn") + " " + machines.values(), 2,
                                  "--log-partition: a stack");
                    check_refused(other + machines.model("crbm") + " " + machines.values(), 2,
                                  "--log-partition: a machine with a history");
                  }});
  rows.push_back({"--modality", [&] {
                    check_refused(call + " --modality a=" + machines.bits(), 3, "no MRBM");
                    check_refused("score --model " + machines.model("rbm"), 2, "data: no files");
                  }});
  // What these do is compared with the library's own numbers above.
  for (const char* option : {"--temperatures", "--chains", "--seed"})
    rows.push_back({option, [] {}});
  rows.push_back(
      {"--output", [&] { check_refused(call + " -o rows.txt", 2, "--output rows.txt"); }});
  rows.push_back({"--json", [&] {
                    const std::string text = output_of(call);
                    CHECK(text.starts_with("rows                    60\nfree_energy"));
                    CHECK(text.find("log_partition") == std::string::npos);
                    const std::string many = (folder / "many.npy").string();
                    mcdbn::write_matrix(many, MatrixF::Zero(1'000'000, 5));
                    CHECK(output_of("score --model " + machines.model("rbm") + " " + many)
                              .starts_with("rows                    1000000\n"));
                  }});
  rows.push_back({"--quiet", [&] { CHECK(output_of(call + " --quiet") == output_of(call)); }});
  check_options("score", rows);
}

TEST_CASE("sample: free chains and what is given, in the data's own units") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const auto rbm = std::get<mcdbn::Crbm>(loaded(machines.model("rbm")).machine);
  const auto start = mcdbn::Matrix::filled_with_row(rbm.visible_mean, 9);
  CHECK(printed(fmt::format("sample --quiet --model {} --count 9 --steps 5 --seed 3 --means",
                            machines.model("rbm"))) ==
        mcdbn::sample(rbm, start, {.steps = 5, .seed = 3, .means = true}).to_host());

  // A CRBM goes on from rows of its data.
  constexpr Eigen::Index kRows = 40;
  const MatrixF data = read_matrix(machines.values());
  MatrixF given = data.topRows(kRows);
  given.bottomRows(2).setConstant(std::numeric_limits<float>::quiet_NaN());
  given(kRows - 1, 1) = data(kRows - 1, 1);
  const ScratchFolder folder;
  const std::string file = (folder / "given.csv").string();
  mcdbn::write_matrix(file, given);
  const auto saved = loaded(machines.model("crbm"));
  const MatrixF scaled = saved.scales[0].apply(given);
  const auto want = mcdbn::sample_given(std::get<mcdbn::Crbm>(saved.machine),
                                        on_device({scaled, scaled}), {.steps = 5, .seed = 3});
  const MatrixF got =
      printed(fmt::format("sample --quiet --model {} --given {} --count 2 --steps 5 --seed 3",
                          machines.model("crbm"), file));
  // What is given comes back as it was, to the last bit.
  const MatrixF twice = given.replicate(2, 1), drawn = saved.scales[0].undo(want.values.to_host());
  const MatrixF expected = twice.array().isNaN().select(drawn, twice);
  CHECK(got == expected);
  CHECK(got.row(kRows - 2) != got.row(2 * kRows - 2));
}

TEST_CASE("sample: a modality of an MRBM, free or with others given, in its own units") {
  if (!have_device()) return;
  const MrbmFiles files;
  auto& device = usual_device();
  const std::string call = "sample --quiet --model " + files.model();
  const std::vector<mcdbn::Matrix> none(3, mcdbn::Matrix(device, 1, 1));
  const auto free = mcdbn::sample(files.mrbm(), none, {false, false, false}, 9,
                                  {.steps = 3, .seed = 4, .means = true});
  CHECK(printed(call + " --infer v --count 9 --steps 3 --seed 4 --means") ==
        files.saved.scales[1].undo(free[1].to_host()));

  std::vector<mcdbn::Matrix> given = none;
  given[1] = mcdbn::Matrix::from_host(device, files.seen[1].replicate(2, 1));
  const auto drawn =
      mcdbn::sample(files.mrbm(), given, {false, true, false}, 120, {.steps = 3, .seed = 5});
  const MatrixF got =
      printed(call + files.modality("v") + " --infer b --count 2 --steps 3 --seed 5");
  CHECK(got == drawn[2].to_host());
  CHECK(got.topRows(60) != got.bottomRows(60));

  MatrixF holes = files.seen[0];
  holes(7, 1) = std::numeric_limits<float>::quiet_NaN();
  mcdbn::write_matrix(files.file("holes.npy"), holes);
  check_refused(call, 2, "--infer: wanted by an MRBM");
  check_refused(call + files.modality("v") + " --infer v", 2, "--infer v: it is given");
  check_refused(call + " --infer v --given " + files.file("v.npy"), 2,
                "--given: what is known of an MRBM");
  check_refused(call + " --infer v --modality a=" + files.file("holes.npy"), 3,
                "holes.npy: row 8, column 2 is nan; numbers are needed throughout");
}

TEST_CASE("sample: every option changes what its help describes") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const std::string use = "sample --model " + machines.model("rbm");
  const std::string call = use + " --count 20 --steps 5";
  const CliResult plain = run_cli(call);
  std::vector<OptionRow> rows = refused_device_rows(call);
  rows.push_back({"--model", [&] { check_refused("sample", 2, "--model"); }});
  rows.push_back({"--tensor", [&] { check_refused(call + " --tensor", 2, "--tensor"); }});
  rows.push_back({"--given", [&] {
                    check_refused("sample --model " + machines.model("crbm"), 2, "--given: wanted");
                  }});
  rows.push_back({"--count", [&] {
                    CHECK(count_lines(plain.standard_output) == 20);
                    check_refused(use + " --count 0", 2, "--count");
                  }});
  for (const std::string option : {"--modality", "--infer"})
    rows.push_back({option, [&call, option] {
                      check_refused(call + " " + option + " a=b", 3, "no MRBM; --modality and");
                    }});
  // What these do is compared with the library's own draws above.
  for (const char* option : {"--steps", "--seed", "--means"}) rows.push_back({option, [] {}});
  rows.push_back(
      {"--no-means", [&] { CHECK(output_of(call + " --no-means") == plain.standard_output); }});
  rows.push_back({"--output", [&] {
                    const std::string file = (folder / "x.csv").string();
                    CHECK(output_of(call + " -o " + file).empty());
                    CHECK(mcdbn::read_text_file(file) == plain.standard_output);
                    check_refused(call + " -o x.txt", 2, "--output x.txt");
                  }});
  rows.push_back({"--quiet", [&] {
                    CHECK(plain.standard_error.find("20 chains of 5 steps") != std::string::npos);
                    CHECK(run_cli(call + " --quiet").standard_error.empty());
                  }});
  check_options("sample", rows);
}

TEST_CASE("NumPy reads what is written and writes what is read") {
  const fs::path python = MCDBN_PYTHON;
  if (!fs::exists(python)) {
    MESSAGE("SKIPPED NumPy: scripts/install_dependencies --test installs it");
    return;
  }
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const fs::path script = folder.write(
      "numpy_files.py",
      fmt::format("import os, numpy\n"
                  "bits = numpy.load('{}')\n"
                  "assert bits.dtype == numpy.float32 and bits.shape == (60, 5)\n"
                  "assert set(bits.flat) == {{0, 1}}\n"
                  "os.chdir('{}')\n"
                  "numpy.save('columns.npy', numpy.asfortranarray(bits.astype(numpy.float64)))\n"
                  "numpy.save('bool.npy', bits.astype(bool))\n"
                  "numpy.save('int.npy', bits.astype(numpy.int64))\n"
                  "numpy.savetxt('text.csv', bits, delimiter=',', header='a,b,c,d,e')\n",
                  machines.bits(), folder.write("at", "").parent_path().string()));
  const CliResult ran = run_program(python, script.string());
  CAPTURE(ran.standard_error);
  REQUIRE(ran.exit_code == 0);
  for (const char* name : {"columns.npy", "bool.npy", "int.npy", "text.csv"}) {
    CAPTURE(name);
    CHECK(read_matrix(folder / name) == read_matrix(machines.bits()));
  }
}
