// The settings of clips, cameras, views and people, as learning_settings_test.cpp has the others.

#include <doctest/doctest.h>

#include <limits>

#include "mcdbn/motion_model/training_schedule.hpp"
#include "motion_model/settings_table.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

const std::vector<Setting>& motion_settings() {
  using C = TrainingConfig;
  static const std::vector<Setting> settings = {
      {"fps", [](C& c) { return at(c.fps); }, "30"},
      {"phases", [](C& c) { return at(c.phases); }, "1"},
      {"keep-first-frame", [](C& c) { return at(c.keep_first_frame); }, "false"},
      {"fine-tuning.people-power", [](C& c) { return at(c.fine_tuning.people_power); }, "0.5"},
      {"fine-tuning.positions", [](C& c) { return at(c.pose_loss.positions); }, "0.5"},
      {"fine-tuning.velocities", [](C& c) { return at(c.pose_loss.velocities); }, "0.2"},
      {"fine-tuning.contacts", [](C& c) { return at(c.pose_loss.contacts); }, "0.1"},
      {"fine-tuning.hold-out-among", [](C& c) { return at(c.hold_out_among); }, "20"},
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
      {"camera.azimuth", [](C& c) { return at(c.camera.azimuth_deg); }, "30"},
      {"camera.elevation", [](C& c) { return at(c.camera.elevation_deg); }, "10"},
      {"camera.fov", [](C& c) { return at(c.camera.field_of_view_deg); }, "45"}};
  return settings;
}

}  // namespace

TEST_CASE("motion settings: every one has its default, its own name and its own member") {
  check_settings(motion_settings());
}

TEST_CASE("motion settings: the list leaves no member out") {
  CHECK(member_count<AugmentationSettings>() == listed_under("augment."));
  // Its distance follows from the clip; its image is of a fixed size.
  CHECK(member_count<CameraPlacement>() == listed_under("camera.") + 3);
  CHECK(!CameraPlacement{}.distance);
  CHECK(CameraPlacement{}.width_px == 1920);
  CHECK(CameraPlacement{}.height_px == 1080);
}

TEST_CASE("motion settings: what is out of range is refused by its name") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const char* name : {"fps", "phases", "augment.views", "camera.fov"})
    check_refused(name, 0, " must be above 0, not 0");
  for (const char* name : {"fps", "camera.fov"}) {
    check_refused(name, -1.5, " must be above 0, not -1.5");
    check_refused(name, nan, " must be above 0, not nan");
    check_accepted(name, 0.5);
  }
  for (const char* name : {"phases", "augment.views"}) check_accepted(name, 1);
}

TEST_CASE("motion settings: what may be nothing is accepted as nothing") {
  for (const char* name :
       {"keep-first-frame", "fine-tuning.people-power", "fine-tuning.positions",
        "fine-tuning.velocities", "fine-tuning.contacts", "fine-tuning.hold-out-among",
        "augment.mirror", "augment.azimuth", "augment.distance", "augment.bone", "augment.turn",
        "augment.speed", "augment.noise", "augment.missing", "camera.azimuth", "camera.elevation"})
    check_accepted(name, 0);
}
