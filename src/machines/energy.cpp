#include "mcdbn/machines/energy.hpp"

#include "base/random_streams.hpp"
#include "device/gemm.hpp"
#include "machines/energy_kernel.hpp"
#include "machines/own_units.hpp"
#include "machines/sequence_blocks.hpp"
#include "mcdbn/base/random.hpp"

namespace mcdbn {
namespace {

/// Free energies of rows under dynamic biases that are known.
class RowEnergies {
 public:
  /// @param rows whose histories count
  RowEnergies(const Crbm& crbm, const Rows& rows)
      : crbm_(crbm),
        visible_bias_(crbm.device(), rows.count, crbm.shape().visible),
        hidden_bias_(crbm.device(), rows.count, crbm.shape().hidden),
        input_(Matrix::like(hidden_bias_)) {
    crbm.dynamic_visible_bias(rows, visible_bias_);
    crbm.dynamic_hidden_bias(rows, hidden_bias_);
  }

  /// @param visible [rows x visible], not indexed, in place of the rows'  @param out [rows x 1]
  void write(const Rows& visible, const Rows& out) const {
    GemmOptions bias;
    bias.bias = &hidden_bias_;
    gemm(visible, crbm_.W, input_, bias);
    launch(crbm_.device(), energy_kernel(crbm_.device(), "free_energy", crbm_.shape().kind),
           {{visible.count, 1}}, visible.matrix->buffer(), visible.offset(), visible.stride(),
           visible_bias_.buffer(), to_int(visible_bias_.stride()), to_int(crbm_.shape().visible),
           input_.buffer(), to_int(input_.stride()), to_int(crbm_.shape().hidden),
           out.matrix->buffer(), out.offset(), out.stride(), 0);
  }

 private:
  const Crbm& crbm_;
  Matrix visible_bias_, hidden_bias_, input_;
};

Sequences one_number_a_frame(const Crbm& crbm, const Sequences& visible) {
  require(visible.values.columns() == crbm.shape().visible,
          "free energy: the frames do not fit the machine");
  return {Matrix(crbm.device(), visible.values.rows(), 1), visible.clips,
          visible.valid_from + crbm.shape().order};
}

/// A unit for each of `count` rows from `first` on, all equally likely.
IndexBuffer drawn_units(const Crbm& crbm, std::size_t first, std::size_t count,
                        std::uint64_t seed) {
  const RandomKey key{seed, 0, random_streams::kFlippedUnits, 0};
  std::vector<std::int32_t> units(count);
  for (std::size_t r = 0; r < count; ++r)
    units[r] = static_cast<std::int32_t>(
        random_bits(key, static_cast<std::uint32_t>(first + r), 0) % crbm.shape().visible);
  return {crbm.device(), units};
}

}  // namespace

Sequences free_energy(const Crbm& crbm, const Sequences& visible) {
  Sequences energies = one_number_a_frame(crbm, visible);
  const Matrix values = in_own_units(crbm, visible.values);
  for (const auto& block : blocks_from(visible.clips, energies.valid_from, kRowsAtOnce)) {
    const Rows rows(values, block.first, block.frames);
    RowEnergies{crbm, rows}.write(rows, Rows(energies.values, block.first, block.frames));
  }
  return energies;
}

Sequences free_energy(const Cdbn& cdbn, const Sequences& visible) {
  require(!cdbn.layers.empty(), "CDBN: no layers");
  Sequences code = visible;
  for (std::size_t i = 0; i + 1 < cdbn.layers.size(); ++i) code = up_pass(cdbn.layers[i], code);
  return free_energy(cdbn.layers.back(), code);
}

Sequences pseudo_log_likelihood(const Crbm& crbm, const Sequences& visible, std::uint64_t seed) {
  require(crbm.shape().kind == VisibleKind::binary,
          "pseudo-likelihood: only of machines of binary units");
  const Sequences energies = free_energy(crbm, visible);
  Sequences result = one_number_a_frame(crbm, visible);
  for (const auto& block : blocks_from(visible.clips, result.valid_from, kRowsAtOnce)) {
    const Rows rows(visible.values, block.first, block.frames);
    const IndexBuffer units = drawn_units(crbm, block.first, block.frames, seed);
    Matrix flipped(crbm.device(), block.frames, crbm.shape().visible);
    flipped.copy_rows_from(visible.values, block.first, block.frames, 0);
    launch(crbm.device(), energy_kernel(crbm.device(), "flip_units", crbm.shape().kind),
           {{block.frames, 1}}, flipped.buffer(), to_int(flipped.stride()), units.buffer());
    const Matrix other(crbm.device(), block.frames, 1);
    RowEnergies{crbm, rows}.write(flipped, other);
    const Rows own(energies.values, block.first, block.frames);
    const Rows out(result.values, block.first, block.frames);
    launch(crbm.device(), energy_kernel(crbm.device(), "log_sigmoid_difference", crbm.shape().kind),
           {{block.frames, 1}}, other.buffer(), to_int(other.stride()), own.matrix->buffer(),
           own.offset(), own.stride(), static_cast<float>(crbm.shape().visible),
           out.matrix->buffer(), out.offset(), out.stride());
  }
  return result;
}

}  // namespace mcdbn
