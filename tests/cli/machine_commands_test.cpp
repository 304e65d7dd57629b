// fit, sample, score and transform: what they do with data, and what each option changes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/random_matrix.hpp"
#include "base/text_file.hpp"
#include "library_calls.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "mcdbn/machines/energy.hpp"
#include "mcdbn/machines/machine_file.hpp"
#include "mcdbn/machines/partition.hpp"
#include "mcdbn/machines/sampling.hpp"
#include "option_table.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using mcdbn::MatrixF;
using mcdbn::read_matrix;
using mcdbn::Sequences;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string kShort = " --hidden 5 --batch 20 --gaussian-epochs 2 --binary-epochs 2 --quiet";

/// Data of both kinds in files, and machines that were fitted to them, made once for all tests.
class Machines {
 public:
  static const Machines& instance() {
    static const Machines machines;
    return machines;
  }
  /// The file of a machine of that kind, each fitted when it is first asked for.
  std::string model(const std::string& kind) const {
    const fs::path file = folder_ / (kind + ".safetensors");
    if (!fs::exists(file)) fit(kind, file);
    return file.string();
  }
  std::string bits() const { return (folder_ / "bits.npy").string(); }
  std::string values() const { return (folder_ / "values.csv").string(); }
  std::string data_of(const std::string& kind) const {
    const bool binary = kind == "rbm" || kind == "dbn" || kind.starts_with("binary");
    return binary ? bits() : values();
  }
  fs::path file(const std::string& name) const { return folder_ / name; }

 private:
  Machines() {
    const MatrixF noise = random_matrix(60, 5, 1);
    mcdbn::write_matrix(bits(), (noise.array() > 0.2F).cast<float>());
    // Columns of other sizes, so that scaling matters.
    MatrixF scaled = noise;
    for (Eigen::Index c = 0; c < 5; ++c)
      scaled.col(c) =
          (10.0F * static_cast<float>(c) + (1.0F + static_cast<float>(c)) * noise.col(c).array())
              .matrix();
    mcdbn::write_matrix(values(), scaled);
  }
  void fit(const std::string& kind, const fs::path& file) const {
    std::string options = kShort;
    if (kind.find("crbm") != std::string::npos || kind.find("cdbn") != std::string::npos)
      options += " --order 2";
    if (data_of(kind) == values()) options += " --standardize";
    const CliResult result = run_cli(
        fmt::format("fit {} --machine {} -o {} {}", data_of(kind), kind, file.string(), options));
    CAPTURE(result.standard_error);
    REQUIRE(result.exit_code == 0);
    REQUIRE(result.standard_output.empty());
  }

  ScratchFolder folder_;
};

/// Runs a command that works. @return its standard output
std::string output_of(const std::string& call) {
  const CliResult result = run_cli(call);
  CAPTURE(call);
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  return result.standard_output;
}

void check_refused(const std::string& call, int exit_code, const std::string& words) {
  const CliResult result = run_cli(call);
  CAPTURE(call);
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == exit_code);
  CHECK(result.standard_output.empty());
  CHECK(count_lines(result.standard_error) == 1);
  CHECK(result.standard_error.find(words) != std::string::npos);
}

/// A matrix that a command printed as CSV.
MatrixF printed(const std::string& call) {
  const ScratchFolder folder;
  return read_matrix(folder.write("printed.csv", output_of(call)));
}

mcdbn::SavedMachine loaded(const std::string& file) {
  return mcdbn::load_machine(usual_device(), file);
}

Sequences on_device(const std::vector<MatrixF>& clips) {
  return Sequences::from_host(usual_device(), clips);
}

const char* const kKinds[] = {"rbm", "gaussian-rbm", "crbm", "binary-crbm",
                              "dbn", "gaussian-dbn", "cdbn", "binary-cdbn"};

}  // namespace

