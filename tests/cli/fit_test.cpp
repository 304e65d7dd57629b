// fit: every kind of machine, what each option changes, and what is refused.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/text_file.hpp"
#include "fitted_machines.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

using Values = std::vector<std::pair<std::string, double>>;

/// Every setting with another value than its default.
Values setting_values() {
  Values values = {{"seed", 7},   {"order", 2},  {"hidden", 9},
                   {"layers", 3}, {"batch", 13}, {"least-batches", 5}};
  for (const std::string group : {"gaussian.", "binary."})
    for (const auto& [name, value] : Values{{"gibbs-steps", 2},
                                            {"rate", 0.0021},
                                            {"rate-A", 0.00013},
                                            {"rate-B", 0.0017},
                                            {"momentum", 0.55},
                                            {"momentum-from-epoch", 1},
                                            {"weight-decay", 0.003},
                                            {"initial-deviation", 0.02},
                                            {"epochs", 3}})
      values.emplace_back(group + name, value);
  return values;
}

std::string flag_of(std::string name) {
  std::replace(name.begin(), name.end(), '.', '-');
  return "--" + name;
}

/// A row for each setting: one run has all of them, and its file says so.
std::vector<OptionRow> setting_option_rows() {
  const ScratchFolder folder;
  const fs::path file = folder / "all.safetensors";
  std::string flags;
  for (const auto& [name, value] : setting_values())
    flags += fmt::format(" {} {}", flag_of(name), value);
  output_of(fmt::format("fit {} --machine cdbn -o {} --quiet{}",
                        FittedMachines::instance().values(), file.string(), flags));
  const json about = json::parse(output_of("info --json " + file.string()));
  CHECK(about.at("layers").size() == 3);
  CHECK(about.at("layers").at(2) ==
        json{{"visible", 9}, {"hidden", 9}, {"order", 2}, {"kind", "binary"}});
  std::vector<OptionRow> rows;
  for (const auto& [name, value] : setting_values()) {
    std::string pointer = "/config/" + name;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    const json recorded = about.at(json::json_pointer(pointer));
    rows.push_back({flag_of(name), [recorded, value = value] { CHECK(recorded == value); }});
  }
  return rows;
}

}  // namespace

TEST_CASE("fit: every kind of machine, its sizes, its metrics") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  for (const std::string kind : {"rbm", "gaussian-rbm", "crbm", "binary-crbm", "dbn",
                                 "gaussian-dbn", "cdbn", "binary-cdbn"}) {
    CAPTURE(kind);
    const json about = mcdbn::describe_machine(machines.model(kind));
    const bool is_stack = kind.ends_with("dbn"),
               is_binary = machines.data_of(kind) == machines.bits(),
               has_history = kind.ends_with("crbm") || kind.ends_with("cdbn");
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
    CHECK(std::count(lines.begin(), lines.end(), '\n') == (is_stack ? 4 : 2));
    const json first = json::parse(lines.substr(0, lines.find('\n')));
    CHECK(first.at("stage") == "layer.0");
    CHECK(first.at("loss").is_number());
    CHECK(first.at("weight_norm").is_number());
  }
}

TEST_CASE("fit: every option changes what its help says") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const fs::path file = folder / "m.safetensors";
  const auto model = [&] { return mcdbn::read_text_file(file); };
  const std::string machine = " --machine crbm --order 2 -o " + file.string() + kShortFit;
  const std::string call = "fit " + machines.values() + machine;
  output_of(call);
  const std::string plain = model();
  std::vector<OptionRow> rows = setting_option_rows();
  for (const OptionRow& row : refused_device_rows(call)) rows.push_back(row);
  rows.push_back({"data", [&] {
                    output_of("fit " + machines.values() + " " + machines.values() + machine);
                    CHECK(model() != plain);
                  }});
  rows.push_back({"--tensor", [&] {
                    const std::string tensors = (folder / "d.safetensors").string();
                    mcdbn::write_matrix(tensors, mcdbn::read_matrix(machines.values()), "x");
                    output_of("fit " + tensors + machine + " --tensor x");
                    CHECK(model() == plain);
                    check_refused("fit " + tensors + machine + " --tensor y", 3, "no tensor y");
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
         const CliResult result =
             run_cli(call.substr(0, call.size() - std::string(" --quiet").size()));
         CHECK(result.standard_error.find("100 %  layer.0 epoch 2/2") != std::string::npos);
         CHECK(result.standard_error.find("1 files, 60 rows of 5 values") != std::string::npos);
         CHECK(model() == plain);
         CHECK(run_cli(call).standard_error.empty());
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
  const std::string out = " -o " + path("m.safetensors") + " --machine ";
  check_refused("fit " + path("odd.csv") + out + "rbm", 3, "odd.csv:2: 'x' in column 2");
  check_refused("fit " + path("bits.csv") + " " + path("wide.csv") + out + "rbm", 3,
                "wide.csv: 3 columns, 2 in");
  check_refused("fit " + path("holes.csv") + out + "rbm", 3, "holes.csv: row 2, column 1 is nan");
  check_refused("fit " + path("large.csv") + out + "rbm", 3,
                "large.csv: row 2, column 2 is 2.5; binary units want");
  check_refused("fit " + path("bits.csv") + out + "cdbn --order 2", 3,
                "no file has more than 4 rows");
  check_refused("fit x.npy" + out + "rbm --order 2", 2, "--order: --machine rbm has no history");
  check_refused("fit x.npy" + out + "crbm --layers 2", 2, "--layers: --machine crbm has no layers");
  check_refused("fit x.npy" + out + "dbn --standardize", 2, "--standardize: --machine dbn");
  check_refused("fit x.npy" + out + "rbm --binary-rate 0", 2, "--binary-rate must be");
  CHECK(!fs::exists(folder / "m.safetensors"));
}

TEST_CASE("fit: a rate that is too high trips the guard, which says what to lower") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string file = (folder / "m.safetensors").string();
  check_refused(fmt::format("fit {} --machine gaussian-rbm -o {} --hidden 5 --batch 20 "
                            "--gaussian-rate 5 --gaussian-epochs 200 --quiet",
                            FittedMachines::instance().values(), file),
                1, "lower --gaussian-rate (now 5)");
  CHECK(!fs::exists(file));
}
