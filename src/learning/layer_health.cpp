#include "mcdbn/learning/layer_health.hpp"

#include <algorithm>
#include <cmath>

#include "machines/crbm_on_host.hpp"

namespace mcdbn {
namespace {

constexpr float kSaturated = 0.01F;
constexpr int kMeanFieldSteps = 3;

void measure_hidden(const MatrixF& probabilities, LayerHealth& health) {
  if (probabilities.size() == 0) return;
  const auto p = probabilities.array();
  health.hidden_activity = p.cast<double>().mean();
  health.saturation = (p < kSaturated || p > 1.0F - kSaturated).cast<double>().mean();
}

/// One frame of every window, one below another. @return [windows x visible]
MatrixF frame_of(const std::vector<MatrixF>& windows, std::size_t frame) {
  MatrixF rows(static_cast<Eigen::Index>(windows.size()), windows.front().cols());
  for (std::size_t i = 0; i < windows.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = windows[i].row(static_cast<Eigen::Index>(frame));
  return rows;
}

/// The last `order` frames side by side, the oldest first. @return [windows x order·visible]
MatrixF history_of(const std::vector<MatrixF>& frames, std::size_t order) {
  const Eigen::Index visible = frames.front().cols();
  MatrixF history(frames.front().rows(), static_cast<Eigen::Index>(order) * visible);
  for (std::size_t i = 0; i < order; ++i)
    history.middleCols(static_cast<Eigen::Index>(i) * visible, visible) =
        frames[frames.size() - order + i];
  return history;
}

/// Goes on from the true history; frames [order, order + kFreeRunFrames) are its own.
/// @param windows over the machine's deviation
double free_run_error(const CrbmParameters& p, const std::vector<MatrixF>& windows) {
  const std::size_t order = p.shape.order;
  std::vector<MatrixF> frames;
  for (std::size_t t = 0; t < order; ++t) frames.push_back(frame_of(windows, t));
  double sum = 0;
  for (std::size_t t = order; t < order + kFreeRunFrames; ++t) {
    const MatrixF truth = frame_of(windows, t);
    const MatrixF history = order > 0 ? history_of(frames, order) : MatrixF(truth.rows(), 0);
    MatrixF visible =
        order > 0 ? frames.back() : MatrixF(MatrixF::Zero(truth.rows(), truth.cols()));
    for (int step = 0; step < kMeanFieldSteps; ++step)
      visible = visible_on_host(p, hidden_on_host(p, visible, history), history);
    MatrixF error = visible - truth;
    error.array().rowwise() *= p.visible_deviation.row(0).array();
    sum += error.cast<double>().squaredNorm() / static_cast<double>(truth.size());
    frames.push_back(std::move(visible));
  }
  return sum / kFreeRunFrames;
}

}  // namespace

std::vector<MatrixF> health_windows(const Sequences& sequences, std::size_t frames) {
  const auto last_rows = sequences.window_rows(frames - 1);
  const MatrixF values = sequences.values.to_host();
  const std::size_t count = std::min(kHealthWindows, last_rows.size());
  std::vector<MatrixF> windows;
  for (std::size_t i = 0; i < count; ++i) {
    const auto last = static_cast<Eigen::Index>(last_rows[i * last_rows.size() / count]);
    const auto length = static_cast<Eigen::Index>(frames);
    windows.emplace_back(values.middleRows(last - length + 1, length));
  }
  return windows;
}

std::vector<MatrixF> crbm_health_windows(const Sequences& sequences, std::size_t order) {
  std::vector<MatrixF> windows = health_windows(sequences, order + kFreeRunFrames);
  return windows.empty() ? health_windows(sequences, order + 1) : windows;
}

LayerHealth crbm_health(const CrbmParameters& parameters, std::vector<MatrixF> windows) {
  for (MatrixF& window : windows)
    window.array().rowwise() /= parameters.visible_deviation.row(0).array();
  LayerHealth health;
  health.weight_norm = parameters.W.norm();
  health.weight_norm_A = parameters.A.norm();
  health.weight_norm_B = parameters.B.norm();
  if (windows.empty()) return health;
  const std::size_t order = parameters.shape.order;
  std::vector<MatrixF> frames;
  for (std::size_t t = 0; t <= order; ++t) frames.push_back(frame_of(windows, t));
  const MatrixF now = frames.back();
  frames.pop_back();
  const MatrixF history = order > 0 ? history_of(frames, order) : MatrixF(now.rows(), 0);
  measure_hidden(hidden_on_host(parameters, now, history), health);
  if (windows.front().rows() >= static_cast<Eigen::Index>(order + kFreeRunFrames))
    health.free_run_error = free_run_error(parameters, windows);
  return health;
}

LayerHealth mrbm_health(const MrbmParameters& parameters, const std::vector<MatrixF>& codes) {
  LayerHealth health;
  double squares = 0;
  MatrixF input = parameters.b.replicate(codes.front().rows(), 1);
  for (std::size_t m = 0; m < codes.size(); ++m) {
    squares += static_cast<double>(parameters.W[m].squaredNorm());
    input += codes[m] * parameters.W[m];
  }
  health.weight_norm = std::sqrt(squares);
  measure_hidden(sigmoid_on_host(input), health);
  return health;
}

}  // namespace mcdbn
