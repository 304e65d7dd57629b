#include "machines/mrbm_chain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "device/gemm.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "machines/mean_field.hpp"

namespace mcdbn {
namespace {

/// A block's local memory holds its hidden units and those of either modality. Clips are of any
/// length: rounded up, they share a few tiles, and a tile that is new costs a compilation.
std::optional<RowTile> choose_tile(const Mrbm& mrbm, std::size_t rows) {
  constexpr std::size_t kManyRows = 1024;  // so many keep every compute unit busy in any case
  const std::size_t track = mrbm.visible(Modality::track), pose = mrbm.visible(Modality::pose);
  return choose_row_tile(
      mrbm.device(), padded(std::max(track, pose)) + padded(mrbm.hidden()),
      std::min<std::size_t>(std::bit_ceil(rows), kManyRows),
      fmt::format("clamped chain of {} + {} visible, {} hidden units", track, pose, mrbm.hidden()));
}

/// The epilogue of a pass: probabilities, and with a temperature their draws in their place.
GemmOptions units_options(const Rows& units, const MrbmChainOptions& options, std::size_t pass) {
  GemmOptions epilogue;
  epilogue.activation = Activation::sigmoid;
  if (options.temperature == 0.0F) return epilogue;
  epilogue.sampling = options.sampling;
  epilogue.sample = &units;
  epilogue.temperature = options.temperature;
  epilogue.random = options.random;
  epilogue.random.phase = static_cast<std::uint16_t>(options.random.phase + pass);
  return epilogue;
}

}  // namespace

MrbmChain::MrbmChain(const Mrbm& mrbm, Modality present, std::size_t largest_rows)
    : MrbmChain(mrbm, present, largest_rows, choose_tile(mrbm, largest_rows)) {}

MrbmChain::MrbmChain(const Mrbm& mrbm, Modality present, std::size_t largest_rows,
                     std::optional<RowTile> tile)
    : mrbm_(mrbm),
      present_(index_of(present)),
      absent_(index_of(other(present))),
      largest_rows_(largest_rows),
      tile_(tile),
      drive_(mrbm.device(), whole_blocks(largest_rows, tile), mrbm.hidden()) {
  if (!tile_) hidden_ = Matrix::like(drive_);
}

void MrbmChain::run(const Rows& present, const MrbmChainOptions& options, const Rows& absent) {
  require(present.columns == mrbm_.W[present_].rows() && absent.columns == mrbm_.W[absent_].rows(),
          "MRBM chain: the modalities do not fit the MRBM");
  require(present.count == absent.count, "MRBM chain: the modalities differ in rows");
  require(absent.index == nullptr, "MRBM chain: the result may not be indexed");
  require(present.count <= largest_rows_, "MRBM chain: more rows than it was made for");
  require(options.steps > 0, "MRBM chain: wants at least one step");
  require(options.sampling == Sampling::bernoulli || options.sampling == Sampling::concrete,
          "MRBM chain: its units are binary");
  if (present.count == 0) return;
  if (tile_)
    fused(present, options, absent);
  else
    composed(present, options, absent);
}

Defines shape_defines(const Mrbm& mrbm) {
  const std::array<int, 2> visible{to_int(mrbm.visible(Modality::track)),
                                   to_int(mrbm.visible(Modality::pose))};
  Defines defines{{"MODALITIES", to_int(visible.size())},
                  {"LARGEST", *std::max_element(visible.begin(), visible.end())},
                  {"HIDDEN", to_int(mrbm.hidden())}};
  if (std::equal(visible.begin() + 1, visible.end(), visible.begin()))
    defines["VISIBLE"] = visible.front();
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
  const cl::Buffer& index = present.index ? present.index->buffer() : drive_.buffer();
  launch(device, kernel, {{blocks * group, 1}, {group, 1}}, present.matrix->buffer(),
         present.offset(), present.stride(), index, present.index ? 1 : 0,
         to_int(present.index_first), present.shift, to_int(present.count), mrbm_.layout().buffer(),
         to_int(present_), to_int(absent_), mrbm_.parameters().all().buffer(),
         mrbm_.transposed().all().buffer(), drive_.buffer(), absent.matrix->buffer(),
         absent.offset(), absent.stride(), to_int(options.steps), options.doubled ? 1 : 0,
         options.temperature, random_argument(options.random));
}

void MrbmChain::composed(const Rows& present, const MrbmChainOptions& options, const Rows& absent) {
  const Rows drive(drive_, 0, present.count), hidden(hidden_, 0, present.count);
  drive_of(mrbm_, present_, present, drive);
  for (std::size_t step = 0; step < options.steps; ++step) {
    const GemmOptions up = units_options(hidden, options, 2 * step);
    if (step > 0) {
      shared_units(mrbm_, absent_, absent, drive_, up, hidden);
    } else if (options.doubled) {
      shared_units(mrbm_, present_, present, drive_, up, hidden);
    } else {
      hidden_.copy_rows_from(drive_, 0, present.count, 0);
      apply_epilogue(hidden, up);
    }
    GemmOptions down = units_options(absent, options, 2 * step + 1);
    if (step + 1 == options.steps) {
      down.sampling = Sampling::none;
      down.sample = nullptr;
    }
    absent_units(mrbm_, absent_, hidden, down, absent);
  }
}

}  // namespace mcdbn
