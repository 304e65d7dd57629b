#include "device/losses.hpp"

#include "device/kernel_arguments.hpp"

namespace mcdbn {

LossAccumulator::LossAccumulator(Device& device, std::size_t slots, std::size_t largest_batch)
    : partial_(device, 1, largest_batch), sums_(device, 1, slots) {}

void LossAccumulator::add_squared_error(std::size_t slot, const Rows& x, const Rows& y, float scale,
                                        const Matrix* factor) {
  add(factor ? "scaled_squared_error_rows" : "squared_error_rows", slot, x, y, scale, factor);
}

void LossAccumulator::add_cross_entropy(std::size_t slot, const Rows& x, const Rows& y,
                                        float scale) {
  add("cross_entropy_rows", slot, x, y, scale);
}

void LossAccumulator::add(const char* kernel, std::size_t slot, const Rows& x, const Rows& y,
                          float scale, const Matrix* factor) {
  require(same_shape(x, y) && x.count <= partial_.columns() && slot < sums_.columns() &&
              x.index == nullptr && y.index == nullptr,
          "loss: shapes differ");
  require(!factor || (factor->rows() == 1 && factor->columns() == x.columns),
          "loss: a factor for other columns");
  Device& device = partial_.device();
  const auto sum_rows = [&](const auto&... last) {
    launch(device, device.programs().kernel("reduce.cl", kernel), {{x.count, 1}},
           x.matrix->buffer(), x.offset(), x.stride(), y.matrix->buffer(), y.offset(), y.stride(),
           to_int(x.columns), last...);
  };
  if (factor)
    sum_rows(factor->buffer(), partial_.buffer());
  else
    sum_rows(partial_.buffer());
  launch(device, device.programs().kernel("reduce.cl", "accumulate"), {{1, 1}}, partial_.buffer(),
         to_int(x.count), scale, sums_.buffer(), to_int(slot));
}

std::vector<float> LossAccumulator::read_and_reset() {
  const MatrixF host = sums_.to_host();
  sums_.set_zero();
  return {host.data(), host.data() + host.size()};
}

}  // namespace mcdbn
