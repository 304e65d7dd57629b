#include "learning/bench_steps.hpp"

#include <doctest/doctest.h>

#include <set>

#include "device/every_device.hpp"

namespace bench_steps_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("bench steps: each runs again and again and describes itself") {
  on_every_device([](Device& device) {
    std::set<std::string> seen, layers;
    for (const BenchStepMaker& maker : bench_steps()) {
      const BenchStep step = maker.make(device);
      CAPTURE(step.what.dump());
      CHECK(seen.insert(step.what.dump()).second);
      CHECK(step.what.at("layer") == maker.layer);
      layers.insert(maker.layer);
      if (maker.layer == "regeneration")
        continue;  // as the program's own tests run it, for its time
      CHECK(step.flops > 0);
      // Likewise; of those in two sizes the smaller one here.
      if (maker.layer == "generation" && step.what.at("k") > 1) continue;
      if (step.what.value("batch", 0) > 100 || step.what.value("m", 0) > 100) continue;
      step.run();
      const auto launches = device.launch_count();
      step.run();
      CHECK(device.launch_count() > launches);
    }
    device.finish();
    CHECK(layers == std::set<std::string>{"gaussian_crbm", "binary_crbm",
                                          "persistent_gaussian_crbm", "persistent_binary_crbm",
                                          "mrbm", "joint_likelihood", "mrbm_chain", "gemm",
                                          "fine_tuning", "regeneration", "generation"});
  });
}

TEST_CASE("bench steps: what a tuner looks at is a mini-batch of each kind of CRBM") {
  on_every_device([](Device& device) {
    std::set<std::string> layers;
    for (const BenchStepMaker& maker : crbm_minibatch_steps(7)) {
      const BenchStep step = maker.make(device);
      CHECK(step.what.at("batch") == 7);
      CHECK(step.what.at("layer") == maker.layer);
      layers.insert(maker.layer);
    }
    CHECK(layers == std::set<std::string>{"gaussian_crbm", "binary_crbm"});
  });
}

}  // namespace bench_steps_test