TEST_CASE("fit: every kind of machine, its sizes, its metrics") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  for (const std::string kind : kKinds) {
    CAPTURE(kind);
    const json about = json::parse(output_of("info --json " + machines.model(kind)));
    const bool is_stack = kind.find("dbn") != std::string::npos,
               has_history =
                   kind.find("crbm") != std::string::npos || kind.find("cdbn") != std::string::npos,
               is_binary = machines.data_of(kind) == machines.bits();
    CHECK(about.at("kind") == (is_stack ? "cdbn" : "crbm"));
    CHECK(about.at("config").at("machine") == kind);
    CHECK(about.at("standardized") == !is_binary);
    REQUIRE(about.at("layers").size() == (is_stack ? 2 : 1));
    const json& lowest = about.at("layers").at(0);
    CHECK(lowest.at("kind") == (is_binary ? "binary" : "gaussian"));
    CHECK(lowest.at("visible") == 5);
    CHECK(lowest.at("hidden") == 5);
    CHECK(lowest.at("order") == (has_history ? 2 : 0));
    fs::path metrics = machines.model(kind);
    const std::string lines = mcdbn::read_text_file(metrics.replace_extension(".metrics.jsonl"));
    CHECK(count_lines(lines) == (is_stack ? 4 : 2));
    const json first = json::parse(lines.substr(0, lines.find('\n')));
    CHECK(first.at("stage") == "layer.0");
    CHECK(first.at("loss").is_number());
    CHECK(first.at("weight_norm").is_number());
  }
}

TEST_CASE("fit: every option changes what its help says") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  const ScratchFolder folder;
  const fs::path file = folder / "m.safetensors";
  const auto model = [&] { return mcdbn::read_text_file(file); };
  const std::string call =
      fmt::format("fit {} --machine crbm -o {}{}", machines.values(), file.string(), kShort);
  // Every setting in one run, and what the file says of it.
  const std::vector<std::pair<std::string, double>> settings = {
      {"seed", 7}, {"order", 2}, {"hidden", 9}, {"layers", 3}, {"batch", 13}, {"least-batches", 5}};
  std::vector<std::pair<std::string, double>> rules;
  for (const std::string group : {"gaussian", "binary"})
    for (const auto& [name, value] :
         std::vector<std::pair<std::string, double>>{{"gibbs-steps", 2},
                                                     {"rate", 0.0021},
                                                     {"rate-A", 0.00013},
                                                     {"rate-B", 0.0017},
                                                     {"momentum", 0.55},
                                                     {"momentum-from-epoch", 1},
                                                     {"weight-decay", 0.003},
                                                     {"initial-deviation", 0.02},
                                                     {"epochs", 3}})
      rules.emplace_back(group + "." + name, value);
  rules.insert(rules.end(), settings.begin(), settings.end());
  const auto flag_of = [](std::string name) {
    std::replace(name.begin(), name.end(), '.', '-');
    return "--" + name;
  };
  std::string flags;
  for (const auto& [name, value] : rules) flags += fmt::format(" {} {}", flag_of(name), value);
  output_of(fmt::format("fit {} --machine cdbn -o {} --quiet{}", machines.values(),
                        (folder / "all.safetensors").string(), flags));
  const json recorded =
      json::parse(output_of("info --json " + (folder / "all.safetensors").string()));
  std::vector<OptionRow> rows;
  for (const auto& [name, value] : rules)
    rows.push_back({flag_of(name), [&recorded, name = name, value = value] {
                      std::string pointer = "/config/" + name;
                      std::replace(pointer.begin(), pointer.end(), '.', '/');
                      CHECK(recorded.at(json::json_pointer(pointer)) == value);
                    }});
  CHECK(recorded.at("layers").size() == 3);
  CHECK(recorded.at("layers").at(2).at("order") == 2);
  for (const OptionRow& row : device_rows(call, model)) rows.push_back(row);
  const std::string plain = model();
  rows.push_back({"data", [&] {
                    output_of(fmt::format("fit {0} {0} --machine crbm -o {1}{2}", machines.values(),
                                          file.string(), kShort));
                    CHECK(model() != plain);
                  }});
  rows.push_back({"--tensor", [&] {
                    mcdbn::write_matrix(folder / "d.safetensors", read_matrix(machines.values()),
                                        "x");
                    const std::string by_tensor =
                        fmt::format("fit {} --machine crbm -o {}{} --tensor ",
                                    (folder / "d.safetensors").string(), file.string(), kShort);
                    output_of(by_tensor + "x");
                    CHECK(model() == plain);
                    check_refused(by_tensor + "y", 3, "no tensor y");
                  }});
  rows.push_back({"--machine", [&] { check_refused("fit a.npy -o b --machine other", 2, "rbm"); }});
  rows.push_back({"--output",
                  [&] { check_refused("fit a.npy --machine rbm -o b.npy", 2, "--output b.npy"); }});
  rows.push_back({"--standardize", [&] {
                    output_of(call + " --standardize");
                    const auto saved = loaded(file.string());
                    REQUIRE(saved.scales.size() == 1);
                    CHECK(std::abs(saved.scales[0].mean(4) - 40.0F) < 1.5F);
                    CHECK(loaded(machines.model("rbm")).scales.empty());
                  }});
  rows.push_back(
      {"--quiet", [&] {
         const std::string loud = call.substr(0, call.size() - 8);
         const CliResult result = run_cli(loud);
         CHECK(result.standard_error.find("100 %  layer.0 epoch 2/2") != std::string::npos);
         CHECK(result.standard_error.find("1 files, 60 rows of 5 values") != std::string::npos);
         CHECK(run_cli(call).standard_error.empty());
         CHECK(model() == plain);
       }});
  check_options("fit", rows);
}

