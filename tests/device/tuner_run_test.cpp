// A whole run of the tuner. The thread sanitizer leaves this file out (docs/contributing.md).

#include <doctest/doctest.h>

#include "base/scoped_variable.hpp"
#include "base/scratch_folder.hpp"
#include "device/default_tuning.hpp"
#include "device/every_device.hpp"
#include "device/tuner.hpp"

namespace tuner_run_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("tuner: what was found is set on the device and stored for the next time") {
  on_every_device([](Device& device) {
    const ScratchFolder folder;
    const ScopedVariable cache("XDG_CACHE_HOME", (folder / "cache").string());
    const Tuning usual = device.tuning();
    // From where the measured units lead, not from the default.
    const Tuning start = for_units_of_8_floats(default_tuning(device.info()));
    const auto candidates = tuning_candidates(device.info(), start);
    const Tuning& favourite = candidates.back();
    const TunedTime time_s = [&](const Tuning& tuning) {
      CHECK(device.tuning() == tuning);  // the work is measured with it
      return tuning == favourite ? 1.0 : 2.0;
    };
    CHECK(tune(device, start, {time_s, time_s}, 0.0));
    Tuning found = device.tuning();
    CHECK(load_tuning(device.info()) == found);
    constexpr std::int64_t k256 = 256 * 256 * 256;
    CHECK((found.clblast_from == 0 || found.clblast_from == k256 ||
           found.clblast_from == 8 * k256 || found.clblast_from == 64 * k256));
    found.clblast_from = favourite.clblast_from;
    CHECK(found == favourite);
    device.set_tuning(usual);
  });
}

}  // namespace tuner_run_test
