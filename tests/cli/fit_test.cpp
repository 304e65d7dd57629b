// fit: every kind of machine, and what each option changes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/text_file.hpp"
#include "fitted_machines.hpp"
#include "library_calls.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "mcdbn/learning/machine_fit.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Another value than the default for each setting, with its flag as it is given: a setting more is
/// a row more.
struct ChangedSetting {
  std::string name, flag;
  json value;
  bool is_switch;
};

std::vector<ChangedSetting> changed_settings() {
  std::vector<ChangedSetting> changed;
  const mcdbn::MachineSettings usual;
  mcdbn::visit_settings(usual, [&](const mcdbn::Setting& setting, const auto& value) {
    std::string flag = setting.name;
    std::replace(flag.begin(), flag.end(), '.', '-');
    json other;
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, bool>) {
      other = !value;
      flag = (value ? "--no-" : "--") + flag;
    } else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
      const double more =
          value == 0 ? 1e-3 : value * (1.0 + 1e-3 * static_cast<double>(changed.size()));
      other = setting.range.contains(more) ? more : 0.5 * value;
      flag = fmt::format("--{} {}", flag, other.get<double>());
    } else {
      other = setting.name == "hidden" ? 5 : setting.name.ends_with("epochs") ? 2 : value + 1;
      flag = fmt::format("--{} {}", flag, other.template get<std::size_t>());
    }
    changed.push_back({setting.name, flag, other, other.is_boolean()});
  });
  return changed;
}

/// A machine that has the setting, with the rule that it is of; nothing for what binary units have
/// not.
std::string machine_with(const std::string& setting) {
  if (setting == "mrbm.mean-field-steps") return "mrbm by multi-prediction";
  if (setting == "mrbm.perceptron-loss") return "mrbm by CD-PercLoss";
  if (setting.starts_with("mrbm.")) return "mrbm";
  if (setting == "gaussian.deviation-rate") return "gaussian-rbm";
  return setting == "binary.deviation-rate" ? "" : "cdbn";
}

/// What the files record of machines that are fitted with the flags of all settings that they have.
std::map<std::string, json> recorded_configs() {
  const FittedMachines& machines = FittedMachines::instance();
  const std::string mrbm = fmt::format(
      "--machine mrbm --modality a={0} --modality b={0} --hidden 5 --batch 20", machines.bits());
  std::map<std::string, std::string> options{
      {"cdbn", "--machine cdbn " + machines.values()},
      {"gaussian-rbm",
       "--machine gaussian-rbm --hidden 5 --gaussian-epochs 2 " + machines.values()},
      {"mrbm", mrbm},
      {"mrbm by multi-prediction", mrbm},
      {"mrbm by CD-PercLoss", mrbm}};
  for (const ChangedSetting& one : changed_settings())
    if (const std::string machine = machine_with(one.name); !machine.empty())
      options.at(machine) += " " + one.flag;
  const ScratchFolder folder;
  const std::string file = (folder / "all.safetensors").string();
  std::map<std::string, json> configs;
  for (const auto& [machine, given] : options) {
    output_of(fmt::format("fit -o {} --quiet {}", file, given));
    configs[machine] = mcdbn::describe_machine(file).at("config");
  }
  return configs;
}

