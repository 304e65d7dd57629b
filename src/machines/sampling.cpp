#include "mcdbn/machines/sampling.hpp"

#include <algorithm>
#include <limits>
#include <span>

#include "base/random_streams.hpp"
#include "device/kernel_arguments.hpp"
#include "machines/gibbs_chain.hpp"
#include "machines/own_units.hpp"
#include "machines/sequence_blocks.hpp"

namespace mcdbn {
namespace {

using Layers = std::span<const Crbm>;

Layers layers_of(const Crbm& crbm) {
  return {&crbm, 1};
}

Layers layers_of(const Cdbn& cdbn) {
  require(!cdbn.layers.empty(), "CDBN: no layers");
  return cdbn.layers;
}

/// Draws of a step of a chain, one after another: no two share a key.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : key_{seed, 0, random_streams::kChains, 0} {}
  void next_step() {
    ++key_.step;
    key_.phase = 0;
  }
  RandomKey next() {
    const RandomKey key = key_;
    ++key_.phase;
    return key;
  }

 private:
  RandomKey key_;
};

/// out = given, or `other` where that is NaN.
void where_given(const Rows& given, const Rows& other, const Rows& out) {
  Device& device = out.matrix->device();
  cl::Kernel& kernel =
      device.programs().kernel("sampling.cl", "where_given", {{"VEC", vector_width(device)}});
  const LaunchSize size{
      {ceil_divide(out.columns, static_cast<std::size_t>(vector_width(device))), out.count}};
  launch(device, kernel, size, given.matrix->buffer(), given.offset(), given.stride(),
         other.matrix->buffer(), other.offset(), other.stride(), to_int(out.columns),
         out.matrix->buffer(), out.offset(), out.stride());
}

Sequences reconstructed(Layers layers, const Sequences& visible, std::size_t steps) {
  require(steps > 0, "reconstruct: needs at least one step");
  const Matrix own = in_own_units(layers.front(), visible.values);
  std::vector<Sequences> codes{visible};
  for (const Crbm& layer : layers.first(layers.size() - 1))
    codes.push_back(up_pass(layer, codes.back()));
  const std::size_t valid_from = codes.back().valid_from + layers.back().shape().order;
  Sequences above;
  for (std::size_t i = layers.size(); i-- > 0;) {
    const bool is_top = i + 1 == layers.size();
    Sequences result{Matrix::like(codes[i].values), visible.clips, valid_from};
    for (const auto& block : blocks_from(visible.clips, valid_from)) {
      const Rows data(i == 0 ? own : codes[i].values, block.first, block.frames);
      const Rows out(result.values, block.first, block.frames);
      GibbsChain chain(layers[i], block.frames);
      chain.take_history(data);
      if (!is_top) {
        chain.infer_visible(Rows(above.values, block.first, block.frames), out);
        continue;
      }
      for (std::size_t step = 0; step < steps; ++step) {
        chain.infer_hidden(step == 0 ? data : out);
        chain.infer_visible(out);
      }
    }
    above = std::move(result);
  }
  to_data_units(layers.front(), above.values);
  return above;
}

/// Sequences side by side, `history` frames and then as many as the longest has: frame t of all of
/// them is one strided block of rows.
struct Grid {
  std::size_t sequences = 0, history = 0;
  std::size_t frames = 0;  ///< of a sequence, its history included

