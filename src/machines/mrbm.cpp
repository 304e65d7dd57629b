#include "mcdbn/machines/mrbm.hpp"

#include <algorithm>

#include "device/pointwise.hpp"
#include "machines/mrbm_chain.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

MrbmParameters MrbmParameters::random(std::size_t track, std::size_t pose, std::size_t hidden,
                                      double deviation, const RandomKey& key) {
  MrbmParameters parameters;
  const std::array<std::size_t, 2> visible{track, pose};
  for (std::size_t m = 0; m < 2; ++m) {
    RandomKey own = key;
    own.step = static_cast<std::uint32_t>(m);
    const CrbmShape shape{visible[m], hidden, 0, VisibleKind::binary};
    const CrbmParameters drawn = CrbmParameters::random(shape, deviation, own);
    parameters.W[m] = drawn.W;
    parameters.a[m] = drawn.a;
    parameters.b = drawn.b;
  }
  return parameters;
}

Mrbm::Mrbm(Device& device, const MrbmParameters& parameters)
    : b(Matrix::from_host(device, parameters.b)) {
  for (std::size_t m = 0; m < 2; ++m) {
    W[m] = Matrix::from_host(device, parameters.W[m]);
    a[m] = Matrix::from_host(device, parameters.a[m]);
    if (W[m].columns() != b.columns() || W[m].rows() != a[m].columns())
      throw ShapeError("MRBM: the parameters do not fit together");
    W_transposed[m] = Matrix(device, W[m].columns(), W[m].rows());
  }
  refresh_transposed();
}

MrbmParameters Mrbm::to_host() const {
  return {{W[0].to_host(), W[1].to_host()}, {a[0].to_host(), a[1].to_host()}, b.to_host()};
}

void Mrbm::infer(Modality modality, const Rows& present, std::size_t steps, const Rows& absent,
                 bool doubled) const {
  MrbmChainOptions options;
  options.steps = std::max<std::size_t>(steps, 1);
  options.doubled = doubled;
  MrbmChain(*this, modality, present.count).run(present, options, absent);
}

void Mrbm::refresh_transposed() {
  for (std::size_t m = 0; m < 2; ++m) transpose(W[m], W_transposed[m]);
}

}  // namespace mcdbn
