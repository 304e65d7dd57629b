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

/// The message on a device of so many bytes, with so many in one buffer.
std::string on_device_of(double bytes, double in_one_buffer, const LearningSettings& settings,
                         double frames) {
  DeviceInfo device;
  device.name = "the device";
  device.global_memory_bytes = static_cast<std::uint64_t>(bytes);
  device.largest_buffer_bytes = static_cast<std::uint64_t>(in_one_buffer);
  return complaint([&] { check_memory(kDimensions, frames, settings, device); });
}

std::string on_device_of(double bytes, const LearningSettings& settings, double frames) {
  return on_device_of(bytes, bytes, settings, frames);
}

/// One that gives a quarter of its memory to a buffer, as most do.
std::string on_device_of_1_gb(const LearningSettings& settings, double frames) {
  return on_device_of(1.024e9, 0.256e9, settings, frames);
}

LearningSettings small_settings() {
  LearningSettings settings = LearningSettings::greedy();
  settings.hidden = 8;
  settings.mrbm_hidden = 7;
  settings.order = 3;
  settings.layers = 1;
  return settings;
}

FineTuningSettings small_fine_tuning() {
  return {.steps = 1,
          .from_greedy = false,
          .windows = 6,
          .window_frames = 5,
          .settle_frames = 2,
          .mean_field_steps = 4};
}

/// Parameters of small_settings()' machines.
constexpr double kTrack = 43 * 8 + 3 * 43 * 43 + 3 * 43 * 8 + 43 + 8,
                 kPose = 130 * 8 + 3 * 130 * 130 + 3 * 130 * 8 + 130 + 8,
                 kMrbm = 2 * (8 * 7 + 8) + 7;

}  // namespace

TEST_CASE("memory of a training: every number once, counted by hand") {
  LearningSettings settings = small_settings();
  settings.batch = 10;
  const MemoryNeed need = memory_need(kDimensions, 500, settings);
  CHECK(need.parameters == 4 * 2 * (kTrack + kPose + kMrbm));  // each value and its step
  CHECK(need.windows == 4 * 10 * (130 + 2 * 8));               // of the larger modality
  CHECK(need.frames == 4 * 500 * (43 + 130 + 2 * 8));          // the data and their codes
  CHECK(need.total() == need.parameters + need.windows + need.frames);

  settings.fine_tuning = small_fine_tuning();
  const MemoryNeed tuned = memory_need(kDimensions, 500, settings);
  CHECK(tuned.parameters == 4 * 5 * (kTrack + kPose + kMrbm));
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

TEST_CASE("memory of a training: the largest buffer for each purpose, counted by hand") {
  LearningSettings settings = small_settings();
  settings.gaussian.adam = false;
  const auto largest = [&] { return largest_buffers(kDimensions, 500, settings); };
  CHECK(largest().parameters == 4 * kPose);  // a machine after another
  CHECK(largest().windows == 0);
  CHECK(largest().frames == 4 * 500 * 130);
  settings.gaussian.adam = true;
  CHECK(largest().parameters == 4 * 2 * kPose);
  settings.gaussian.adam = false;
  settings.mrbm.adam = true;
  settings.mrbm_hidden = 10'000;
  CHECK(largest().parameters == 4 * 2 * (2 * (8 * 10'000 + 8) + 10'000));
  settings.mrbm_hidden = 7;
  settings.hidden = 200;
  CHECK(largest().frames == 4 * 500 * 200);
  settings.hidden = 8;

  settings.fine_tuning = small_fine_tuning();
  CHECK(largest().parameters == 4 * 2 * (kTrack + kPose + kMrbm));
  CHECK(largest().windows == 4 * 6 * (2 + 5 + 3) * 130);
  CHECK(largest().frames == 0);
  settings.fine_tuning.mean_field_steps = 100;
  CHECK(largest().windows == 4 * 6 * (2 + 5) * 100 * 8);
}

TEST_CASE("memory of a training: what fits the device, but no buffer of it, is refused") {
  LearningSettings tuned;
  tuned.layers = 1;
  tuned.order = 30;
  tuned.hidden = 7150;
  tuned.mrbm_hidden = 8;
  tuned.fine_tuning.windows = 2;
  const std::string advice = "the device takes 0.256 GB: lower `hidden` (now 7150)";
  CHECK(on_device_of(1.024e9, tuned, 1e3).empty());
  CHECK(contains(on_device_of_1_gb(tuned, 1e3), " in one buffer, " + advice));
  LearningSettings greedy = tuned;
  greedy.fine_tuning.steps = 0;
  greedy.gaussian.adam = false;
  CHECK(on_device_of_1_gb(greedy, 1e3).empty());
  greedy.hidden = 19'000;
  CHECK(on_device_of(1.024e9, greedy, 1e3).empty());
  CHECK(contains(on_device_of_1_gb(greedy, 1e3), "lower `hidden` (now 19000)"));
  const double largest = largest_buffers(kDimensions, 1e3, greedy).largest();
  CHECK(on_device_of(1.024e9, largest, greedy, 1e3).empty());
  CHECK(!on_device_of(1.024e9, largest - 1, greedy, 1e3).empty());

  LearningSettings of_many_frames = LearningSettings::greedy();
  of_many_frames.hidden = 300;
  CHECK(on_device_of(1.024e9, of_many_frames, 3e5).empty());
  CHECK(contains(on_device_of_1_gb(of_many_frames, 3e5), "train on fewer clips"));
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
