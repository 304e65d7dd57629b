#pragma once

#include "device/kernel_arguments.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

/// A kernel of energy.cl for visible units of that kind.
inline cl::Kernel& energy_kernel(Device& device, const char* name, VisibleKind kind) {
  return device.programs().kernel(
      "energy.cl", name,
      {{"VEC", vector_width(device)}, {"GAUSSIAN", kind == VisibleKind::gaussian ? 1 : 0}});
}

}  // namespace mcdbn
