#include "machines/running_regeneration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/missing_values.hpp"
#include "machines/cdbn_decoder.hpp"
#include "machines/mirrored_continuation.hpp"
#include "machines/own_units.hpp"
#include "machines/sequence_completion.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr std::size_t kShown = 0, kAnswered = 1;

}  // namespace

RunningRegeneration::RunningRegeneration(const Mcdbn& network, std::size_t run_in)
    : network_(network), run_in_(static_cast<Eigen::Index>(run_in)) {
  if (network.modality_count() != 2)
    throw ShapeError("a running regeneration answers one modality with another");
  std::size_t history = network.cdbns[kShown].total_order();
  for (const Crbm& layer : network.cdbns[kAnswered].layers)
    history = std::max(history, layer.shape().order);
  // Without a history a gap still begins from the frame before.
  history_ = std::max<Eigen::Index>(static_cast<Eigen::Index>(history), 1);
}

/// Their gaps filled, on the settled frames that the history holds.
MatrixF RunningRegeneration::filled(const MatrixF& open) const {
  if (!network_.fills_gaps) return at_mean_where_unknown(open);
  const Eigen::Index before = std::min(settled_, history_);
  MatrixF rows(before + open.rows(), open.cols());
  if (before > 0) rows.topRows(before) = shown_.bottomRows(before);
  rows.bottomRows(open.rows()) = open;
  return complete_sequence(network_.cdbns[kShown], std::move(rows)).bottomRows(open.rows());
}

MatrixF RunningRegeneration::rows_to_see(const MatrixF& open) const {
  const Eigen::Index before = history_ + run_in_;
  MatrixF rows(before + open.rows(), open.cols());
  rows.bottomRows(open.rows()) = filled(open);
  if (shown_.rows() > 0)
    rows.topRows(before) = shown_;
  else
    rows.topRows(before) = MatrixF(rows.row(before)).replicate(before, 1);
  return rows;
}

/// Visible rows of each layer of the second modality: history, and room for what is decoded.
std::vector<Matrix> RunningRegeneration::visible_to_go_on(Eigen::Index rows) const {
  std::vector<Matrix> visible;
  const Cdbn& cdbn = network_.cdbns[kAnswered];
  for (std::size_t i = 0; i < cdbn.layers.size(); ++i) {
    const Crbm& layer = cdbn.layers[i];
    if (visible_.empty()) {
      visible.push_back(Matrix::filled_with_row(in_own_units(layer, layer.visible_mean),
                                                static_cast<std::size_t>(rows)));
      continue;
    }
    MatrixF values = MatrixF::Zero(rows, visible_[i].cols());
    values.topRows(history_) = visible_[i];
    visible.push_back(Matrix::from_host(layer.device(), values));
  }
  return visible;
}

CodedAnswer RunningRegeneration::answer(const MatrixF& open) {
  const Cdbn& cdbn = network_.cdbns[kAnswered];
  const auto dimension =
      static_cast<Eigen::Index>(network_.cdbns[kShown].layers[0].shape().visible);
  if (open.rows() == 0 || open.cols() != dimension)
    throw ShapeError(fmt::format("a running regeneration was shown {} frames of {} values, of {}",
                                 open.rows(), open.cols(), dimension));
  Device& device = network_.mrbm.device();
  last_shown_ = rows_to_see(open);
  const Eigen::Index rows = last_shown_.rows();
  const auto ahead = static_cast<Eigen::Index>(network_.look_ahead);
  MatrixF seen(rows + ahead, dimension);
  seen << last_shown_,
      mirrored_continuation(last_shown_, ahead, network_.cdbns[kShown].layers[0].shape().kind);
  const Sequences shown = network_.cdbns[kShown].up_pass(Sequences::from_host(device, {seen}));
  const Matrix code(device, static_cast<std::size_t>(rows), cdbn.code_dimension());
  const auto first = static_cast<std::size_t>(history_),
             count = static_cast<std::size_t>(rows - history_);
  network_.mrbm.infer(
      {Rows(shown.values, first + network_.look_ahead, count), Rows(code, first, count)},
      {true, false}, network_.mean_field_steps);
  const std::vector<Matrix> visible = visible_to_go_on(rows);
  CdbnDecoder decoder(cdbn, code, 1, visible);
  decoder.decode(first, static_cast<std::size_t>(rows), {});
  last_visible_.clear();
  for (const Matrix& layer : visible) last_visible_.push_back(layer.to_host());
  CodedAnswer answer{last_visible_.front().bottomRows(open.rows()),
                     code.to_host().bottomRows(open.rows())};
  const Crbm& lowest = cdbn.layers.front();
  if (lowest.has_deviation)  // answers are in the data's units, the history in the layer's own
    last_visible_.front().bottomRows(rows - history_).array().rowwise() /=
        lowest.visible_deviation.to_host().row(0).array();
  return answer;
}

void RunningRegeneration::settle(std::size_t frames) {
  if (frames == 0) return;
  // What is left begins with the history of the next open frame.
  const Eigen::Index passed = run_in_ + static_cast<Eigen::Index>(frames);
  if (history_ + passed > last_shown_.rows())
    throw ShapeError("running regeneration: more frames settled than answered");
  last_shown_ = MatrixF(last_shown_.bottomRows(last_shown_.rows() - passed));
  shown_ = last_shown_.topRows(history_);
  visible_.clear();
  for (MatrixF& layer : last_visible_) {
    layer = MatrixF(layer.bottomRows(layer.rows() - passed));
    visible_.emplace_back(layer.topRows(history_));
  }
  run_in_ = 0;
  settled_ += static_cast<Eigen::Index>(frames);
}

}  // namespace mcdbn
