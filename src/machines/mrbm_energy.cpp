#include "machines/mrbm_energy.hpp"

#include <numeric>

#include "device/kernel_arguments.hpp"
#include "machines/mean_field.hpp"

namespace mcdbn {
namespace {

cl::Kernel& energy_kernel(Device& device, const char* name, bool gaussian) {
  return device.programs().kernel("energy.cl", name,
                                  {{"VEC", vector_width(device)}, {"GAUSSIAN", gaussian ? 1 : 0}});
}

}  // namespace

void free_energy_given_others(const Mrbm& mrbm, std::size_t m, const std::vector<Rows>& units,
                              const Matrix& out) {
  Device& device = mrbm.device();
  std::vector<std::size_t> all(units.size());
  std::iota(all.begin(), all.end(), 0);
  const Matrix input(device, out.rows(), mrbm.hidden());
  shared_units(mrbm, all, units, mrbm.b, {}, input);
  const Rows& own = units[m];
  require(own.count == out.rows(), "free energy: wants one number a row");
  launch(device, energy_kernel(device, "free_energy", mrbm.kind(m) == VisibleKind::gaussian),
         {{out.rows(), 1}}, own.matrix->buffer(), own.offset(), own.stride(), mrbm.a[m].buffer(), 0,
         to_int(own.columns), input.buffer(), to_int(input.stride()), to_int(mrbm.hidden()),
         out.buffer(), 0, to_int(out.stride()));
}

void weigh_lower(const Matrix& x, const Matrix& y, float weight, const Matrix& out) {
  Device& device = out.device();
  launch(device, energy_kernel(device, "weigh_lower", false), {{out.rows(), 1}}, x.buffer(),
         y.buffer(), to_int(x.stride()), weight, out.buffer(), to_int(out.stride()));
}

}  // namespace mcdbn
