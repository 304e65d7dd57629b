// A model file that is not whole is refused, and the message names what is missing.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "base/capture_bound.hpp"
#include "base/safetensors.hpp"
#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "motion_model/example_model.hpp"

namespace model_damage_test {

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace {

/// A model's file that can be damaged and read again.
class File {
 public:
  explicit File(Device& device) : device_(device) {
    save_model(path_, ExampleModel(false).on(device));
    whole_ = read_safetensors(path_);
  }

  const Safetensors& whole() const { return whole_; }
  std::string path() const { return path_.string(); }
  json about() const { return json::parse(whole_.metadata.at("mcdbn")); }

  /// The message of loading this content; empty if it loads.
  std::string complaint(const Safetensors& content) const {
    write_safetensors(path_, content);
    try {
      load_model(device_, path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string complaint(const json& about) const {
    Safetensors content = whole_;
    content.metadata["mcdbn"] = about.dump();
    return complaint(content);
  }
  std::string describing(const json& about) const {
    Safetensors content = whole_;
    content.metadata["mcdbn"] = about.dump();
    write_safetensors(path_, content);
    try {
      describe_model(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

 private:
  Device& device_;
  ScratchFolder folder_;
  std::filesystem::path path_ = folder_ / "model.safetensors";
  Safetensors whole_;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a model of another format version is refused, by loading and by describing") {
  on_every_device([](Device& device) {
    const File file(device);
    CHECK(file.about().at("format_version") == 1);
    CHECK(file.complaint(file.about()).empty());
    for (const json& version : {json(0), json(2), json("1"), json(nullptr), json(-1)}) {
      json about = file.about();
      about["format_version"] = version;
      CHECK(contains(file.complaint(about), file.path() + ": model format " + version.dump()));
      CHECK(contains(file.describing(about), "format " + version.dump()));
    }
  });
}

TEST_CASE("every tensor of a model is needed, in its shape; a missing one is named") {
  on_every_device([](Device& device) {
    const File file(device);
    REQUIRE(file.whole().tensors.size() == 35);
    for (const auto& [name, tensor] : file.whole().tensors) {
      CAPTURE_BOUND(name);
      Safetensors without = file.whole();
      without.tensors.erase(name);
      CHECK(contains(file.complaint(without), file.path() + ": no tensor " + name + " "));

      Safetensors longer = file.whole();
      auto& changed = longer.tensors[name];
      changed.shape[1] += 1;
      changed.values.resize(changed.shape[0] * changed.shape[1]);
      CHECK(contains(file.complaint(longer), name + " "));

      Safetensors turned = file.whole();
      std::swap(turned.tensors[name].shape[0], turned.tensors[name].shape[1]);
      if (tensor.shape[0] != tensor.shape[1]) CHECK(contains(file.complaint(turned), name + " "));
    }
  });
}

TEST_CASE("every field of a model's description is needed; a missing one is named") {
  on_every_device([](Device& device) {
    const File file(device);
    const std::vector<std::string> optional{"sampling", "fills_gaps", "early_stopping"};
    // Every field of the description and of what it holds, one at a time.
    const auto check_without = [&](const json::json_pointer& where, const std::string& name) {
      // Earlier models do not have these.
      if (name == "always" || name == "level_view" || name == "directions") return;
      json about = file.about();
      CAPTURE(where.to_string());
      CAPTURE(name);
      REQUIRE(about.at(where).erase(name) == 1);
      CHECK(contains(file.complaint(about), "'" + name + "'"));
    };
    const json about = file.about();
    for (const auto& [name, value] : about.items())
      if (std::find(optional.begin(), optional.end(), name) == optional.end())
        check_without(json::json_pointer(""), name);
    for (const char* part :
         {"/modalities", "/modalities/camera", "/modalities/pose_features",
          "/modalities/track_features", "/modalities/pose_scale", "/modalities/track_scale",
          "/sampling", "/early_stopping", "/training_clips/1", "/track/0", "/pose/2"}) {
      const json::json_pointer where(part);
      for (const auto& [name, value] : about.at(where).items()) check_without(where, name);
    }
  });
}

TEST_CASE("every number of a model's description has a range; file and field are named") {
  on_every_device([](Device& device) {
    const File file(device);
    struct Case {
      const char* field;
      json value;
      const char* named = nullptr;  ///< in place of the field
    };
    for (const Case& one : std::vector<Case>{
             {"look_ahead", -1},
             {"look_ahead", 1'000'000},
             {"look_ahead", "5"},
             {"mean_field_steps", -1},
             {"mean_field_steps", 0},
             {"mean_field_steps", 1'000'000'000},
             {"mean_field_steps", 2.5},
             {"fills_gaps", 1},
             {"sampling.gibbs_steps", -1},
             {"sampling.mrbm_gibbs_steps", 1'000'000'000},
             {"sampling.scale", 1e300},
             {"sampling.scale", -1},
             {"sampling.steady", "yes"},
             {"mrbm_hidden", -1},
             {"mrbm_hidden", 0},
             {"mrbm_hidden", 1e12},
             {"mrbm_hidden", 1'000'000'000'000},
             {"track[0].visible", 4, "no tensor track.0.W of 4 x 7"},
             {"track[0].visible", 1'000'000'000},
             {"track[0].hidden", 100'000, "no tensor track.0.W of 5 x 100000"},
             {"track[0].order", -1},
             {"track[0].order", 1000, "no tensor track.0.A of 5000 x 5"},
             {"track[0].order", 1'000'000'000},
             {"track[0].kind", "fourier"},
             {"track[0].kind", 3},
             {"pose[1].visible", 7},
             {"pose[2].order_A", 2},
             {"modalities.fps", 1e9},
             {"modalities.fps", 1e-9},
             {"modalities.fps", -1},
             {"modalities.fps", nullptr},
             {"modalities.level_view", 1},
             {"modalities.directions", 0},
             {"modalities.directions", 37},
             {"modalities.camera.width_px", -3},
             {"modalities.camera.height_px", 0},
             {"modalities.camera.field_of_view_deg", 500},
             {"modalities.camera.elevation_deg", 91},
             {"modalities.camera.azimuth_deg", "north"},
             {"modalities.camera.distance", -1},
             {"modalities.pose_features.root", -1},
             {"modalities.pose_features.root", 99},
             {"modalities.pose_features.joints[1]", 99},
             {"modalities.pose_features.joints[1]", 0},
             {"modalities.pose_features.constant_channels[2]", "x"},
             {"modalities.pose_features.constant_channels", {1, 2}},
             {"modalities.pose_features.skeleton", "HIERARCHY\n",
              ": modalities.pose_features.skeleton:2: "},
             {"modalities.track_features.root", "Nobody"},
             {"modalities.track_features.joints[0]", "Nobody"},
             {"modalities.track_features.joints[0]", "Hand",
              ": modalities.track_features: joints: "},
             {"modalities.pose_scale.mean[3]", nullptr, ": modalities.pose_scale: mean[3]: "},
             {"modalities.pose_scale.mean", {1.0}, ": modalities.pose_scale: deviation: "},
             {"modalities.pose_scale.kept[0]", -1, ": modalities.pose_scale: kept[0]: "},
             {"modalities.track_scale.kept[1]", 0, ": modalities.track_scale: kept[1]: "},
             {"modalities.track_scale.kept[4]", 99, ": modalities.track_scale: kept[4]: "},
             {"modalities.track_scale.kept", {2, 5}, ": track[0].visible: 5 units for frames of 2"},
             {"training_clips[0].path", 3},
             {"training_clips[0].person", 3},
             {"training_clips[0].action", 3},
             {"early_stopping.steps", -1},
             {"early_stopping.loss", "low"},
             {"early_stopping.held_out[0]", 3},
             {"config.hidden", -1},
             {"config.fps", 1e300},
             {"config.seed", 0.5}}) {
      CAPTURE(one.field);
      CAPTURE(one.value.dump());
      std::string pointer = std::string("/") + one.field;
      for (char& c : pointer)
        if (c == '.' || c == '[') c = '/';
      std::erase(pointer, ']');
      json about = file.about();
      about[json::json_pointer(pointer)] = one.value;
      const std::string message = file.complaint(about);
      CAPTURE(message);
      CHECK(message.starts_with(file.path() + ": "));
      CHECK(contains(message,
                     one.named ? std::string(one.named) : ": " + std::string(one.field) + ": "));
      CHECK_FALSE(contains(message, "json"));
    }
  });
}

TEST_CASE("a tensor with a number that is none is refused by its name") {
  on_every_device([](Device& device) {
    const File file(device);
    for (const auto& [name, tensor] : file.whole().tensors)
      for (const float odd : {std::nanf(""), std::numeric_limits<float>::infinity(), -1e38F}) {
        CAPTURE_BOUND(name);
        // What Gaussian units are on average is in the units of the data.
        const bool of_data = name == "track.0.visible_mean" || name == "pose.0.visible_mean";
        if (of_data && std::isfinite(odd)) continue;
        Safetensors content = file.whole();
        content.tensors[name].values.back() = odd;
        CHECK(contains(file.complaint(content), file.path() + ": tensor " + name +
                                                    " holds a number that is not finite" +
                                                    (of_data ? "" : " or beyond 1000000")));
      }
  });
}

TEST_CASE("what is no model, and a model without layers, are refused") {
  on_every_device([](Device& device) {
    const File file(device);
    Safetensors nameless = file.whole();
    nameless.metadata.clear();
    CHECK(contains(file.complaint(nameless), file.path() + ": not a model"));
    Safetensors garbled = file.whole();
    garbled.metadata["mcdbn"] = "{";
    CHECK(contains(file.complaint(garbled), "damaged"));
    for (const char* name : {"track", "pose"}) {
      json about = file.about();
      about[name] = json::array();
      CHECK(contains(file.complaint(about), "without layers"));
    }
    json about = file.about();
    about["mrbm_hidden"] = 12;  // has 11
    CHECK(contains(file.complaint(about), "mrbm."));
  });
}

TEST_CASE("a model's description of itself, every figure of it") {
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    const ExampleModel example(false);
    Model model = example.on(device);
    save_model(folder / "model", model);
    // 5-7-4 of orders 2 and 1, 9-8-3-6 of orders 3, 2 and 1, MRBM 4 + 6 to 11; a layer learns W, A,
    // B, a and b.
    const std::size_t track = (35 + 50 + 70 + 5 + 7) + (28 + 49 + 28 + 7 + 4);
    const std::size_t pose =
        (72 + 243 + 216 + 9 + 8) + (24 + 128 + 48 + 8 + 3) + (18 + 9 + 18 + 3 + 6);
    const std::size_t mrbm = 44 + 66 + 4 + 6 + 11;
    const json whole = {
        {"training_clips", {"a.bvh", "b.bvh"}},
        {"parameters", track + pose + mrbm},
        {"fps", 24.5},
        {"order", 3},
        {"layers", 2},
        {"hidden", 31},
        {"mrbm-hidden", 17},
        {"camera.azimuth", -40.0},
        {"camera.elevation", 7.5},
        {"camera.fov", 61.0},
        {"seed", 9},
        {"skeleton", "own"},
        {"look_ahead", 4},
        {"mean_field_steps", 6},
        {"early_stopping", {{"held_out", {"c.bvh", "d.bvh"}}, {"steps", 75}, {"loss", 1.0 / 3.0}}}};
    CHECK(describe_model(folder / "model") == whole);
    model.early_stopping.reset();
    model.config.erase("layers");
    model.training_clips.pop_back();
    save_model(folder / "model", model);
    json less = whole;
    less.erase("early_stopping");
    less.erase("layers");
    less["training_clips"] = {"a.bvh"};
    CHECK(describe_model(folder / "model") == less);
  });
  CHECK_THROWS_AS(describe_model(folder / "missing"), InputError);
}

TEST_CASE("a model's description reports how it was trained, in the words of train's options") {
  const ScratchFolder folder;
  on_every_device([&](Device& device) {
    Model model = ExampleModel(false).on(device);
    const auto described = [&](const TrainingConfig& config) {
      model.config = settings_json(config);
      save_model(folder / "model", model);
      return describe_model(folder / "model");
    };
    const json general = described(TrainingConfig::general());
    CHECK(general.at("tracks") == "detector");
    CHECK(general.at("fine-tuning.steps") == TrainingConfig::general().fine_tuning.steps);
    const json generation = described(TrainingConfig::generation());
    CHECK(generation.at("tracks") == "exact");
    CHECK(generation.at("stages") == "greedy");
    CHECK(generation.at("fine-tuning.steps") == 0);
    CHECK(generation.at("gaussian.history-noise") == 1);
    TrainingConfig usual;
    const json both = described(usual);
    CHECK(both.at("stages") == "both");
    CHECK(both.at("gaussian.history-noise") == 0);
    usual.fine_tuning.from_greedy = false;
    CHECK(described(usual).at("stages") == "fine-tuning");
  });
}

}  // namespace model_damage_test