std::vector<OptionRow> setting_option_rows() {
  const std::map<std::string, json> configs = recorded_configs();
  std::vector<OptionRow> rows;
  for (const ChangedSetting& one : changed_settings()) {
    std::string pointer = "/" + one.name;
    std::replace(pointer.begin(), pointer.end(), '.', '/');
    const std::string flag = one.flag.substr(0, one.flag.find(' ')),
                      machine = machine_with(one.name);
    if (machine.empty()) {
      rows.push_back({flag, [one] {
                        check_refused(
                            "fit x.npy --machine binary-cdbn -o m.safetensors " + one.flag, 2,
                            "is of Gaussian units without history");
                      }});
      continue;
    }
    const json recorded = configs.at(machine).at(json::json_pointer(pointer));
    rows.push_back({flag, [recorded, value = one.value] { CHECK(recorded == value); }});
    if (!one.is_switch) continue;
    // What it is unless it is given.
    const std::string opposite =
        flag.starts_with("--no-") ? "--" + flag.substr(5) : "--no-" + flag.substr(2);
    const json usual =
        mcdbn::describe_machine(FittedMachines::instance().model("rbm")).at("config");
    rows.push_back({opposite, [usual, pointer, value = one.value] {
                      CHECK(usual.at(json::json_pointer(pointer)) != value);
                    }});
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

TEST_CASE("fit: every option changes what its help describes") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const fs::path file = folder / "m.safetensors";
  const auto model = [&] { return mcdbn::read_text_file(file); };
  const std::string machine =
      " --machine crbm --order 2 --standardize -o " + file.string() + short_fit("crbm");
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
  // What these do has a test case of its own.
  for (const char* flag : {"--config", "--widths", "--orders"}) rows.push_back({flag, [] {}});
  rows.push_back({"--modality", [] {}});
  rows.push_back({"--gaussian", [] {}});
  rows.push_back({"--standardize", [&] {
                    output_of(call);
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
         CHECK(result.standard_error.find("1 file, 60 rows of 5 values") != std::string::npos);
         CHECK(model() == plain);
         CHECK(run_cli(call).standard_error.empty());
       }});
  check_options("fit", rows);
}

TEST_CASE("fit: an MRBM of three modalities, and one of them inferred from the others") {
  if (!have_device()) return;
  const FittedMachines& machines = FittedMachines::instance();
  const ScratchFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  const mcdbn::MatrixF bits = mcdbn::read_matrix(machines.bits());
  mcdbn::write_matrix(path("a.npy"), bits.leftCols(2));
  mcdbn::write_matrix(path("b.npy"), bits.rightCols(3));
  mcdbn::write_matrix(path("short.npy"), bits.topRows(9));
  const std::string out =
      " --machine mrbm --hidden 4 --batch 20 --mrbm-epochs 2 -o " + path("m.safetensors") + " ";
  const std::string modalities = " --modality a=" + path("a.npy") +
                                 " --modality b=" + path("b.npy") +
                                 " --modality v=" + machines.values();
  output_of("fit" + out + modalities + " --gaussian v --standardize --quiet");
  const auto saved = loaded(path("m.safetensors"));
  const auto& mrbm = std::get<mcdbn::Mrbm>(saved.machine);
  CHECK(mrbm.shape() == mcdbn::MrbmShape{{{"a", 2, mcdbn::VisibleKind::binary},
                                          {"b", 3, mcdbn::VisibleKind::binary},
                                          {"v", 5, mcdbn::VisibleKind::gaussian}},
                                         4});
  REQUIRE(saved.scales.size() == 3);
  CHECK(saved.scales[0].mean.cols() == 0);
  const auto is_standardized = [&] {
    return json::parse(output_of("info --json " + path("m.safetensors"))).at("standardized");
  };
  CHECK(is_standardized() == true);
  CHECK(std::abs(saved.scales[2].mean(4) - 40.0F) < 1.5F);

  auto& device = usual_device();
  const auto units = [&](const mcdbn::MatrixF& values) {
    return mcdbn::Matrix::from_host(device, values);
  };
  const mcdbn::Matrix a = units(bits.leftCols(2)), b(device, 60, 3), v(device, 60, 5),
                      given = units(saved.scales[2].apply(mcdbn::read_matrix(machines.values())));
  mrbm.infer({a, b, v}, {true, false, false}, 7);
  const std::string infer = "transform --model " + path("m.safetensors");
  CHECK(printed(infer + " --modality a=" + path("a.npy") + " --infer v --steps 7") ==
        saved.scales[2].undo(v.to_host()));
  mrbm.infer({a, b, given}, {true, false, true}, 10);
  CHECK(printed(infer + " --modality v=" + machines.values() + " --modality a=" + path("a.npy") +
                " --infer b") == b.to_host());

  check_refused("fit" + out + machines.bits(), 2, "--machine mrbm wants --modality");
  check_refused("fit" + out + "--modality a=" + path("a.npy"), 2, "at least two");
  check_refused("fit" + out + "--modality a", 2, "--modality a: NAME=FILE is wanted");
  check_refused("fit" + out + modalities + " --gaussian w", 2, "--gaussian w: there is no such");
  check_refused(
      "fit" + out + "--modality a=" + path("a.npy") + " --modality b=" + path("short.npy"), 3,
      "short.npy: 9 rows, 60 in");
  check_refused(infer + " --infer b", 2, "wants what is given");
  check_refused(infer + " --modality a=" + path("a.npy") + " --infer w", 2, "none of that name");
  check_refused(infer + " --modality a=" + path("a.npy") + " --infer a", 2, "it is given");
  check_refused(infer + " --modality a=" + path("a.npy"), 2, "--modality is for --infer");
  check_refused(infer + " " + machines.bits(), 3, "an MRBM; its data are given by --modality");
  output_of("fit" + out + "--modality a=" + path("a.npy") + " --modality b=" + path("b.npy") +
            " --quiet");
  CHECK(is_standardized() == false);
}

TEST_CASE("fit: a settings file, over which flags have the last word") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  folder.write("fit.toml", "hidden = 4\nseed = 9\n\n[gaussian]\nrate = 0.002\nepochs = 2\n");
  const std::string fit = "fit " + FittedMachines::instance().values() +
                          " --machine gaussian-rbm --quiet -o " + path("m.safetensors");
  const auto fitted = [&](const std::string& options) {
    output_of(fit + options);
    return mcdbn::read_text_file(folder / "m.safetensors");
  };
  const std::string with_file = fitted(" --seed 3 --config " + path("fit.toml"));
  const json config = mcdbn::describe_machine(path("m.safetensors")).at("config");
  CHECK(config.at("hidden") == 4);
  CHECK(config.at("seed") == 3);
  CHECK(config.at("gaussian").at("rate") == 0.002);
  CHECK(with_file == fitted(" --hidden 4 --seed 3 --gaussian-rate 0.002 --gaussian-epochs 2"));
  folder.write("fit.toml", "hidden = 4\nhiden = 9\n");
  check_refused(fit + " --config " + path("fit.toml"), 2, "fit.toml:2: hiden is no setting");
  folder.write("fit.toml", "\n[gaussian]\nrate = -1\n");
  check_refused(fit + " --config " + path("fit.toml"), 2, "fit.toml:3: gaussian.rate must be");
}

