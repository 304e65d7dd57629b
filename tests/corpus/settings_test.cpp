// The settings of clips, views and cameras: defaults and ranges.

#include <doctest/doctest.h>

#include "base/settings_table.hpp"
#include "mcdbn/corpus/training_set.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

const std::vector<Expected<CorpusSettings>>& corpus_settings() {
  using C = CorpusSettings;
  static const std::vector<Expected<C>> settings = {
      {"fps", [](C& c) { return at(c.fps); }, "30"},
      {"phases", [](C& c) { return at(c.phases); }, "1"},
      {"directions", [](C& c) { return at(c.directions); }, "1"},
      {"keep-first-frame", [](C& c) { return at(c.keep_first_frame); }, "false"},
      {"augment.views", [](C& c) { return at(c.augment.views); }, "20"},
      {"augment.mirror", [](C& c) { return at(c.augment.mirror); }, "true"},
      {"augment.azimuth", [](C& c) { return at(c.augment.azimuth_deg); }, "0"},
      {"augment.elevation", [](C& c) { return at(c.augment.elevation_deg); }, "0"},
      {"augment.distance", [](C& c) { return at(c.augment.distance); }, "0"},
      {"augment.bone", [](C& c) { return at(c.augment.bone); }, "0.05"},
      {"augment.turn", [](C& c) { return at(c.augment.turn_deg); }, "2"},
      {"augment.speed", [](C& c) { return at(c.augment.speed); }, "0.05"},
      {"augment.noise", [](C& c) { return at(c.augment.noise_px); }, "0.5"},
      {"augment.missing", [](C& c) { return at(c.augment.missing); }, "0.3"},
      {"augment.detector", [](C& c) { return at(c.augment.detector); }, "0"},
      {"augment.limbs-exchanged", [](C& c) { return at(c.augment.limbs_exchanged); }, "0"},
      {"augment.limbs-turned", [](C& c) { return at(c.augment.limbs_turned); }, "0"},
      {"augment.limbs-turned-by", [](C& c) { return at(c.augment.limbs_turned_deg); }, "25"},
      {"augment.arms-anywhere", [](C& c) { return at(c.augment.arms_anywhere); }, "0"},
      {"augment.leaning", [](C& c) { return at(c.augment.leaning); }, "0"},
      {"augment.leaning-by", [](C& c) { return at(c.augment.leaning_deg); }, "15"},
      {"augment.turning-round", [](C& c) { return at(c.augment.turning_round); }, "0"},
      {"augment.gravity", [](C& c) { return at(c.augment.gravity_deg); }, "0"},
      {"camera.azimuth", [](C& c) { return at(c.camera.azimuth_deg); }, "30"},
      {"camera.elevation", [](C& c) { return at(c.camera.elevation_deg); }, "10"},
      {"camera.fov", [](C& c) { return at(c.camera.field_of_view_deg); }, "45"}};
  return settings;
}

}  // namespace

TEST_CASE("corpus settings: every one has its default, its own name and its own member") {
  check_table(corpus_settings());
}

TEST_CASE("corpus settings: visit leaves no member out") {
  CHECK(member_count<AugmentationSettings>() == listed_under<CorpusSettings>("augment."));
  // A camera's distance follows from the clip; its image is of a fixed size.
  CHECK(member_count<CameraPlacement>() == listed_under<CorpusSettings>("camera.") + 3);
  CHECK(!CameraPlacement{}.distance);
  CHECK(CameraPlacement{}.width_px == 1920);
  CHECK(CameraPlacement{}.height_px == 1080);
  constexpr std::size_t kGroups = 4;  // and the choice of skeleton and the joint map
  CHECK(member_count<CorpusSettings>() - kGroups == corpus_settings().size() -
                                                        listed_under<CorpusSettings>("augment.") -
                                                        listed_under<CorpusSettings>("camera."));
}

TEST_CASE("corpus settings: what is out of range is refused by its name") {
  const auto refused = check_refused<CorpusSettings>;
  const auto accepted = check_accepted<CorpusSettings>;
  CHECK_NOTHROW(CorpusSettings{}.validate());
  CorpusSettings still;
  still.fps = 0;
  CHECK_THROWS_AS(still.validate(), ConfigError);
  for (const double value : {0.0, -1.5, kNan})
    refused("fps", value, "at least 0.1 and at most 10000");
  accepted("fps", 0.5);
  for (const char* name : {"phases", "augment.views"}) {
    refused(name, 0, "at least 1");
    accepted(name, 1);
  }
  refused("directions", 0, "at least 1 and at most 36");
  refused("directions", 37, "at least 1 and at most 36");
  for (const char* name : {"augment.limbs-exchanged", "augment.limbs-turned",
                           "augment.arms-anywhere", "augment.leaning", "augment.turning-round"}) {
    refused(name, -0.01, "at least 0 and at most 1");
    refused(name, 1.01, "at least 0 and at most 1");
    accepted(name, 1);
  }
  for (const char* name : {"augment.distance", "augment.bone", "augment.turn", "augment.noise",
                           "augment.limbs-turned-by", "augment.leaning-by", "augment.gravity"}) {
    refused(name, -0.01, "at least 0");
    accepted(name, 0);
  }
  refused("augment.noise", 100.1, "at least 0 and at most 100");
  refused("augment.azimuth", -1, "at least 0 and at most 180");
  refused("augment.azimuth", 181, "at least 0 and at most 180");
  refused("augment.elevation", 91, "at least 0 and at most 90");
  refused("augment.speed", 1, "at least 0 and at most 0.9");
  refused("augment.missing", 1.01, "at least 0 and at most 1");
  accepted("augment.missing", 1);
  for (const double value : {0.0, 180.0, 200.0, -1.5, kNan})
    refused("camera.fov", value, "above 0 and below 180");
  accepted("camera.fov", 0.5);
  accepted("camera.fov", 179);
  refused("camera.elevation", 90, "at least -89 and at most 89");
  refused("camera.azimuth", kNan, "at least -360 and at most 360");
  refused("camera.azimuth", 360.5, "at least -360 and at most 360");
  accepted("camera.azimuth", -360);
}
