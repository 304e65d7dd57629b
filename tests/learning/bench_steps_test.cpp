#include "learning/bench_steps.hpp"

#include <doctest/doctest.h>

#include <set>

#include "device/every_device.hpp"

namespace bench_steps_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("bench steps: each runs again and again and says what it is") {
  on_every_device([](Device& device) {
    std::set<std::string> seen;
    for (const BenchStepMaker& make : bench_steps()) {
      const BenchStep step = make(device);
      CAPTURE(step.what.dump());
      CHECK(seen.insert(step.what.dump()).second);
      const std::string layer = step.what.at("layer");
      if (layer == "regeneration") continue;  // as the program's own tests run it, for its time
      CHECK(step.flops > 0);
      if (layer == "generation" && step.what.at("k") > 1) continue;  // likewise
      step.run();
      const auto launches = device.launch_count();
      step.run();
      CHECK(device.launch_count() > launches);
    }
    device.finish();
    for (const char* layer : {"\"gaussian_crbm", "\"binary_crbm", "persistent_gaussian_crbm",
                              "persistent_binary_crbm", "joint_likelihood", "generation"})
      CHECK(std::any_of(seen.begin(), seen.end(), [&](const std::string& what) {
        return what.find(layer) != std::string::npos;
      }));
  });
}

TEST_CASE("bench steps: what a tuner looks at is a mini-batch of each kind of CRBM") {
  on_every_device([](Device& device) {
    std::set<std::string> layers;
    for (const BenchStepMaker& make : crbm_minibatch_steps(7)) {
      const BenchStep step = make(device);
      CHECK(step.what.at("batch") == 7);
      layers.insert(step.what.at("layer").get<std::string>());
    }
    CHECK(layers == std::set<std::string>{"gaussian_crbm", "binary_crbm"});
  });
}

}  // namespace bench_steps_test
