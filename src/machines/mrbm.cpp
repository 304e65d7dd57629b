#include "mcdbn/machines/mrbm.hpp"

#include <algorithm>

#include "device/pointwise.hpp"
#include "machines/mrbm_chain.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/machines/crbm.hpp"

namespace mcdbn {

namespace {

std::size_t columns_of(const MatrixF& matrix) {
  return static_cast<std::size_t>(matrix.cols());
}

std::vector<ParameterShape> transposed_shapes(const Parameters& parameters) {
  std::vector<ParameterShape> shapes;
  for (const std::string name : kModalityNames) {
    const ParameterShape& W = parameters.entry("W_" + name);
    shapes.push_back({.name = name, .rows = W.columns, .columns = W.rows});
  }
  return shapes;
}

/// The ints that mrbm_shape.clh describes.
std::vector<std::int32_t> layout_of(const Parameters& parameters, const Parameters& transposed) {
  std::vector<std::int32_t> layout;
  std::size_t units_before = 0;
  for (const std::string name : kModalityNames) {
    const Parameters::Entry& W = parameters.entry("W_" + name);
    for (const std::size_t value :
         {W.rows, units_before, W.first, parameters.entry("a_" + name).first,
          transposed.entry(name).first})
      layout.push_back(static_cast<std::int32_t>(value));
    units_before += padded(W.rows);
  }
  layout.push_back(static_cast<std::int32_t>(parameters.entry("b").first));
  return layout;
}

Parameters uploaded(Device& device, const MrbmParameters& start) {
  Parameters parameters(device,
                        Mrbm::parameter_shapes({columns_of(start.a[0]), columns_of(start.a[1])},
                                               columns_of(start.b)));
  start.write(parameters);
  return parameters;
}

}  // namespace

void MrbmParameters::write(Parameters to) const {
  for (std::size_t m = 0; m < 2; ++m) {
    to.upload(std::string("W_") + kModalityNames[m], W[m]);
    to.upload(std::string("a_") + kModalityNames[m], a[m]);
  }
  to.upload("b", b);
}

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

MrbmParameters MrbmParameters::read(const Parameters& from) {
  MrbmParameters host;
  for (std::size_t m = 0; m < 2; ++m) {
    host.W[m] = from.to_host(std::string("W_") + kModalityNames[m]);
    host.a[m] = from.to_host(std::string("a_") + kModalityNames[m]);
  }
  host.b = from.to_host("b");
  return host;
}

std::vector<ParameterShape> Mrbm::parameter_shapes(const std::array<std::size_t, 2>& visible,
                                                   std::size_t hidden) {
  std::vector<ParameterShape> shapes;
  for (std::size_t m = 0; m < visible.size(); ++m) {
    const std::string name = kModalityNames[m];
    shapes.push_back({.name = "W_" + name, .rows = visible[m], .columns = hidden});
    shapes.push_back({.name = "a_" + name, .rows = 1, .columns = visible[m], .is_weight = false});
  }
  shapes.push_back({.name = "b", .rows = 1, .columns = hidden, .is_weight = false});
  return shapes;
}

Mrbm::Mrbm(Device& device, const MrbmParameters& start) : Mrbm(uploaded(device, start)) {}

Mrbm::Mrbm(const Parameters& parameters)
    : parameters_(parameters),
      transposed_(parameters.device(), transposed_shapes(parameters)),
      layout_(parameters.device(), layout_of(parameters_, transposed_)),
      b(parameters.matrix("b")) {
  for (std::size_t m = 0; m < 2; ++m) {
    const std::string name = kModalityNames[m];
    W[m] = parameters.matrix("W_" + name);
    a[m] = parameters.matrix("a_" + name);
    W_transposed[m] = transposed_.matrix(name);
  }
  refresh_transposed();
}

MrbmParameters Mrbm::to_host() const {
  return MrbmParameters::read(parameters_);
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
