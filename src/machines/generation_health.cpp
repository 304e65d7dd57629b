#include "mcdbn/machines/generation_health.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

/// Mean squared change of a channel over `lag` frames.
double change(const MatrixF& sequence, Eigen::Index lag) {
  const Eigen::Index rows = sequence.rows() - lag;
  if (rows <= 0 || sequence.cols() == 0) return 0;
  return (sequence.bottomRows(rows) - sequence.topRows(rows)).cast<double>().squaredNorm() /
         static_cast<double>(rows * sequence.cols());
}

RowVectorD deviation_of(const std::vector<MatrixF>& sequences) {
  if (sequences.empty()) return {};
  RowVectorD sum = RowVectorD::Zero(sequences.front().cols()), squares = sum;
  double frames = 0;
  for (const MatrixF& sequence : sequences) {
    sum += sequence.cast<double>().colwise().sum();
    frames += static_cast<double>(sequence.rows());
  }
  const RowVectorD mean = sum / std::max(frames, 1.0);
  for (const MatrixF& sequence : sequences)
    squares += (sequence.cast<double>().rowwise() - mean).array().square().matrix().colwise().sum();
  return (squares / std::max(frames, 1.0)).cwiseSqrt();
}

}  // namespace

std::size_t shortest_cycle(const MatrixF& sequence) {
  // A minimum is known by the lag that follows it.
  const std::size_t longest =
      std::min(kLongestLag, static_cast<std::size_t>(sequence.rows()) / 2 + 1);
  double largest = 0, before = 0, at = change(sequence, 1);
  for (std::size_t lag = 2; lag <= longest; ++lag) {
    const double after = change(sequence, static_cast<Eigen::Index>(lag));
    largest = std::max(largest, at);
    if (lag > 2 && at < before && at <= after && at < kCycleDepth * largest) return lag - 1;
    before = at;
    at = after;
  }
  return 0;
}

std::size_t GenerationHealth::shortest_of_cycles() const {
  std::size_t shortest = 0;
  for (const std::size_t frames : cycle)
    if (frames > 0 && (shortest == 0 || frames < shortest)) shortest = frames;
  return shortest;
}

std::size_t GenerationHealth::slow_sequences() const {
  std::size_t slow = 0;
  for (std::size_t i = 0; i < seed_speed.size(); ++i)
    if (!(late_speed[i] >= kSlowShare * seed_speed[i])) ++slow;
  return slow;
}

double mean_speed(const MatrixF& sequence) {
  return std::sqrt(change(sequence, 1));
}

GenerationHealth generation_health(const std::vector<MatrixF>& sequences,
                                   const std::vector<double>& seed_speed) {
  if (!seed_speed.empty() && sequences.size() != seed_speed.size())
    throw ShapeError(fmt::format("{} sequences, {} speeds of what they went on from",
                                 sequences.size(), seed_speed.size()));
  GenerationHealth health;
  health.seed_speed = seed_speed;
  health.deviation = deviation_of(sequences);
  for (const MatrixF& sequence : sequences) {
    const Eigen::Index late =
        std::min<Eigen::Index>(sequence.rows(), GenerationHealth::kLateFrames);
    health.late_speed.push_back(mean_speed(sequence.bottomRows(late)));
    health.cycle.push_back(shortest_cycle(sequence));
  }
  return health;
}

}  // namespace mcdbn
