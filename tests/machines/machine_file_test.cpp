// A machine of its own in a file: it comes back as it was, and a damaged file is refused.

#include "mcdbn/machines/machine_file.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/capture_bound.hpp"
#include "base/safetensors.hpp"
#include "base/scratch_folder.hpp"
#include "device/every_device.hpp"
#include "machines/random_crbm.hpp"
#include "mcdbn/base/errors.hpp"

namespace machine_file_test {

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace {

constexpr VisibleKind kGaussian = VisibleKind::gaussian, kBinary = VisibleKind::binary;

void check_same(const CrbmParameters& got, const CrbmParameters& want) {
  CHECK(got.shape == want.shape);
  for (MatrixF CrbmParameters::*matrix :
       {&CrbmParameters::W, &CrbmParameters::A, &CrbmParameters::B, &CrbmParameters::a,
        &CrbmParameters::b, &CrbmParameters::visible_mean})
    CHECK(got.*matrix == want.*matrix);
}

/// Two modalities, with a value of its own in every field.
Mcdbn example_network(Device& device) {
  const CrbmParameters one = random_crbm({5, 7, 2, kGaussian}, 1, 4.0F),
                       two = random_crbm({4, 3, 1, kBinary}, 2, 4.0F);
  MrbmParameters mrbm = MrbmParameters::zeros({{{"one", 7}, {"two", 3}}, 6});
  mrbm.W = {random_matrix(7, 6, 3), random_matrix(3, 6, 4)};
  Mcdbn network{std::vector<Cdbn>(2), Mrbm(device, mrbm), 3, 8};
  network.cdbns[0].layers.emplace_back(device, one);
  network.cdbns[1].layers.emplace_back(device, two);
  network.sampling = {
      .gibbs_steps = 4, .mrbm_gibbs_steps = 2, .steady = true, .scale = 0.75, .sampled = true};
  network.fills_gaps = false;
  network.deviation = AnswerDeviation{random_matrix(3, 4, 5), random_matrix(1, 4, 6)};
  return network;
}

/// The message of loading this content; empty if it loads.
std::string complaint(Device& device, const std::filesystem::path& path,
                      const Safetensors& content) {
  write_safetensors(path, content);
  try {
    load_machine(device, path);
  } catch (const InputError& error) {
    const std::string text = error.what();
    CHECK(text.starts_with(path.string() + ": "));
    return text;
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("small: a CRBM comes back from its file as it was saved, scale and settings too") {
  const ScratchFolder folder;
  const auto path = folder / "machine.safetensors";
  on_every_device([&](Device& device) {
    for (const CrbmShape& shape : {CrbmShape{5, 3, 0, kBinary}, CrbmShape{3, 17, 2, kGaussian},
                                   CrbmShape{1, 1, 1, kBinary}}) {
      const CrbmParameters p = random_crbm(shape, 3, 4.0F);
      ColumnScale scale{3e6F * random_matrix(1, shape.visible, 8),
                        random_matrix(1, shape.visible, 9).cwiseAbs()};
      save_machine(path, {Crbm(device, p), {scale}, {{"seed", 7}}});
      const SavedMachine got = load_machine(device, path);
      REQUIRE(std::holds_alternative<Crbm>(got.machine));
      const Crbm& crbm = std::get<Crbm>(got.machine);
      check_same(crbm.to_host(), p);
      CHECK(crbm.W_transposed.to_host() == p.W.transpose());
      REQUIRE(got.scales.size() == 1);
      CHECK(got.scales[0].mean == scale.mean);
      CHECK(got.scales[0].deviation == scale.deviation);
      CHECK(got.config == json{{"seed", 7}});
      CHECK(is_machine_file(path));
      const json about = describe_machine(path);
      CHECK(about.at("kind") == "crbm");
      CHECK(about.at("layers").at(0).at("order") == shape.order);
      CHECK(about.at("standardized") == true);
      CHECK(about.at("parameters") ==
            static_cast<std::size_t>(p.W.size() + p.A.size() + p.B.size() + p.b.size()) +
                shape.visible);  // a; the means and the scale are not learnt
    }
  });
}

TEST_CASE("small: a CDBN comes back from its file layer by layer") {
  const ScratchFolder folder;
  const auto path = folder / "machine.safetensors";
  on_every_device([&](Device& device) {
    const std::vector<CrbmParameters> layers = {random_crbm({5, 7, 2, kGaussian}, 1, 4.0F),
                                                random_crbm({7, 3, 0, kBinary}, 2, 4.0F)};
    Cdbn cdbn;
    for (const CrbmParameters& p : layers) cdbn.layers.emplace_back(device, p);
    save_machine(path, {cdbn});
    const SavedMachine got = load_machine(device, path);
    REQUIRE(std::holds_alternative<Cdbn>(got.machine));
    const auto& back = std::get<Cdbn>(got.machine).layers;
    REQUIRE(back.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) check_same(back[i].to_host(), layers[i]);
    CHECK(got.scales.empty());
    CHECK(describe_machine(path).at("standardized") == false);
    // Nor is one whose scales are empty.
    save_machine(path, {cdbn, {ColumnScale{}}});
    CHECK(describe_machine(path).at("standardized") == false);
  });
}

TEST_CASE("small: a Gaussian machine of data of any size comes back, its mean and deviation too") {
  const ScratchFolder folder;
  const auto path = folder / "machine.safetensors";
  on_every_device([&](Device& device) {
    CrbmParameters p = random_crbm({5, 3, 2, kGaussian}, 3, 4.0F);
    p.visible_mean = 1.7e9F * random_matrix(1, 5, 8);
    p.visible_deviation = 3e8F * random_matrix(1, 5, 9).cwiseAbs();
    save_machine(path, {Crbm(device, p)});
    const SavedMachine saved = load_machine(device, path);
    const CrbmParameters got = std::get<Crbm>(saved.machine).to_host();
    check_same(got, p);
    CHECK(got.visible_deviation == p.visible_deviation);
    const Safetensors whole = read_safetensors(path);
    for (const float odd : {0.0F, -1.0F, std::numeric_limits<float>::infinity()}) {
      Safetensors content = whole;
      content.tensors["visible_deviation"].values[1] = odd;
      CHECK(contains(complaint(device, path, content), "tensor visible_deviation holds"));
    }
    // Binary units are from 0 to 1, whatever the data.
    save_machine(path, {Crbm(device, random_crbm({5, 3, 2, kBinary}, 3, 4.0F))});
    Safetensors binary = read_safetensors(path);
    binary.tensors["visible_mean"].values[1] = 1.7e9F;
    CHECK(contains(complaint(device, path, binary), "tensor visible_mean holds"));
  });
}

TEST_CASE("small: an MCDBN comes back from its file whole: how it samples, how far it may be off") {
  const ScratchFolder folder;
  const auto path = folder / "machine.safetensors";
  on_every_device([&](Device& device) {
    const Mcdbn network = example_network(device);
    save_machine(path, {network});
    const SavedMachine saved = load_machine(device, path);
    REQUIRE(std::holds_alternative<Mcdbn>(saved.machine));
    const Mcdbn& got = std::get<Mcdbn>(saved.machine);
    for (std::size_t m = 0; m < 2; ++m)
      check_same(got.cdbns[m].layers.at(0).to_host(), network.cdbns[m].layers[0].to_host());
    CHECK(got.mrbm.to_host().W == network.mrbm.to_host().W);
    CHECK(got.look_ahead == 3);
    CHECK(got.mean_field_steps == 8);
    CHECK_FALSE(got.fills_gaps);
    CHECK(got.sampling.gibbs_steps == 4);
    CHECK(got.sampling.mrbm_gibbs_steps == 2);
    CHECK(got.sampling.steady);
    CHECK(got.sampling.scale == 0.75);
    CHECK(got.sampling.sampled);
    REQUIRE(got.deviation);
    CHECK(got.deviation->C == network.deviation->C);
    CHECK(got.deviation->c == network.deviation->c);

    // A file without them has the defaults.
    Safetensors older = read_safetensors(path);
    older.tensors.erase("two.deviation.C");
    older.tensors.erase("two.deviation.c");
    json about = json::parse(older.metadata.at("mcdbn_machine"));
    about.erase("sampling");
    older.metadata["mcdbn_machine"] = about.dump();
    write_safetensors(path, older);
    const Mcdbn plain = std::get<Mcdbn>(load_machine(device, path).machine);
    CHECK_FALSE(plain.deviation);
    CHECK(plain.sampling.gibbs_steps == SamplingRule{}.gibbs_steps);
    CHECK(plain.sampling.mrbm_gibbs_steps == 0);
    CHECK(plain.sampling.scale == 1.0);
    CHECK_FALSE(plain.sampling.sampled);
  });
}

TEST_CASE("an MCDBN's file with a damaged sampling rule or deviation is refused") {
  const ScratchFolder folder;
  const auto path = folder / "machine.safetensors";
  on_every_device([&](Device& device) {
    save_machine(path, {example_network(device)});
    const Safetensors whole = read_safetensors(path);
    CHECK(complaint(device, path, whole).empty());
    for (const std::string name : {"two.deviation.C", "two.deviation.c"}) {
      Safetensors content = whole;
      content.tensors.erase(name);
      CHECK(contains(complaint(device, path, content), "no tensor " + name + " "));
      content = whole;
      content.tensors[name].values.back() = std::nanf("");
      CHECK(contains(complaint(device, path, content), "tensor " + name + " holds"));
    }
    const json about = json::parse(whole.metadata.at("mcdbn_machine"));
    for (const auto& [field, value] : std::vector<std::pair<std::string, json>>{
             {"gibbs_steps", -1}, {"mrbm_gibbs_steps", 0.5}, {"steady", 3}, {"scale", -2}}) {
      Safetensors content = whole;
      json changed = about;
      changed["sampling"][field] = value;
      content.metadata["mcdbn_machine"] = changed.dump();
      CHECK(contains(complaint(device, path, content), ": sampling." + field + ": "));
    }
  });
}

TEST_CASE("a machine's file that is not whole is refused, and the message names what is missing") {
  const ScratchFolder folder;
  const auto path = folder / "machine.safetensors";
  on_every_device([&](Device& device) {
    save_machine(path, {Crbm(device, random_crbm({5, 3, 2, kGaussian}, 3, 4.0F)),
                        {{random_matrix(1, 5, 8), random_matrix(1, 5, 9).cwiseAbs()}}});
    const Safetensors whole = read_safetensors(path);
    REQUIRE(whole.tensors.size() == 8);
    for (const auto& [name, tensor] : whole.tensors) {
      CAPTURE_BOUND(name);
      Safetensors without = whole;
      without.tensors.erase(name);
      CHECK(contains(complaint(device, path, without), "no tensor " + name + " "));
    }
    const auto with = [&](const char* key, const json& value) {
      Safetensors content = whole;
      json about = json::parse(whole.metadata.at("mcdbn_machine"));
      about[key] = value;
      content.metadata["mcdbn_machine"] = about.dump();
      return complaint(device, path, content);
    };
    CHECK(with("kind", "crbm").empty());
    CHECK(contains(with("kind", "other"), "kind: a machine of unknown kind 'other'"));
    CHECK(contains(with("kind", "cdbn"), "no tensor 0.W"));
    CHECK(contains(with("layers", 3), ": layers: a number where a list is expected"));
    CHECK(contains(with("layers", json::array()), ": layers: 0 values; more are needed"));
    CHECK(contains(
        with("layers",
             json::array({{{"visible", 5}, {"hidden", 3}, {"order", 2}, {"kind", "odd"}}})),
        ": layers[0].kind: 'odd'; gaussian and binary are known"));
    CHECK(contains(with("scales", {4}), ": scales[0]: a scale of 4 columns"));
    CHECK(contains(with("scales", {5, 5}), ": scales[1]: a scale of 5 columns"));
    for (const auto& [field, value] :
         std::vector<std::pair<const char*, json>>{{"visible", -5},
                                                   {"visible", 1e9},
                                                   {"hidden", 0},
                                                   {"hidden", 3.5},
                                                   {"order", -2},
                                                   {"order", 4000000000},
                                                   {"order_A", 3},
                                                   {"order_B", -1}}) {
      CAPTURE_BOUND(field);
      json layer = {{"visible", 5}, {"hidden", 3}, {"order", 2}, {"kind", "gaussian"}};
      layer[field] = value;
      CHECK(contains(with("layers", json::array({layer})),
                     std::string(": layers[0].") + field + ": "));
    }
    CHECK(contains(with("format_version", 2), "model format 2, this program reads 1"));
    for (const auto& [name, tensor] : whole.tensors)
      for (const float odd : {std::nanf(""), std::numeric_limits<float>::infinity(), -1e38F}) {
        CAPTURE_BOUND(name);
        // Data may be as large.
        if ((name == "scale.0.mean" || name == "visible_mean") && std::isfinite(odd)) continue;
        Safetensors content = whole;
        content.tensors[name].values.back() = odd;
        CHECK(contains(complaint(device, path, content), "tensor " + name + " holds"));
      }
    Safetensors flat = whole;
    flat.tensors["scale.0.deviation"].values[2] = 0;
    CHECK(contains(complaint(device, path, flat), "tensor scale.0.deviation holds"));
    Safetensors other = whole;
    other.metadata = {{"mcdbn", "{}"}};
    CHECK(contains(complaint(device, path, other), "not a machine that mcdbn-cl fitted"));
    CHECK_FALSE(is_machine_file(path));
    CHECK_THROWS_AS(load_machine(device, folder / "absent.safetensors"), InputError);
  });
}

}  // namespace machine_file_test
