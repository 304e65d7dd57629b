#include "mcdbn/motion_model/settings_record.hpp"

#include <doctest/doctest.h>

#include "base/scratch_folder.hpp"
#include "base/settings_table.hpp"

namespace settings_record_test {

using namespace mcdbn;
using namespace mcdbn::test;
using nlohmann::json;

namespace {

/// Each setting otherwise than it usually is.
TrainingConfig all_changed() {
  TrainingConfig config;
  double next = 2;
  visit_settings(config, [&](const Setting&, auto& member) {
    if constexpr (std::is_same_v<std::decay_t<decltype(member)>, bool>)
      member = !member;
    else
      member = static_cast<std::decay_t<decltype(member)>>(next += 1.25);
  });
  return config;
}

std::string error_of(const std::vector<GivenSetting>& given) {
  TrainingConfig config;
  try {
    assign_settings(config, given);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

TEST_CASE("settings record: what a model records comes back, out of range too") {
  const TrainingConfig config = all_changed();
  const json record = settings_json(config);
  CHECK(record.at("gaussian").at("rate-A") == config.gaussian.rate_A);
  CHECK(record.at("keep-first-frame") == true);
  CHECK(values_of(settings_from_json(record)) == values_of(config));
  // Fine-tuning has shares above one here: other versions may have had other ranges.
  CHECK_THROWS_AS(config.validate(), ConfigError);
}

TEST_CASE("settings record: models from before there was fine-tuning had none") {
  const TrainingConfig config = settings_from_json({{"hidden", 12}, {"joint", {{"rate", 0.5}}}});
  CHECK(changed_by(config) ==
        Values{{"hidden", "12"}, {"fine-tuning.rate", "0.5"}, {"fine-tuning.steps", "0"}});
  CHECK_THROWS_AS(settings_from_json({{"hiden", 12}}), ConfigError);
  CHECK_NOTHROW(settings_from_json(nlohmann::json::object()));
  CHECK_THROWS_AS(settings_from_json({{"hidden", -12}}), ConfigError);
}

TEST_CASE("settings record: the TOML of all settings is read back") {
  TrainingConfig config;
  config.hidden = 31;
  config.gaussian.rate = 0.0123;
  config.augment.mirror = false;
  config.fps = 24;
  const ScratchFolder folder;
  const auto given = read_settings_file(folder.write("all.toml", settings_toml(config)));
  CHECK(given.size() == values_of(config).size());
  TrainingConfig read;
  assign_settings(read, given);
  CHECK(values_of(read) == values_of(config));
}

TEST_CASE("settings record: the TOML holds the skeleton and the joint map, and is read back") {
  const ScratchFolder folder;
  const auto read = [&](const TrainingConfig& config) {
    TrainingConfig result;
    assign_settings(result, read_settings_file(folder.write("all.toml", settings_toml(config))));
    return result;
  };
  CHECK(read({}).skeleton == SkeletonUse::shared);
  CHECK(read({}).joint_map.empty());
  TrainingConfig config;
  for (const SkeletonUse use : {SkeletonUse::own, SkeletonUse::humanoid}) {
    config.skeleton = use;
    CHECK(read(config).skeleton == use);
  }
  config.joint_map = {{JointRole::head, "Neck"}, {JointRole::left_knee, "Knie \"links\" é.1"}};
  CHECK(read(config).joint_map == config.joint_map);
  CHECK(values_of(read(config)) == values_of(config));
}

TEST_CASE("settings record: a file's faults are named by file, line and setting") {
  const ScratchFolder folder;
  const auto error_in = [&](const char* text) {
    const auto file = folder.write("s.toml", text);
    std::string message = error_of(read_settings_file(file));
    CHECK(message.starts_with(file.string() + ":"));
    return message.substr(std::min(message.size(), file.string().size() + 1));
  };
  CHECK(error_in("order = 3\nhiden = 20\n") == "2: hiden is no setting");
  CHECK(error_in("[gaussian]\nrate = 0\n") ==
        "2: gaussian.rate must be above 0 and at most 100, not 0");
  CHECK(error_in("hidden = -3\n") == "1: hidden must be at least 1 and at most 100000, not -3");
  CHECK(error_in("hidden = 2.5\n") == "1: hidden must be a whole number, not 2.5");
  CHECK(error_in("hidden = 'ten'\n") == "1: hidden must be a whole number, not \"ten\"");
  CHECK(error_in("fps = true\n") == "1: fps must be a number, not true");
  CHECK(error_in("[augment]\nmirror = 1\n") == "2: augment.mirror must be true or false, not 1");
  CHECK(error_in("skeleton = 'other'\n") ==
        "1: skeleton must be \"own\" or \"canonical\", not \"other\"");
  CHECK(error_in("skeleton = 1\n") == "1: skeleton must be \"own\" or \"canonical\", not 1");
  CHECK(error_in("joint-map = 'Neck'\n") == "1: joint-map is no setting");
  CHECK(error_in("[joint-map]\nheat = 'Neck'\n") == "2: joint-map.heat is no role of a joint");
  CHECK(error_in("[joint-map]\nhead = 3\n") ==
        "2: joint-map.head must be the name of a joint, not 3");
  CHECK(error_in("[joint-map]\nhead = ''\n") ==
        "2: joint-map.head must be the name of a joint, not \"\"");
  CHECK(error_in("[joint]\n\nrate = -1\n") ==
        "3: joint.rate must be above 0 and at most 100, not -1");
  CHECK_THROWS_AS(read_settings_file(folder.write("no.toml", "order = = 3\n")), ConfigError);
  CHECK_THROWS_AS(read_settings_file(folder / "absent.toml"), ConfigError);
}

TEST_CASE("settings record: later settings override earlier ones, whole numbers do for others") {
  TrainingConfig config;
  assign_settings(config, {{"fps", 25, ""}, {"hidden", 8, ""}, {"hidden", 9, ""}});
  CHECK(changed_by(config) == Values{{"fps", "25"}, {"hidden", "9"}});
}

}  // namespace settings_record_test
