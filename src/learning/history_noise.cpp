#include "learning/history_noise.hpp"

#include "base/random_phases.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"

namespace mcdbn {
namespace {

IndexBuffer last_rows(Device& device, std::size_t windows, std::size_t frames) {
  std::vector<std::int32_t> rows(windows);
  for (std::size_t i = 0; i < windows; ++i)
    rows[i] = static_cast<std::int32_t>(i * frames + frames - 1);
  return {device, rows};
}

}  // namespace

HistoryNoise::HistoryNoise(Device& device, LearningRule& rule, const CrbmShape& shape,
                           std::size_t largest_batch, double deviation)
    : rule_(rule),
      frames_(shape.order + 1),
      deviation_(static_cast<float>(deviation)),
      windows_(device, largest_batch * frames_, shape.visible),
      current_(last_rows(device, largest_batch, frames_)) {}

void HistoryNoise::learn(std::span<const Rows> visible, const LearningStep& step,
                         LossAccumulator& losses) {
  require(visible.size() == 1 && visible.front().index != nullptr,
          "history noise: needs one sequence, indexed");
  const Rows& rows = visible.front();
  require(rows.count <= current_.size(), "history noise: more rows than it was made for");
  const int past = to_int(frames_ - 1);
  Rows windows = Rows::indexed(*rows.matrix, *rows.index, rows.index_first, rows.count,
                               rows.shift - past, frames_);
  Rows copies = Rows::strided(windows_, 0, rows.count, frames_, frames_);
  // With the padding of each frame, which makes them one long row.
  windows.columns = copies.columns = frames_ * windows_.stride();
  gather(windows, copies);
  const Rows all(windows_, 0, rows.count * frames_);
  GemmOptions noise;
  noise.sampling = Sampling::gaussian;
  noise.sample = &all;
  noise.temperature = deviation_;
  noise.random = step.random;
  noise.random.phase = random_phases::kHistoryNoise;
  apply_epilogue(all, noise);
  LearningStep noisy_step = step;
  if (step.seen) {
    if (seen_.empty()) seen_ = Matrix::like(windows_);
    windows.matrix = step.seen;
    Rows seen = copies;
    seen.matrix = &seen_;
    gather(windows, seen);
    multiply(all, Rows(seen_, 0, all.count));
    noisy_step.seen = &seen_;
  }
  gather(rows, Rows::strided(windows_, frames_ - 1, rows.count, frames_));
  const Rows noisy = Rows::indexed(windows_, current_, 0, rows.count);
  rule_.learn({&noisy, 1}, noisy_step, losses);
}

}  // namespace mcdbn