TEST_CASE("fit: data and flags that do not fit are refused") {
  const ScratchFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  folder.write("bits.csv", "a,b\n0,1\n1,0\n1,1\n");
  folder.write("wide.csv", "0,1,1\n");
  folder.write("holes.csv", "0,1\n,1\n");
  folder.write("odd.csv", "0,1\n1,x\n");
  folder.write("large.csv", "0,1\n1,2.5\n");
  const std::string out = " -o " + path("m.safetensors") + " ";
  check_refused("fit " + path("odd.csv") + out + "--machine rbm", 3, "odd.csv:2: 'x' in column 2");
  check_refused("fit " + path("bits.csv") + " " + path("wide.csv") + out + "--machine rbm", 3,
                "wide.csv: 3 columns, 2 in");
  check_refused("fit " + path("holes.csv") + out + "--machine rbm", 3,
                "holes.csv: row 2, column 1 is nan");
  check_refused("fit " + path("large.csv") + out + "--machine rbm", 3,
                "large.csv: row 2, column 2 is 2.5; binary units want");
  check_refused("fit " + path("bits.csv") + out + "--machine crbm --order 3", 3,
                "no file has more than 3 rows");
  check_refused("fit " + path("bits.csv") + out + "--machine cdbn --order 2", 3,
                "no file has more than 4 rows");
  check_refused("fit " + path("absent.csv") + out + "--machine rbm", 3, "absent.csv: cannot be");
  check_refused("fit x.txt" + out + "--machine rbm", 3, "x.txt: unknown kind of file");
  check_refused("fit x.npy" + out + "--machine rbm --order 2", 2, "--order: --machine rbm has no");
  check_refused("fit x.npy" + out + "--machine crbm --layers 2", 2, "--layers: --machine crbm has");
  check_refused("fit x.npy" + out + "--machine dbn --standardize", 2, "--standardize: --machine");
  check_refused("fit x.npy" + out + "--machine rbm --binary-rate 0", 2, "--binary-rate must be");
  CHECK(!fs::exists(folder / "m.safetensors"));
}

TEST_CASE("fit: a rate that is too high trips the guard, which says what to lower") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const CliResult result = run_cli(fmt::format(
      "fit {} --machine gaussian-rbm -o {} --gaussian-rate 5 --gaussian-epochs 200 --quiet",
      Machines::instance().values(), (folder / "m.safetensors").string()));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 1);
  CHECK(result.standard_error.find("lower --gaussian-rate (now 5)") != std::string::npos);
  CHECK(!fs::exists(folder / "m.safetensors"));
}

TEST_CASE("transform: the hidden probabilities, and the reconstruction in the data's own units") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  for (const std::string kind : {"rbm", "crbm", "cdbn"}) {
    CAPTURE(kind);
    const auto saved = loaded(machines.model(kind));
    MatrixF data = read_matrix(machines.data_of(kind));
    if (!saved.scales.empty()) data = saved.scales[0].apply(data);
    const mcdbn::Cdbn stack = kind == "cdbn" ? std::get<mcdbn::Cdbn>(saved.machine)
                                             : mcdbn::Cdbn{{std::get<mcdbn::Crbm>(saved.machine)}};
    const Eigen::Index history = kind == "rbm" ? 0 : kind == "crbm" ? 2 : 4;
    const Sequences twice = on_device({data, data});
    const auto rows_of = [&](const Sequences& sequences) {
      MatrixF rows(2 * (60 - history), static_cast<Eigen::Index>(sequences.values.columns()));
      const auto clips = sequences.to_host();
      rows << clips[0].bottomRows(60 - history), clips[1].bottomRows(60 - history);
      return rows;
    };
    const std::string call = fmt::format("transform --quiet --model {} {} {}", machines.model(kind),
                                         machines.data_of(kind), machines.data_of(kind));
    CHECK(printed(call) == rows_of(stack.up_pass(twice)));
    const auto again = [&](std::size_t steps) {
      const MatrixF rows = rows_of(mcdbn::reconstruct(stack, twice, steps));
      return saved.scales.empty() ? rows : saved.scales[0].undo(rows);
    };
    CHECK(printed(call + " --inverse") == again(1));
    CHECK(printed(call + " --inverse --steps 3") == again(3));
    CHECK(again(1) != again(3));
  }
}

