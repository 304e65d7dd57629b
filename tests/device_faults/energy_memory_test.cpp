// What energies of long clips take of a device's memory.
#include <doctest/doctest.h>

#include "device_faults/tiny_training.hpp"
#include "machines/random_crbm.hpp"
#include "machines/sequence_blocks.hpp"
#include "mcdbn/machines/energy.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("energies of a long clip take memory for some hidden units, not for those of all") {
  const HealthyDriver driver;
  const CrbmShape shape{2, 64, 1, VisibleKind::binary};
  Device device = Device::open();
  const Crbm crbm(device, random_crbm(shape, 7, 1.0F));
  const Sequences visible =
      Sequences::from_host(device, {MatrixF::Zero(4 * kRowsAtOnce, shape.visible)});
  layer::heal();
  pseudo_log_likelihood(crbm, visible, 1);
  CHECK(layer::largest_buffer_bytes() > 0);
  CHECK(layer::largest_buffer_bytes() < sizeof(float) * 2 * kRowsAtOnce * shape.hidden);
}
