#include "comparison/dbm_machine.hpp"

#include <string>

#include "device/gemm.hpp"
#include "device/pointwise.hpp"
#include "mcdbn/motion_model/training_sources.hpp"

namespace mcdbn {
namespace {

/// `W_track`
std::string name_of(const char* letter, std::size_t m) {
  return std::string(letter) + "_" + kModalityNames[m];
}

std::vector<ParameterShape> parameter_shapes(const BimodalShape& shape) {
  std::vector<ParameterShape> shapes;
  for (std::size_t m = 0; m < 2; ++m) {
    shapes.push_back(
        {.name = name_of("W", m), .rows = shape.visible[m], .columns = shape.hidden[m]});
    shapes.push_back({.name = name_of("U", m), .rows = shape.hidden[m], .columns = shape.top});
    shapes.push_back(
        {.name = name_of("a", m), .rows = 1, .columns = shape.visible[m], .is_weight = false});
    shapes.push_back(
        {.name = name_of("b", m), .rows = 1, .columns = shape.hidden[m], .is_weight = false});
  }
  shapes.push_back({.name = "c", .rows = 1, .columns = shape.top, .is_weight = false});
  return shapes;
}

/// Draws beside the values, or in their place.
void draw(GemmOptions& options, Sampling sampling, const RandomKey& key, const Rows& sample) {
  options.sampling = sampling;
  options.sample = &sample;
  options.random = key;
}

}  // namespace

DbmMachine::Pathway::Pathway(const Parameters& parameters, std::size_t modality)
    : W(parameters.matrix(name_of("W", modality))),
      U(parameters.matrix(name_of("U", modality))),
      a(parameters.matrix(name_of("a", modality))),
      b(parameters.matrix(name_of("b", modality))) {}

DbmMachine::Units::Units(Device& device, const BimodalShape& shape, std::size_t rows)
    : joint(device, rows, shape.top) {
  for (std::size_t m = 0; m < 2; ++m) {
    visible[m] = Matrix(device, rows, shape.visible[m]);
    hidden[m] = Matrix(device, rows, shape.hidden[m]);
    hidden_draws[m] = Matrix::like(hidden[m]);
    input_from_below[m] = Matrix::like(hidden[m]);
  }
}

DbmMachine::DbmMachine(Device& device, const BimodalShape& shape, RandomKey key)
    : shape_(shape),
      parameters_(device, parameter_shapes(shape)),
      pathways_{Pathway(parameters_, 0), Pathway(parameters_, 1)},
      c_(parameters_.matrix("c")) {
  constexpr double kDeviation = 0.01;
  for (const Parameters::Entry& entry : parameters_.entries()) {
    if (!entry.is_weight) continue;
    ++key.step;
    MatrixF weights(entry.rows, entry.columns);
    for (Eigen::Index r = 0; r < weights.rows(); ++r)
      for (Eigen::Index c = 0; c < weights.cols(); ++c)
        weights(r, c) =
            static_cast<float>(kDeviation * random_normal(key, static_cast<std::uint32_t>(r),
                                                          static_cast<std::uint32_t>(c)));
    parameters_.upload(entry.name, weights);
  }
  for (std::size_t m = 0; m < 2; ++m) {
    W_transposed_[m] = Matrix(device, shape.hidden[m], shape.visible[m]);
    U_transposed_[m] = Matrix(device, shape.top, shape.hidden[m]);
  }
  refresh_transposed();
}

void DbmMachine::refresh_transposed() {
  for (std::size_t m = 0; m < 2; ++m) {
    transpose(pathways_[m].W, W_transposed_[m]);
    transpose(pathways_[m].U, U_transposed_[m]);
  }
}

void DbmMachine::set_input_from_below(std::size_t m, Units& units, float scale) const {
  GemmOptions options;
  options.alpha = scale;
  options.bias = &pathways_[m].b;
  gemm(units.visible[m], pathways_[m].W, units.input_from_below[m], options);
}

void DbmMachine::infer_hidden(std::size_t m, Units& units, const RandomKey* draws) const {
  GemmOptions options;
  options.bias = &units.input_from_below[m];
  options.activation = Activation::sigmoid;
  const Rows sample = units.hidden_draws[m];
  if (draws) draw(options, Sampling::bernoulli, *draws, sample);
  gemm(units.joint, U_transposed_[m], units.hidden[m], options);
}

void DbmMachine::infer_hidden_from_below(std::size_t m, Units& units,
                                         const RandomKey* draws) const {
  GemmOptions options;
  options.activation = Activation::sigmoid;
  const Rows sample = units.hidden_draws[m];
  if (draws) draw(options, Sampling::bernoulli, *draws, sample);
  units.hidden[m].copy_from(units.input_from_below[m]);
  apply_epilogue(units.hidden[m], options);
}

void DbmMachine::infer_hidden_from_above(std::size_t m, Units& units) const {
  GemmOptions options;
  options.alpha = 2.0F;
  options.bias = &pathways_[m].b;
  options.activation = Activation::sigmoid;
  gemm(units.joint, U_transposed_[m], units.hidden[m], options);
}

void DbmMachine::infer_joint(const std::array<Matrix, 2>& hidden, Units& units,
                             const RandomKey* draws) const {
  gemm(hidden[0], pathways_[0].U, units.joint);
  GemmOptions options;
  options.beta = 1.0F;
  options.bias = &c_;
  options.activation = Activation::sigmoid;
  const Rows sample = units.joint;
  if (draws) draw(options, Sampling::bernoulli, *draws, sample);
  gemm(hidden[1], pathways_[1].U, units.joint, options);
}

void DbmMachine::infer_visible(std::size_t m, const Matrix& hidden, Units& units,
                               const RandomKey* draws) const {
  GemmOptions options;
  options.bias = &pathways_[m].a;
  const Rows sample = units.visible[m];
  if (draws) draw(options, Sampling::gaussian, *draws, sample);
  gemm(hidden, W_transposed_[m], units.visible[m], options);
}

void DbmMachine::mean_field(Units& units, std::size_t absent, std::size_t steps) const {
  if (absent != kNoneAbsent)
    units.visible[absent] = Matrix::filled_with_row(pathways_[absent].a, units.joint.rows());
  for (std::size_t m = 0; m < 2; ++m) {
    set_input_from_below(m, units);
    infer_hidden_from_below(m, units);
  }
  for (std::size_t step = 0; step < steps; ++step) {
    infer_joint(units.hidden, units);
    if (absent != kNoneAbsent) {
      infer_visible(absent, units.hidden[absent], units);
      set_input_from_below(absent, units);
    }
    for (std::size_t m = 0; m < 2; ++m) infer_hidden(m, units);
  }
  infer_joint(units.hidden, units);
  if (absent != kNoneAbsent) infer_visible(absent, units.hidden[absent], units);
}

void DbmMachine::gibbs_sweep(Units& chains, RandomKey draws) const {
  for (std::size_t m = 0; m < 2; ++m, ++draws.phase) {
    set_input_from_below(m, chains);
    infer_hidden(m, chains, &draws);
  }
  for (std::size_t m = 0; m < 2; ++m, ++draws.phase)
    infer_visible(m, chains.hidden_draws[m], chains, &draws);
  infer_joint(chains.hidden_draws, chains, &draws);
}

void DbmMachine::add_energy_gradient(const Units& units, float scale, float beta,
                                     const Parameters& gradients) const {
  for (std::size_t m = 0; m < 2; ++m) {
    Pathway gradient(gradients, m);
    gemm_transposed_a(units.visible[m], units.hidden[m], gradient.W, -scale, beta);
    gemm_transposed_a(units.hidden[m], units.joint, gradient.U, -scale, beta);
    // a's, but for its own value, which data and chains share.
    column_sum(units.visible[m], -scale, beta, gradient.a);
    column_sum(units.hidden[m], -scale, beta, gradient.b);
  }
  Matrix gradient_c = gradients.matrix("c");
  column_sum(units.joint, -scale, beta, gradient_c);
}

}  // namespace mcdbn
