// What a training needs, found out before it starts: frames in a window, memory of the device.

#include "learning/memory_need.hpp"

#include <doctest/doctest.h>

#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace {

const std::vector<std::size_t> kDimensions{43, 130};

std::string complaint(const std::function<void()>& check) {
  try {
    check();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The message on a device of so many bytes.
std::string on_device_of(double bytes, const LearningSettings& settings, double frames) {
  DeviceInfo device;
  device.name = "the device";
  device.global_memory_bytes = static_cast<std::uint64_t>(bytes);
  return complaint(
      [&] { check_memory(memory_need(kDimensions, frames, settings), device, settings); });
}

}  // namespace

TEST_CASE("memory of a training: every number once, counted by hand") {
  LearningSettings settings = LearningSettings::greedy();
  settings.hidden = 8;
  settings.mrbm_hidden = 7;
  settings.order = 3;
  settings.layers = 1;
  settings.batch = 10;
  const double track = 43 * 8 + 3 * 43 * 43 + 3 * 43 * 8 + 43 + 8,
               pose = 130 * 8 + 3 * 130 * 130 + 3 * 130 * 8 + 130 + 8, mrbm = 2 * (8 * 7 + 8) + 7;
  const MemoryNeed need = memory_need(kDimensions, 500, settings);
  CHECK(need.parameters == 4 * 2 * (track + pose + mrbm));  // each value and its step
  CHECK(need.windows == 4 * 10 * (130 + 2 * 8));            // of the larger modality
  CHECK(need.frames == 4 * 500 * (43 + 130 + 2 * 8));       // the data and their codes
  CHECK(need.total() == need.parameters + need.windows + need.frames);

  settings.fine_tuning = {.steps = 1,
                          .from_greedy = false,
                          .windows = 6,
                          .window_frames = 5,
                          .settle_frames = 2,
                          .mean_field_steps = 4};
  const MemoryNeed tuned = memory_need(kDimensions, 500, settings);
  CHECK(tuned.parameters == 4 * 5 * (track + pose + mrbm));
  CHECK(tuned.frames == 0);  // only windows of them are on the device
  CHECK(tuned.windows == 4 * (6 * (2 + 5 + 3) * (43 + 130 + 2 * 2 * 8) + 6 * 7 * 2 * 4 * (8 + 7)));
  settings.fine_tuning.from_greedy = true;
  CHECK(memory_need(kDimensions, 500, settings).frames == need.frames);
}

TEST_CASE("memory of a training: what is more than the device has is refused, and what to lower") {
  const LearningSettings usual;
  CHECK(memory_need(kDimensions, 1e5, usual).total() < 1e9);
  CHECK(on_device_of(1e9, usual, 1e5).empty());
  const double need = memory_need(kDimensions, 1e5, usual).total();
  CHECK(on_device_of(need, usual, 1e5).empty());
  CHECK(contains(on_device_of(need - 1, usual, 1e5), "the training needs at least "));

  LearningSettings large = usual;
  large.hidden = 100'000;
  CHECK(
      contains(on_device_of(8e9, large, 1e3), "the device has 8 GB: lower `hidden` (now 100000)"));
  large = usual;
  large.fine_tuning.windows = 100'000;
  CHECK(contains(on_device_of(8e9, large, 1e3), "`fine-tuning.windows` (100000)"));
  CHECK(contains(on_device_of(8e9, usual, 5e7), "train on fewer clips"));
  LearningSettings alone = usual;
  alone.fine_tuning.from_greedy = false;
  CHECK(on_device_of(8e9, alone, 5e7).empty());
}

TEST_CASE("a window longer than every clip is refused by both lengths") {
  LearningSettings settings;
  settings.order = 7;
  settings.layers = 2;
  settings.look_ahead = 3;
  CHECK(complaint([&] { check_window(18, settings); }).empty());
  const std::string message = complaint([&] { check_window(17, settings); });
  CHECK(contains(message, "a window of 18 frames"));
  CHECK(contains(message, "the longest clip has 17"));
  CHECK(contains(message, "`order` 7"));
}
