#include <cstdlib>

#include "fuzz/fuzzed_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/camera_file.hpp"

namespace {

/// What was read can be used.
void check(const mcdbn::CameraRig& rig) {
  for (const mcdbn::NamedCamera& named : rig.cameras)
    if (named.camera.width_px <= 0 || named.camera.height_px <= 0 ||
        !named.camera.camera_from_world.allFinite() || !named.camera.translation.allFinite())
      std::abort();
}

}  // namespace

/// Any bytes are read as what they seem to be, or refused with InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    check(mcdbn::read_cameras(mcdbn::test::fuzzed_file(data, size)));
  } catch (const mcdbn::InputError&) {
  }
  return 0;
}