TEST_CASE("transform: every option changes what its help says") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  const ScratchFolder folder;
  const std::string npy = (folder / "code.npy").string();
  const std::string call =
      fmt::format("transform --model {} {}", machines.model("crbm"), machines.values());
  std::vector<OptionRow> rows =
      device_rows(call + " -o " + npy, [&] { return mcdbn::read_text_file(npy); });
  rows.push_back({"--model", [&] {
                    check_refused("transform --model absent.safetensors " + machines.bits(), 3,
                                  "absent.safetensors");
                    check_refused("transform --model " + machines.values() + " x.npy", 3,
                                  "not a readable safetensors file");
                  }});
  rows.push_back({"data", [&] {
                    const std::string wide = folder.write("wide.csv", "1,2\n").string();
                    check_refused(
                        fmt::format("transform --model {} {}", machines.model("rbm"), wide), 3,
                        "2 columns; the machine has 5 visible units");
                  }});
  rows.push_back({"--output", [&] {
                    for (const char* name : {"code.csv", "code.npy", "code.safetensors"}) {
                      const std::string file = (folder / name).string();
                      CHECK(output_of(call + " --quiet -o " + file).empty());
                      CHECK(read_matrix(file) == printed(call + " --quiet"));
                    }
                    check_refused(call + " -o code.txt", 2, "--output code.txt");
                  }});
  rows.push_back({"--quiet", [&] {
                    CHECK(run_cli(call).standard_error.find("the first 2 rows of each file") !=
                          std::string::npos);
                    CHECK(run_cli(call + " --quiet").standard_error.empty());
                  }});
  rows.push_back({"--tensor", [&] { check_refused(call + " --tensor", 2, "--tensor"); }});
  // What these do has a test case of its own.
  rows.push_back({"--inverse", [] {}});
  rows.push_back({"--steps", [&] { CHECK(run_cli(call + " --steps 2").exit_code == 2); }});
  check_options("transform", rows);
}

TEST_CASE("score: what it prints is the library's, row by row in its file") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  const ScratchFolder folder;
  const std::string file = (folder / "rows.npy").string();
  const std::string call =
      fmt::format("score --model {} {} --json", machines.model("rbm"), machines.bits());
  const json report = json::parse(output_of(call +
                                            " --seed 4 --log-partition --chains 50 "
                                            "--temperatures 20 -o " +
                                            file));
  const auto rbm = std::get<mcdbn::Crbm>(loaded(machines.model("rbm")).machine);
  const Sequences data = on_device({read_matrix(machines.bits())});
  const MatrixF energy = mcdbn::free_energy(rbm, data).values.to_host(),
                pseudo = mcdbn::pseudo_log_likelihood(rbm, data, 4).values.to_host(),
                again = mcdbn::reconstruct(rbm, data).values.to_host();
  const auto partition = mcdbn::log_partition(rbm, {.temperatures = 20, .chains = 50, .seed = 4});
  const MatrixF table = read_matrix(file);
  REQUIRE(table.rows() == 60);
  REQUIRE(table.cols() == 4);
  CHECK(table.col(0) == energy.col(0));
  CHECK(table.col(2) == pseudo.col(0));
  const MatrixF errors = (again - data.values.to_host()).cwiseAbs2().rowwise().mean();
  CHECK((table.col(1) - errors).cwiseAbs().maxCoeff() < 1e-6F);
  CHECK(report.at("rows") == 60);
  CHECK(report.at("log_partition") == partition.value);
  CHECK(report.at("log_partition_error") == partition.standard_error);
  CHECK(report.at("free_energy") == doctest::Approx(energy.cast<double>().mean()));
  CHECK(report.at("reconstruction_error") == doctest::Approx(errors.mean()));
  CHECK(report.at("pseudo_log_likelihood") == doctest::Approx(pseudo.cast<double>().mean()));
  CHECK(report.at("log_likelihood") ==
        doctest::Approx(-energy.cast<double>().mean() - partition.value));
}

