#include "mcdbn/machines/generation.hpp"

#include <algorithm>

#include "device/pointwise.hpp"
#include "machines/cdbn_decoder.hpp"
#include "machines/free_run.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// Frames before the first new one that any single layer looks at.
std::size_t longest_history(const Cdbn& cdbn) {
  std::size_t longest = 1;  // which the chain starts from
  for (const Crbm& layer : cdbn.layers) longest = std::max(longest, layer.shape().order);
  return longest;
}

/// The last seed_frames() of each.
std::vector<MatrixF> ends(const Cdbn& cdbn, const std::vector<MatrixF>& seeds) {
  const auto frames = static_cast<Eigen::Index>(seed_frames(cdbn));
  std::vector<MatrixF> result;
  for (const MatrixF& seed : seeds) {
    if (seed.rows() < frames) throw ShapeError("generation: a seed is shorter than the history");
    if (seed.cols() != static_cast<Eigen::Index>(cdbn.layers.front().shape().visible))
      throw ShapeError("generation: a seed does not fit the CDBN");
    result.emplace_back(seed.bottomRows(frames));
  }
  return result;
}

/// Rows of all samples, one after another, each begun with the last `history` frames of its seed.
Matrix begun(const Sequences& seeds, std::size_t history, const GenerationOptions& options) {
  const std::size_t frames = history + options.frames;
  Matrix rows(seeds.values.device(), seeds.clips.size() * options.samples * frames,
              seeds.values.columns());
  for (std::size_t i = 0; i < seeds.clips.size() * options.samples; ++i) {
    const Sequences::Clip& clip = seeds.clips[i / options.samples];
    rows.copy_rows_from(seeds.values, clip.first + clip.frames - history, history, i * frames);
  }
  return rows;
}

}  // namespace

std::size_t seed_frames(const Cdbn& cdbn) {
  const std::size_t top_order = cdbn.layers.empty() ? 0 : cdbn.layers.back().shape().order;
  return cdbn.total_order() + (top_order == 0 ? 1 : 0);
}

std::vector<MatrixF> generate(const Cdbn& cdbn, const std::vector<MatrixF>& seeds,
                              const GenerationOptions& options) {
  if (cdbn.layers.empty()) throw ShapeError("generation: the CDBN has no layers");
  if (seeds.empty() || options.samples == 0) return {};
  const std::size_t history = longest_history(cdbn), sequences = seeds.size() * options.samples;
  Sequences code = Sequences::from_host(cdbn.layers.front().device(), ends(cdbn, seeds));
  std::vector<Matrix> states;  // the visible rows of each layer
  for (std::size_t i = 0; i < cdbn.layers.size(); ++i) {
    if (i > 0) code = up_pass(cdbn.layers[i - 1], code);
    states.push_back(begun(code, history, options));
    if (cdbn.layers[i].has_deviation)
      scale_columns(states.back(), cdbn.layers[i].visible_deviation, true);
  }
  const Matrix top = states.back();
  run_freely(cdbn.layers.back(), top, sequences, history, options);
  Matrix visible = top;
  if (cdbn.layers.size() > 1) {
    const Cdbn below{{cdbn.layers.begin(), cdbn.layers.end() - 1}};
    states.pop_back();
    CdbnDecoder decoder(below, top, sequences, std::move(states));
    decoder.decode(history, history + options.frames, {});
    visible = decoder.visible();
  } else if (cdbn.layers.front().has_deviation) {
    scale_columns(visible, cdbn.layers.front().visible_deviation);
  }

  const MatrixF all = visible.to_host();
  const auto frames = static_cast<Eigen::Index>(options.frames);
  std::vector<MatrixF> result;
  for (std::size_t i = 0; i < sequences; ++i)
    result.emplace_back(all.middleRows(
        static_cast<Eigen::Index>(i * (history + options.frames) + history), frames));
  return result;
}

}  // namespace mcdbn
