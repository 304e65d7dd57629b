#include "mcdbn/machines/mrbm.hpp"

#include <algorithm>

#include "device/pointwise.hpp"
#include "machines/mrbm_chain.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// "W_track"
std::string name_of(const char* letter, const Modality& modality) {
  return std::string(letter) + '_' + modality.name;
}

std::vector<ParameterShape> transposed_shapes(const MrbmShape& shape) {
  std::vector<ParameterShape> shapes;
  for (const Modality& modality : shape.modalities)
    shapes.push_back(
        {.name = name_of("W", modality), .rows = shape.hidden, .columns = modality.visible});
  return shapes;
}

/// The ints that mrbm_shape.clh describes.
std::vector<std::int32_t> layout_of(const MrbmShape& shape, const Parameters& parameters,
                                    const Parameters& transposed) {
  std::vector<std::int32_t> layout;
  std::size_t units_before = 0;
  for (const Modality& modality : shape.modalities) {
    const std::string W = name_of("W", modality);
    for (const std::size_t value :
         {modality.visible, units_before, parameters.entry(W).first,
          parameters.entry(name_of("a", modality)).first, transposed.entry(W).first,
          std::size_t{modality.kind == VisibleKind::gaussian ? 1U : 0U}})
      layout.push_back(static_cast<std::int32_t>(value));
    units_before += padded(modality.visible);
  }
  layout.push_back(static_cast<std::int32_t>(parameters.entry("b").first));
  return layout;
}

Parameters uploaded(Device& device, const MrbmParameters& start) {
  start.shape.check();
  Parameters parameters(device, Mrbm::parameter_shapes(start.shape));
  start.write(parameters);
  return parameters;
}

}  // namespace

void MrbmShape::check() const {
  if (modalities.size() < 2) throw ShapeError("MRBM: needs two modalities or more");
  for (auto one = modalities.begin(); one != modalities.end(); ++one)
    if (std::any_of(modalities.begin(), one,
                    [&](const Modality& other) { return other.name == one->name; }))
      throw ShapeError("MRBM: two modalities are called " + one->name);
}

MrbmParameters MrbmParameters::zeros(const MrbmShape& shape) {
  const auto hidden = static_cast<Eigen::Index>(shape.hidden);
  MrbmParameters parameters{shape, {}, {}, MatrixF::Zero(1, hidden)};
  for (const Modality& modality : shape.modalities) {
    const auto visible = static_cast<Eigen::Index>(modality.visible);
    parameters.W.emplace_back(MatrixF::Zero(visible, hidden));
    parameters.a.emplace_back(MatrixF::Zero(1, visible));
  }
  return parameters;
}

MrbmParameters MrbmParameters::random(const MrbmShape& shape, double deviation,
                                      const RandomKey& key) {
  MrbmParameters parameters = zeros(shape);
  for (std::size_t m = 0; m < shape.modalities.size(); ++m) {
    RandomKey own = key;
    own.step += static_cast<std::uint32_t>(m);
    parameters.W[m] =
        CrbmParameters::random({shape.modalities[m].visible, shape.hidden}, deviation, own).W;
  }
  return parameters;
}

MrbmParameters MrbmParameters::read(const Parameters& from, const MrbmShape& shape) {
  MrbmParameters host{shape, {}, {}, from.to_host("b")};
  for (const Modality& modality : shape.modalities) {
    host.W.push_back(from.to_host(name_of("W", modality)));
    host.a.push_back(from.to_host(name_of("a", modality)));
  }
  return host;
}

void MrbmParameters::write(Parameters to) const {
  for (std::size_t m = 0; m < shape.modalities.size(); ++m) {
    to.upload(name_of("W", shape.modalities[m]), W[m]);
    to.upload(name_of("a", shape.modalities[m]), a[m]);
  }
  to.upload("b", b);
}

std::vector<ParameterShape> Mrbm::parameter_shapes(const MrbmShape& shape) {
  std::vector<ParameterShape> shapes;
  for (const Modality& modality : shape.modalities) {
    shapes.push_back(
        {.name = name_of("W", modality), .rows = modality.visible, .columns = shape.hidden});
    shapes.push_back({.name = name_of("a", modality),
                      .rows = 1,
                      .columns = modality.visible,
                      .is_weight = false});
  }
  shapes.push_back({.name = "b", .rows = 1, .columns = shape.hidden, .is_weight = false});
  return shapes;
}

MrbmMatrices::MrbmMatrices(const Parameters& parameters, const MrbmShape& shape)
    : b(parameters.matrix("b")) {
  for (const Modality& modality : shape.modalities) {
    W.push_back(parameters.matrix(name_of("W", modality)));
    a.push_back(parameters.matrix(name_of("a", modality)));
  }
}

Mrbm::Mrbm(Device& device, const MrbmParameters& start)
    : Mrbm(uploaded(device, start), start.shape) {}

Mrbm::Mrbm(const Parameters& parameters, const MrbmShape& shape)
    : MrbmMatrices(parameters, shape),
      shape_(shape),
      parameters_(parameters),
      transposed_(parameters.device(), transposed_shapes(shape)),
      layout_(parameters.device(), layout_of(shape, parameters_, transposed_)) {
  shape.check();
  for (const ParameterShape& copy : transposed_.entries())
    W_transposed.push_back(transposed_.matrix(copy.name));
  refresh_transposed();
}

MrbmParameters Mrbm::to_host() const {
  return MrbmParameters::read(parameters_, shape_);
}

void Mrbm::infer(const std::vector<Rows>& modalities, const std::vector<bool>& present,
                 std::size_t steps) const {
  MrbmChainOptions options;
  options.steps = std::max<std::size_t>(steps, 1);
  if (modalities.empty()) throw ShapeError("MRBM: no modalities to infer from");
  MrbmChain(*this, present, modalities.front().count).run(modalities, options);
}

void Mrbm::refresh_transposed() {
  for (std::size_t m = 0; m < W.size(); ++m) transpose(W[m], W_transposed[m]);
}

}  // namespace mcdbn