TEST_CASE("score: the log-likelihood of scaled data is that of the data as they are") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  const std::string model = machines.model("gaussian-rbm");
  const json report = json::parse(output_of(
      fmt::format("score --model {} {} --json --log-partition", model, machines.values())));
  const auto saved = loaded(model);
  const double scale = saved.scales[0].deviation.cast<double>().array().log().sum();
  CHECK(scale > 1.0);
  CHECK(report.at("log_likelihood").get<double>() ==
        doctest::Approx(-report.at("free_energy").get<double>() -
                        report.at("log_partition").get<double>() - scale));
  CHECK_FALSE(report.contains("pseudo_log_likelihood"));
}

TEST_CASE("score: every option changes what its help says") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  const ScratchFolder folder;
  const std::string call =
      fmt::format("score --model {} {}", machines.model("rbm"), machines.bits());
  const std::string file = (folder / "rows.csv").string();
  std::vector<OptionRow> rows =
      device_rows(call + " -o " + file, [&] { return mcdbn::read_text_file(file); });
  const auto changes = [&](const std::string& option, const char* name) {
    return [&, option, name] {
      const std::string with = call + " --json --log-partition ";
      CHECK(json::parse(output_of(with)).at(name) !=
            json::parse(output_of(with + option)).at(name));
    };
  };
  rows.push_back({"--model", [&] { check_refused("score x.npy", 2, "--model"); }});
  rows.push_back({"data", [&] {
                    check_refused("score --model " + machines.model("rbm"), 2, "data");
                    const json two =
                        json::parse(output_of(call + " " + machines.bits() + " --json"));
                    CHECK(two.at("rows") == 120);
                  }});
  rows.push_back({"--tensor", [&] { check_refused(call + " --tensor", 2, "--tensor"); }});
  rows.push_back({"--log-partition", [&] {
                    CHECK_FALSE(json::parse(output_of(call + " --json")).contains("log_partition"));
                    const std::string stack = "score --log-partition --model ";
                    check_refused(stack + machines.model("dbn") + " " + machines.bits(), 2,
                                  "--log-partition: a stack");
                    check_refused(stack + machines.model("crbm") + " " + machines.values(), 2,
                                  "--log-partition: a machine with a history");
                  }});
  rows.push_back({"--temperatures", changes("--temperatures 3", "log_partition")});
  rows.push_back({"--chains", changes("--chains 7", "log_partition")});
  rows.push_back({"--seed", changes("--seed 2", "pseudo_log_likelihood")});
  rows.push_back({"--output", [&] {
                    output_of(call + " -o " + file);
                    CHECK(read_matrix(file).cols() == 3);
                    check_refused(call + " -o rows.txt", 2, "--output rows.txt");
                  }});
  rows.push_back({"--json", [&] {
                    const std::string text = output_of(call);
                    CHECK(text.starts_with("rows                    60\nfree_energy"));
                    CHECK(json::parse(output_of(call + " --json")).at("rows") == 60);
                  }});
  check_options("score", rows);
}

TEST_CASE("sample: free chains and what is given, in the data's own units") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  const auto rbm = std::get<mcdbn::Crbm>(loaded(machines.model("rbm")).machine);
  const std::string free =
      fmt::format("sample --quiet --model {} --count 9 --steps 5 --seed 3", machines.model("rbm"));
  const auto start = mcdbn::Matrix::filled_with_row(rbm.visible_mean, 9);
  CHECK(printed(free) == mcdbn::sample(rbm, start, {.steps = 5, .seed = 3}).to_host());
  CHECK(printed(free + " --means") ==
        mcdbn::sample(rbm, start, {.steps = 5, .seed = 3, .means = true}).to_host());

  // A CRBM goes on from two rows of its data.
  const MatrixF data = read_matrix(machines.values());
  MatrixF given = data.topRows(4);
  given.bottomRows(2).setConstant(std::numeric_limits<float>::quiet_NaN());
  given(3, 1) = data(3, 1);
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
  CHECK(got == saved.scales[0].undo(want.values.to_host()));
  CHECK(std::abs(got(7, 1) - data(3, 1)) < 1e-4F);
  CHECK(got.row(2) != got.row(6));
}

