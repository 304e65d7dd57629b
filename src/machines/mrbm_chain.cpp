#include "machines/mrbm_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/random_phases.hpp"
#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "machines/mean_field.hpp"

namespace mcdbn {
namespace {

std::size_t largest_modality(const Mrbm& mrbm) {
  std::size_t units = 0;
  for (const Modality& modality : mrbm.shape().modalities)
    units = std::max(units, modality.visible);
  return units;
}

bool is_binary(const Modality& modality) {
  return modality.kind == VisibleKind::binary;
}

/// A block's local memory holds its hidden units and those of either modality. Clips are of any
/// length: rounded up, they share a few tiles, and a tile that is new costs a compilation.
std::optional<RowTile> choose_tile(const Mrbm& mrbm, const std::vector<bool>& present,
                                   std::size_t rows) {
  constexpr std::size_t kManyRows = 1024;  // so many keep every compute unit busy in any case
  const auto& modalities = mrbm.shape().modalities;
  if (present.size() != 2 || present[0] == present[1] ||
      !std::all_of(modalities.begin(), modalities.end(), is_binary))
    return std::nullopt;
  return choose_row_tile(mrbm.device(), padded(largest_modality(mrbm)) + padded(mrbm.hidden()),
                         std::min<std::size_t>(std::bit_ceil(rows), kManyRows),
                         fmt::format("clamped chain of {} + {} visible, {} hidden units",
                                     mrbm.visible(0), mrbm.visible(1), mrbm.hidden()));
}

std::vector<std::size_t> indices_where(const std::vector<bool>& flags, bool value) {
  std::vector<std::size_t> indices;
  for (std::size_t m = 0; m < flags.size(); ++m)
    if (flags[m] == value) indices.push_back(m);
  return indices;
}

/// The epilogue of a pass: means, and with a temperature their draws in their place.
GemmOptions units_options(VisibleKind kind, const Rows& units, const MrbmChainOptions& options,
                          std::size_t pass) {
  GemmOptions epilogue = mean_of_units(kind);
  if (options.temperature == 0.0F) return epilogue;
  epilogue.sampling = kind == VisibleKind::binary ? options.sampling : Sampling::gaussian;
  epilogue.sample = &units;
  epilogue.temperature = options.temperature;
  epilogue.random = options.random;
  const std::size_t phase = options.random.phase + pass;
  epilogue.random.phase = static_cast<std::uint16_t>(phase % random_phases::kPhasesOfChain);
  epilogue.random.step +=
      static_cast<std::uint32_t>(phase / random_phases::kPhasesOfChain) * options.steps_apart;
  return epilogue;
}

}  // namespace

MrbmChain::MrbmChain(const Mrbm& mrbm, const std::vector<bool>& present, std::size_t largest_rows)
    : MrbmChain(mrbm, present, largest_rows, choose_tile(mrbm, present, largest_rows)) {}

MrbmChain::MrbmChain(const Mrbm& mrbm, const std::vector<bool>& present, std::size_t largest_rows,
                     std::optional<RowTile> tile)
    : mrbm_(mrbm),
      present_(indices_where(present, true)),
      absent_(indices_where(present, false)),
      largest_rows_(largest_rows),
      tile_(tile),
      present_input_(mrbm.device(), whole_blocks(largest_rows, tile), mrbm.hidden()) {
  require(present.size() == mrbm.modality_count() && !absent_.empty(),
          "MRBM chain: needs to know of every modality whether it is there, and one that is not");
  require(!tile_ || (present_.size() == 1 && absent_.size() == 1),
          "MRBM chain: only two modalities are fused");
  if (!tile_) hidden_ = Matrix::like(present_input_);
}

void MrbmChain::check(const std::vector<Rows>& modalities, const MrbmChainOptions& options) const {
  require(modalities.size() == mrbm_.modality_count(), "MRBM chain: needs every modality");
  for (std::size_t m = 0; m < modalities.size(); ++m) {
    require(modalities[m].columns == mrbm_.visible(m),
            "MRBM chain: the modalities do not fit the MRBM");
    require(modalities[m].count == modalities[0].count,
            "MRBM chain: the modalities differ in rows");
  }
  for (const std::size_t m : absent_)
    require(modalities[m].index == nullptr, "MRBM chain: the result may not be indexed");
  require(modalities[0].count <= largest_rows_, "MRBM chain: more rows than it was made for");
  require(options.steps > 0, "MRBM chain: needs at least one step");
  require(options.sampling == Sampling::bernoulli || options.sampling == Sampling::concrete,
          "MRBM chain: its binary units are drawn as such");
}

void MrbmChain::run(const std::vector<Rows>& modalities, const MrbmChainOptions& options) {
  check(modalities, options);
  if (modalities[0].count == 0) return;
  if (tile_)
    fused(modalities[present_[0]], options, modalities[absent_[0]]);
  else
    composed(modalities, options);
}

Defines shape_defines(const Mrbm& mrbm) {
  const auto& modalities = mrbm.shape().modalities;
  Defines defines{{"MODALITIES", to_int(modalities.size())},
                  {"LARGEST", to_int(largest_modality(mrbm))},
                  {"HIDDEN", to_int(mrbm.hidden())},
                  {"BINARY", std::all_of(modalities.begin(), modalities.end(), is_binary) ? 1 : 0}};
  if (std::all_of(modalities.begin(), modalities.end(),
                  [&](const Modality& m) { return m.visible == modalities[0].visible; }))
    defines["VISIBLE"] = to_int(modalities[0].visible);
  return defines;
}

void MrbmChain::fused(const Rows& present, const MrbmChainOptions& options, const Rows& absent) {
  Device& device = mrbm_.device();
  Defines defines = shape_defines(mrbm_);
  defines["VEC"] = tile_->vector_width;
  defines["SAMPLE"] = static_cast<int>(options.sampling);
  cl::Kernel& kernel =
      device.programs().kernel("mrbm_inference.cl", "clamped_chain", with_tile(defines, *tile_));
  const auto group = static_cast<std::size_t>(tile_->group);
  const std::size_t blocks = ceil_divide(present.count, static_cast<std::size_t>(tile_->rows));
  // Without an index its argument still needs a buffer.
  const cl::Buffer& index = present.index ? present.index->buffer() : present_input_.buffer();
  launch(device, kernel, {{blocks * group, 1}, {group, 1}}, present.matrix->buffer(),
         present.offset(), present.stride(), index, present.index ? 1 : 0,
         to_int(present.index_first), present.shift, to_int(present.count), mrbm_.layout().buffer(),
         to_int(present_[0]), to_int(absent_[0]), mrbm_.parameters().all().buffer(),
         mrbm_.transposed().all().buffer(), present_input_.buffer(), absent.matrix->buffer(),
         absent.offset(), absent.stride(), to_int(options.steps), options.temperature,
         random_argument(options.random), options.steps_apart);
}

void MrbmChain::composed(const std::vector<Rows>& modalities, const MrbmChainOptions& options) {
  const std::size_t count = modalities[0].count, passes = 1 + absent_.size();
  const Rows present_input(present_input_, 0, count), hidden(hidden_, 0, count);
  if (present_.empty()) {
    GemmOptions alone;
    alone.bias = &mrbm_.b;
    present_input_.set_zero();
    apply_epilogue(present_input, alone);
  } else {
    present_input_of(mrbm_, present_, modalities, present_input);
  }
  for (std::size_t step = 0; step < options.steps; ++step) {
    std::size_t pass = step * passes;
    const GemmOptions up = units_options(VisibleKind::binary, hidden, options, pass);
    if (step > 0) {
      shared_units(mrbm_, absent_, modalities, present_input_, up, hidden);
    } else {  // the absent modalities are zeros
      hidden_.copy_rows_from(present_input_, 0, count, 0);
      apply_epilogue(hidden, up);
    }
    for (const std::size_t m : absent_) {
      GemmOptions down = units_options(mrbm_.kind(m), modalities[m], options, ++pass);
      if (step + 1 == options.steps) {
        down.sampling = Sampling::none;
        down.sample = nullptr;
      }
      absent_units(mrbm_, m, hidden, down, modalities[m]);
    }
  }
}

}  // namespace mcdbn
