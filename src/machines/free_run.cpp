#include "machines/free_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/random_streams.hpp"
#include "device/kernel_arguments.hpp"
#include "device/row_tile.hpp"
#include "machines/crbm_defines.hpp"
#include "machines/unit_kinds.hpp"

namespace mcdbn {
namespace {

/// Rows of a sequence and where they are filled in.
struct RunFrames {
  std::size_t sequences, first, end;
};

/// The kernel fills in the frame and the phase.
RandomKey key_of(const GenerationOptions& options) {
  return {options.seed, 0, random_streams::kGeneration, 0};
}

std::optional<RowTile> choose_tile(const Crbm& crbm, std::size_t sequences) {
  const CrbmShape& shape = crbm.shape();
  const std::size_t order = std::max(shape.order_A(), shape.order_B());
  if (order == 0) return std::nullopt;
  return choose_row_tile(crbm.device(), (order + 1) * padded(shape.visible) + padded(shape.hidden),
                         sequences,
                         fmt::format("generation of {} visible, {} hidden units, order {}",
                                     shape.visible, shape.hidden, order));
}

void run_fused(const Crbm& crbm, const Matrix& state, const RunFrames& frames,
               const GenerationOptions& options, const RowTile& tile) {
  const CrbmShape& shape = crbm.shape();
  Device& device = crbm.device();
  cl::Kernel& kernel = device.programs().kernel("cdbn_generation.cl", "generate_frames",
                                                crbm_row_defines(shape, tile));
  const std::size_t rows = whole_blocks(frames.sequences, tile);
  const Matrix visible_bias(device, rows, shape.visible), hidden_bias(device, rows, shape.hidden);
  const auto group = static_cast<std::size_t>(tile.group);
  launch(device, kernel, {{rows / static_cast<std::size_t>(tile.rows) * group, 1}, {group, 1}},
         state.buffer(), to_int(frames.sequences), to_int(frames.end), to_int(frames.first),
         crbm.W.buffer(), crbm.W_transposed.buffer(), crbm.A.buffer(), crbm.B.buffer(),
         crbm.a.buffer(), crbm.b.buffer(), visible_bias.buffer(), hidden_bias.buffer(),
         to_int(options.gibbs_steps), static_cast<float>(options.temperature),
         random_argument(key_of(options)));
}

void run_composed(const Crbm& crbm, const Matrix& state, const RunFrames& frames,
                  const GenerationOptions& options) {
  const Matrix hidden(crbm.device(), frames.sequences, crbm.shape().hidden);
  const Matrix sample = Matrix::like(hidden), hidden_bias = Matrix::like(hidden);
  const Matrix visible_bias(crbm.device(), frames.sequences, crbm.shape().visible);
  const Rows hidden_sample(sample);
  GemmOptions up = mean_of_units(VisibleKind::binary), down = mean_of_units(crbm.shape().kind);
  up.bias = &hidden_bias;
  up.temperature = static_cast<float>(options.temperature);
  up.random = key_of(options);
  down.bias = &visible_bias;
  for (std::size_t frame = frames.first; frame < frames.end; ++frame) {
    const auto at = [&](std::size_t t) {
      return Rows::strided(state, t, frames.sequences, frames.end);
    };
    crbm.dynamic_visible_bias(at(frame), visible_bias);
    crbm.dynamic_hidden_bias(at(frame), hidden_bias);
    up.random.step = static_cast<std::uint32_t>(frame - frames.first);
    for (std::size_t k = 0; k <= options.gibbs_steps; ++k) {
      const bool draws = k < options.gibbs_steps && options.temperature != 0.0;
      up.sampling = draws ? Sampling::bernoulli : Sampling::none;
      up.sample = draws ? &hidden_sample : nullptr;
      up.random.phase = static_cast<std::uint16_t>(k);
      gemm(at(k == 0 ? frame - 1 : frame), crbm.W, hidden, up);
      gemm(draws ? sample : hidden, crbm.W_transposed, at(frame), down);
    }
  }
}

}  // namespace

void run_freely(const Crbm& crbm, const Matrix& state, std::size_t sequences, std::size_t first,
                const GenerationOptions& options, bool fused) {
  require(sequences > 0 && state.rows() % sequences == 0 && state.columns() == crbm.shape().visible,
          "generation: the sequences do not fit the CRBM");
  require(first >= std::max<std::size_t>(crbm.shape().order, 1),
          "generation: the seed has fewer frames than the order");
  const RunFrames frames{sequences, first, state.rows() / sequences};
  if (first >= frames.end) return;
  const auto tile = fused ? choose_tile(crbm, sequences) : std::nullopt;
  if (tile)
    run_fused(crbm, state, frames, options, *tile);
  else
    run_composed(crbm, state, frames, options);
}

}  // namespace mcdbn
