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

/// "W_track"
std::string name_of(const char* letter, std::size_t modality) {
  return std::string(letter) + '_' + kModalityNames[modality];
}

std::vector<ParameterShape> transposed_shapes(const Parameters& parameters) {
  std::vector<ParameterShape> shapes;
  for (std::size_t m = 0; m < kModalityNames.size(); ++m) {
    const ParameterShape& W = parameters.entry(name_of("W", m));
    shapes.push_back({.name = W.name, .rows = W.columns, .columns = W.rows});
  }
  return shapes;
}

/// The ints that mrbm_shape.clh describes.
std::vector<std::int32_t> layout_of(const Parameters& parameters, const Parameters& transposed) {
  std::vector<std::int32_t> layout;
  std::size_t units_before = 0;
  for (std::size_t m = 0; m < kModalityNames.size(); ++m) {
    const Parameters::Entry& W = parameters.entry(name_of("W", m));
    for (const std::size_t value :
         {W.rows, units_before, W.first, parameters.entry(name_of("a", m)).first,
          transposed.entry(W.name).first})
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
    to.upload(name_of("W", m), W[m]);
    to.upload(name_of("a", m), a[m]);
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
    host.W[m] = from.to_host(name_of("W", m));
    host.a[m] = from.to_host(name_of("a", m));
  }
  host.b = from.to_host("b");
  return host;
}

std::vector<ParameterShape> Mrbm::parameter_shapes(const std::array<std::size_t, 2>& visible,
                                                   std::size_t hidden) {
  std::vector<ParameterShape> shapes;
  for (std::size_t m = 0; m < visible.size(); ++m) {
    shapes.push_back({.name = name_of("W", m), .rows = visible[m], .columns = hidden});
    shapes.push_back(
        {.name = name_of("a", m), .rows = 1, .columns = visible[m], .is_weight = false});
  }
  shapes.push_back({.name = "b", .rows = 1, .columns = hidden, .is_weight = false});
  return shapes;
}

Mrbm::Mrbm(Device& device, const MrbmParameters& start) : Mrbm(uploaded(device, start)) {}

MrbmMatrices::MrbmMatrices(const Parameters& parameters) : b(parameters.matrix("b")) {
  for (std::size_t m = 0; m < 2; ++m) {
    W[m] = parameters.matrix(name_of("W", m));
    a[m] = parameters.matrix(name_of("a", m));
  }
}

Mrbm::Mrbm(const Parameters& parameters)
    : MrbmMatrices(parameters),
      parameters_(parameters),
      transposed_(parameters.device(), transposed_shapes(parameters)),
      layout_(parameters.device(), layout_of(parameters_, transposed_)) {
  for (std::size_t m = 0; m < 2; ++m) W_transposed[m] = transposed_.matrix(name_of("W", m));
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
