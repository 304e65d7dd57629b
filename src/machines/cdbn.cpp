#include "mcdbn/machines/cdbn.hpp"

#include "machines/own_units.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

std::size_t Cdbn::total_order() const {
  std::size_t total = 0;
  for (const Crbm& layer : layers) total += layer.shape().order;
  return total;
}

Sequences Cdbn::up_pass(const Sequences& visible) const {
  if (layers.empty()) throw ShapeError("CDBN: no layers");
  Sequences code = mcdbn::up_pass(layers.front(), visible);
  for (std::size_t i = 1; i < layers.size(); ++i) code = mcdbn::up_pass(layers[i], code);
  return code;
}

Sequences up_pass(const Crbm& layer, const Sequences& visible) {
  const std::size_t order = layer.shape().order;
  Sequences code;
  code.clips = visible.clips;
  code.valid_from = visible.valid_from + order;
  code.values = Matrix(layer.device(), visible.values.rows(), layer.shape().hidden);
  const Matrix values = in_own_units(layer, visible.values);
  // Clip by clip: rows without a history of their own clip are left at zero.
  for (const auto& clip : code.clips) {
    if (clip.frames <= code.valid_from) continue;
    const std::size_t first = clip.first + code.valid_from;
    const std::size_t count = clip.frames - code.valid_from;
    layer.hidden_probabilities(Rows(values, first, count), Rows(code.values, first, count));
  }
  return code;
}

}  // namespace mcdbn
