// What a training makes on a device is gone with it.
#include <doctest/doctest.h>
#include <malloc.h>

#include "device_faults/tiny_training.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// Bytes that this process has asked for and not given back. What it keeps of what was given back
/// depends on how its threads took turns.
double used_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

}  // namespace

TEST_CASE("a hundred trainings leave no OpenCL object and need no more memory than a few") {
  const HealthyDriver driver;
  const TinyTraining training;
  const auto train = [&](int devices) {
    constexpr int kTrainings = 10;
    for (int i = 0; i < devices; ++i) {
      Device device = Device::open();
      const auto open = layer::objects();
      for (int k = 0; k < kTrainings; ++k) {
        training.train(device);
        // Kernels and their programs stay for the next one.
        auto objects = layer::objects();
        for (const char* kind : {"kernel", "program"}) objects.erase(kind);
        CHECK(objects == open);
      }
    }
    CHECK(layer::objects().empty());
    return used_bytes();
  };
  [[maybe_unused]] const double few = train(2), many = train(8);
#ifndef __SANITIZE_ADDRESS__  // which keeps what was freed for a while
  // Less than what a training reads; PoCL keeps some 400 KB of each device that was opened.
  constexpr double kMost = 10e6;
  CAPTURE(few);
  CAPTURE(many);
  CHECK(many - few < kMost);
#endif
  CHECK(layer::calls().at("clCreateContext") == 10);
}