TEST_CASE("fit: a width and an order for each layer of a stack") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string file = (folder / "m.safetensors").string();
  const std::string fit = "fit " + FittedMachines::instance().values() +
                          " --batch 20 --gaussian-epochs 2 --quiet -o " + file + " --machine ";
  const auto layers_of = [&](const std::string& options) {
    output_of(fit + options);
    std::vector<std::pair<int, int>> layers;
    const json about = mcdbn::describe_machine(file);
    for (const json& layer : about.at("layers"))
      layers.emplace_back(layer.at("hidden"), layer.at("order"));
    return layers;
  };
  using Layers = std::vector<std::pair<int, int>>;
  CHECK(layers_of("cdbn --binary-epochs 2 --widths 7,4,3 --orders 1,0,2") ==
        Layers{{7, 1}, {4, 0}, {3, 2}});
  CHECK(mcdbn::describe_machine(file).at("config").at("orders") == json({1, 0, 2}));
  CHECK(layers_of("cdbn --binary-epochs 2 --widths 7,4,3 --order 1") ==
        Layers{{7, 1}, {4, 1}, {3, 1}});
  CHECK(layers_of("gaussian-dbn --widths 6") == Layers{{6, 0}});
  check_refused(fit + "cdbn --widths 7,4 --orders 1", 2, "--orders: 1 numbers, but --widths has 2");
  check_refused(fit + "cdbn --widths 7,0", 2, "--widths");
  check_refused(fit + "cdbn --widths 7,4 --layers 2", 2, "--layers");
  check_refused(fit + "gaussian-dbn --orders 1,1", 2, "--orders: --machine gaussian-dbn has no");
  check_refused(fit + "crbm --widths 4", 2, "--widths: --machine crbm has no layers but one");
}