TEST_CASE("sample: every option changes what its help says") {
  if (!have_device()) return;
  const Machines& machines = Machines::instance();
  const ScratchFolder folder;
  const std::string npy = (folder / "x.npy").string();
  const std::string call = fmt::format("sample --model {} --steps 5", machines.model("rbm"));
  std::vector<OptionRow> rows =
      device_rows(call + " -o " + npy, [&] { return mcdbn::read_text_file(npy); });
  const std::string many = call + " --quiet --count 20";
  const auto changes = [&](const std::string& option) {
    return [&, option] { CHECK(output_of(many) != output_of(many + " " + option)); };
  };
  rows.push_back({"--model", [&] { check_refused("sample", 2, "--model"); }});
  rows.push_back({"--tensor", [&] { check_refused(call + " --tensor", 2, "--tensor"); }});
  rows.push_back({"--given", [&] {
                    check_refused("sample --model " + machines.model("crbm"), 2, "--given: wanted");
                    const std::string wide = folder.write("wide.csv", "1,2\n").string();
                    check_refused(call + " --given " + wide, 3, "2 columns; the machine has 5");
                  }});
  rows.push_back({"--count", [&] {
                    CHECK(count_lines(output_of(many)) == 20);
                    check_refused(call + " --count 0", 2, "--count");
                  }});
  rows.push_back({"--steps", [&] {
                    CHECK(output_of(many) !=
                          output_of(fmt::format("sample --quiet --model {} --count 20 --steps 6",
                                                machines.model("rbm"))));
                  }});
  rows.push_back({"--seed", changes("--seed 2")});
  rows.push_back({"--means", changes("--means")});
  rows.push_back(
      {"--no-means", [&] { CHECK(output_of(many) == output_of(many + " --no-means")); }});
  rows.push_back({"--output", [&] {
                    CHECK(output_of(many + " -o " + npy).empty());
                    CHECK(read_matrix(npy) == printed(many));
                    check_refused(call + " -o x.txt", 2, "--output x.txt");
                  }});
  rows.push_back({"--quiet", [&] {
                    CHECK(run_cli(call).standard_error.find("1 chains of 5 steps") !=
                          std::string::npos);
                    CHECK(run_cli(many).standard_error.empty());
                  }});
  check_options("sample", rows);
}

TEST_CASE("NumPy reads what is written and writes what is read") {
  if (!have_device()) return;
  const fs::path python = MCDBN_PYTHON;
  if (!fs::exists(python)) {
    MESSAGE("SKIPPED NumPy: scripts/install_dependencies --test installs it");
    return;
  }
  const Machines& machines = Machines::instance();
  const ScratchFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  const std::string code = fmt::format("transform --quiet --model {} ", machines.model("rbm"));
  output_of(code + machines.bits() + " -o " + path("code.npy"));
  const fs::path script = folder.write(
      "numpy_files.py",
      fmt::format("import numpy\n"
                  "bits, code = numpy.load('{}'), numpy.load('{}')\n"
                  "assert bits.dtype == code.dtype == numpy.float32\n"
                  "assert bits.shape == (60, 5) and code.shape == (60, 5)\n"
                  "assert ((code > 0) & (code < 1)).all() and set(bits.flat) == {{0, 1}}\n"
                  "numpy.save('{}', numpy.asfortranarray(bits.astype(numpy.float64)))\n"
                  "numpy.save('{}', bits.astype(bool))\n"
                  "numpy.save('{}', bits.astype(numpy.int64))\n"
                  "numpy.savetxt('{}', bits, delimiter=',', header='a,b,c,d,e')\n",
                  machines.bits(), path("code.npy"), path("columns.npy"), path("bool.npy"),
                  path("int.npy"), path("text.csv")));
  const CliResult ran = run_program(python, script.string());
  CAPTURE(ran.standard_error);
  REQUIRE(ran.exit_code == 0);
  for (const char* name : {"columns.npy", "bool.npy", "int.npy", "text.csv"}) {
    CAPTURE(name);
    CHECK(printed(code + path(name)) == read_matrix(path("code.npy")));
  }
}
