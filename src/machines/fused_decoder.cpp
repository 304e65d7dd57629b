// The down-pass as one launch a layer (cdbn_decoder.cl).

#include <fmt/format.h>

#include <algorithm>

#include "base/random_streams.hpp"
#include "device/kernel_arguments.hpp"
#include "machines/cdbn_decoder.hpp"
#include "machines/crbm_defines.hpp"

namespace mcdbn {
namespace {

/// @param order_B history that the hidden units see; 0 where they are not asked
cl::Kernel& decoder_kernel(const Crbm& layer, const char* name, std::size_t order_B,
                           const RowTile& tile) {
  Defines defines = crbm_row_defines(layer.shape(), tile);
  defines["ORDER_B"] = to_int(order_B);
  return layer.device().programs().kernel("cdbn_decoder.cl", name, defines);
}

LaunchSize size_for(std::size_t sequences, const RowTile& tile) {
  const auto group = static_cast<std::size_t>(tile.group);
  return {{ceil_divide(sequences, static_cast<std::size_t>(tile.rows)) * group, 1}, {group, 1}};
}

}  // namespace

/// One for each layer, if every layer can be fused: only binary units are sampled in a launch.
std::optional<std::vector<RowTile>> CdbnDecoder::fused_tiles(bool sampled) const {
  std::vector<RowTile> tiles;
  for (const Crbm& layer : cdbn_.layers) {
    const CrbmShape& shape = layer.shape();
    const bool samples = sampled && &layer == &cdbn_.layers.back();
    if (shape.order_A() == 0) return std::nullopt;
    if (samples && (shape.order_B() == 0 || shape.kind != VisibleKind::binary)) return std::nullopt;
    const std::size_t order = std::max(shape.order_A(), samples ? shape.order_B() : 0);
    const std::size_t ring = order * padded(shape.visible);
    const std::size_t states = samples ? padded(shape.visible) + padded(shape.hidden) : 0;
    const auto tile =
        choose_row_tile(layer.device(), ring + states, sequences_,
                        fmt::format("decoder of {} units, order {}", shape.visible, order));
    if (!tile) return std::nullopt;
    tiles.push_back(*tile);
  }
  return tiles;
}

void CdbnDecoder::fused_decode(std::size_t first, std::size_t last,
                               const RegenerationOptions& options,
                               const std::vector<RowTile>& tiles) {
  const bool sampled = options.samples_decoder();
  for (std::size_t i = cdbn_.layers.size(); i-- > 0;) {
    if (sampled && i + 1 == cdbn_.layers.size())
      fused_samples(first, last, options, tiles[i]);
    else
      fused_means(i, first, last, tiles[i]);
  }
}

void CdbnDecoder::fused_means(std::size_t layer, std::size_t first, std::size_t last,
                              const RowTile& tile) {
  set_input_from_above(layer, first, last);
  const Crbm& crbm = cdbn_.layers[layer];
  launch(crbm.device(), decoder_kernel(crbm, "decode_means", 0, tile), size_for(sequences_, tile),
         states_[layer].buffer(), states_[layer].buffer(), to_int(frames_), 0, to_int(sequences_),
         to_int(frames_), to_int(first), to_int(last), crbm.A.buffer());
}

void CdbnDecoder::fused_samples(std::size_t first, std::size_t last,
                                const RegenerationOptions& options, const RowTile& tile) {
  const Crbm& top = cdbn_.layers.back();
  const std::size_t rows = whole_blocks(sequences_, tile);
  if (below_bias_.rows() != rows) {
    below_bias_ = Matrix(top.device(), rows, top.shape().visible);
    top_bias_ = Matrix(top.device(), rows, top.shape().hidden);
  }
  const RandomKey key{options.seed, 0, random_streams::kDecoder,
                      0};  // the kernel fills in the frame and the phase
  launch(top.device(), decoder_kernel(top, "decode_samples", top.shape().order_B(), tile),
         size_for(sequences_, tile), states_.back().buffer(), code_.buffer(), to_int(sequences_),
         to_int(frames_), to_int(first), to_int(last), top.W.buffer(), top.W_transposed.buffer(),
         top.A.buffer(), top.B.buffer(), top.a.buffer(), top.b.buffer(), below_bias_.buffer(),
         top_bias_.buffer(), to_int(options.sampling.gibbs_steps),
         static_cast<float>(options.drawn_share()), random_argument(key));
}

}  // namespace mcdbn
