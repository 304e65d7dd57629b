#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"

namespace {

/// What was read can be written, and reads as the same again; anything thrown here is a finding.
void check_round_trip(const mcdbn::Motion& motion) {
  const mcdbn::Motion again = mcdbn::parse_bvh(mcdbn::bvh_text(motion), "again.bvh");
  if (again.channels.rows() != motion.channels.rows() ||
      again.channels.cols() != motion.channels.cols() ||
      again.skeleton.joint_count() != motion.skeleton.joint_count()) {
    std::abort();
  }
}

}  // namespace

/// Any bytes are read, or refused with InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mcdbn::Motion motion;
  try {
    motion = mcdbn::parse_bvh({reinterpret_cast<const char*>(data), size}, "fuzz.bvh");
  } catch (const mcdbn::InputError&) {
    return 0;
  }
  check_round_trip(motion);
  return 0;
}
