// A training whose device is lost goes on from its checkpoint, once the device is back.
#include <doctest/doctest.h>

#include <filesystem>

#include "base/scratch_folder.hpp"
#include "device_faults/tiny_training.hpp"
#include "learning/checkpoints.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE(
    "a device that is lost in mid-training leaves a checkpoint that goes on to the same bits") {
  const HealthyDriver driver;
  const TinyTraining training;
  const auto want = training.train();
  layer::heal();
  {
    const ScratchFolder folder;
    RunFolder run = RunFolder::begin(folder / "run", training.config, training.listed(), false);
    REQUIRE(training.train_to(run) == want);
  }
  const std::size_t launches = layer::calls().at("clEnqueueNDRangeKernel");
  // In the first stage, in those that follow, at the last launch of all.
  for (const std::size_t after : {launches / 5, launches / 2, launches - 1}) {
    CAPTURE(after);
    const ScratchFolder folder;
    layer::heal();
    {
      RunFolder run = RunFolder::begin(folder / "run", training.config, training.listed(), false);
      layer::fail("clEnqueueNDRangeKernel", after, CL_DEVICE_NOT_AVAILABLE, true);
      CHECK_THROWS_AS(training.train_to(run), DeviceError);
      CHECK(Checkpoints::exist_in(run.unfinished()));
      CHECK(!std::filesystem::exists(run.model()));
    }
    layer::heal();
    RunFolder run = RunFolder::resume(folder / "run");
    CHECK(training.train_to(run) == want);
    CHECK(layer::calls().at("clEnqueueNDRangeKernel") < launches);  // not all of it again
    CHECK(std::filesystem::exists(run.model()));
  }
}