  Rows at(const Matrix& matrix, std::size_t frame) const {
    return Rows::strided(matrix, frame, sequences, frames);
  }
  /// All at the layer's training mean.
  Matrix filled(const Crbm& layer) const {
    return Matrix::filled_with_row(in_own_units(layer, layer.visible_mean), sequences * frames);
  }
};

/// Without a history every row is a sequence of its own.
std::vector<Sequences::Clip> sequences_of(const Sequences& given, std::size_t history) {
  if (history > 0) return given.clips;
  std::vector<Sequences::Clip> rows(given.values.rows());
  for (std::size_t r = 0; r < rows.size(); ++r) rows[r] = {r, 1};
  return rows;
}

/// Sequences of a grid, and back; what a sequence does not reach is NaN.
Matrix on_grid(const Grid& grid, const Sequences& given,
               const std::vector<Sequences::Clip>& sequences) {
  const MatrixF values = given.values.to_host();
  MatrixF all = MatrixF::Constant(static_cast<Eigen::Index>(grid.sequences * grid.frames),
                                  values.cols(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < sequences.size(); ++i)
    all.middleRows(static_cast<Eigen::Index>(i * grid.frames + grid.history),
                   static_cast<Eigen::Index>(sequences[i].frames)) =
        values.middleRows(static_cast<Eigen::Index>(sequences[i].first),
                          static_cast<Eigen::Index>(sequences[i].frames));
  return Matrix::from_host(given.values.device(), all);
}

/// The units of all layers for the frame that is being drawn, and their histories.
class ClampedStack {
 public:
  ClampedStack(Layers layers, const Sequences& given, const ChainSettings& settings)
      : layers_(layers), settings_(settings), draws_(settings.seed) {
    require(given.values.columns() == layers.front().shape().visible,
            "sample: the frames do not fit the machine");
    require(settings.steps > 0, "sample: needs at least one step");
    for (const Crbm& layer : layers) grid_.history = std::max(grid_.history, layer.shape().order);
    const auto sequences = sequences_of(given, grid_.history);
    grid_.sequences = sequences.size();
    for (const auto& sequence : sequences) grid_.frames = std::max(grid_.frames, sequence.frames);
    grid_.frames += grid_.history;
    given_ = in_own_units(layers.front(), on_grid(grid_, given, sequences));
    for (const Crbm& layer : layers) {
      states_.push_back(grid_.filled(layer));
      chains_.emplace_back(layer, grid_.sequences);
    }
    drawn_ = Matrix(given_.device(), grid_.sequences, layers.front().shape().visible);
    for (std::size_t t = grid_.history; t < grid_.frames; ++t) draw_frame(t);
    result_ = {Matrix::like(given.values), given.clips, 0};
    for (std::size_t i = 0; i < sequences.size(); ++i)
      result_.values.copy_rows_from(states_.front(), i * grid_.frames + grid_.history,
                                    sequences[i].frames, sequences[i].first);
    if (!layers.front().has_deviation) return;
    to_data_units(layers.front(), result_.values);
    where_given(given.values, result_.values, result_.values);  // as it was, not rounded twice
  }

  Sequences take() { return std::move(result_); }

 private:
  void draw_frame(std::size_t t) {
    const Rows visible = grid_.at(states_.front(), t);
    for (std::size_t i = 0; i < layers_.size(); ++i)
      chains_[i].take_history(grid_.at(states_[i], t));
    // The state is the mean already where there is no frame before.
    where_given(grid_.at(given_, t), grid_.at(states_.front(), t - (grid_.history > 0 ? 1 : 0)),
                visible);
    for (std::size_t step = 1; step <= settings_.steps; ++step) {
      draws_.next_step();
      up(visible);
      down(settings_.means && step == settings_.steps);
      where_given(grid_.at(given_, t), drawn_, visible);
    }
    // What the frame is to those after it: its code.
    for (std::size_t i = 0; i + 1 < layers_.size(); ++i)
      chains_[i].infer_hidden(grid_.at(states_[i], t), grid_.at(states_[i + 1], t));
  }

  void up(const Rows& visible) {
    for (std::size_t i = 0; i < layers_.size(); ++i)
      chains_[i].draw_hidden(i == 0 ? visible : Rows(chains_[i - 1].hidden()), draws_.next());
  }

  void down(bool means) {
    for (std::size_t i = layers_.size(); i-- > 1;)
      chains_[i].draw_visible(draws_.next(), chains_[i - 1].hidden());
    if (means)
      chains_.front().infer_visible(drawn_);
    else
      chains_.front().draw_visible(draws_.next(), drawn_);
  }

  Layers layers_;
  ChainSettings settings_;
  Draws draws_;
  Grid grid_;
  Matrix given_, drawn_;  // the grid; [sequences x visible]
  std::vector<Matrix> states_;
  std::vector<GibbsChain> chains_;
  Sequences result_;
};

Matrix sampled(Layers layers, const Matrix& start, const ChainSettings& settings) {
  for (const Crbm& layer : layers)
    require(layer.shape().order == 0, "sample: a machine with a history generates sequences");
  require(start.columns() == layers.front().shape().visible,
          "sample: the start does not fit the machine");
  require(settings.steps > 0, "sample: needs at least one step");
  Sequences code{start, {{0, start.rows()}}, 0};
  for (const Crbm& layer : layers.first(layers.size() - 1)) code = up_pass(layer, code);
  Draws draws(settings.seed);
  Matrix units = layers.size() == 1 ? in_own_units(layers.front(), start) : std::move(code.values);
  for (std::size_t i = layers.size(); i-- > 0;) {
    const bool is_top = i + 1 == layers.size(), as_means = settings.means && i == 0;
    Matrix visible(start.device(), start.rows(), layers[i].shape().visible);
    GibbsChain chain(layers[i], start.rows());
    chain.take_history(visible);
    for (std::size_t step = 1; step <= (is_top ? settings.steps : 1); ++step) {
      draws.next_step();
      if (is_top) chain.draw_hidden(step == 1 ? units : visible, draws.next());
      const Rows hidden(is_top ? chain.hidden() : units);
      if (as_means && (!is_top || step == settings.steps))
        chain.infer_visible(hidden, visible);
      else
        chain.draw_visible(hidden, draws.next(), visible);
    }
    units = std::move(visible);
  }
  to_data_units(layers.front(), units);
  return units;
}

}  // namespace

Sequences reconstruct(const Crbm& crbm, const Sequences& visible, std::size_t steps) {
  return reconstructed(layers_of(crbm), visible, steps);
}

Sequences reconstruct(const Cdbn& cdbn, const Sequences& visible, std::size_t steps) {
  return reconstructed(layers_of(cdbn), visible, steps);
}

Sequences sample_given(const Crbm& crbm, const Sequences& given, const ChainSettings& settings) {
  return ClampedStack(layers_of(crbm), given, settings).take();
}

Sequences sample_given(const Cdbn& cdbn, const Sequences& given, const ChainSettings& settings) {
  return ClampedStack(layers_of(cdbn), given, settings).take();
}

Matrix sample(const Crbm& rbm, const Matrix& start, const ChainSettings& settings) {
  return sampled(layers_of(rbm), start, settings);
}

Matrix sample(const Cdbn& dbn, const Matrix& start, const ChainSettings& settings) {
  return sampled(layers_of(dbn), start, settings);
}

}  // namespace mcdbn
