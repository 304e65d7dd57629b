#include "mcdbn/machines/sequences.hpp"

#include <algorithm>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

Matrix stacked(Device& device, std::span<const MatrixF> clips, Eigen::Index frames,
               Eigen::Index columns) {
  MatrixF all(frames, columns);
  Eigen::Index first = 0;
  for (const MatrixF& clip : clips) {
    all.middleRows(first, clip.rows()) = clip;
    first += clip.rows();
  }
  return Matrix::from_host(device, all);
}

}  // namespace

Sequences Sequences::from_host(Device& device, std::span<const MatrixF> clips,
                               std::span<const MatrixF> seen) {
  Sequences sequences;
  Eigen::Index frames = 0;
  const Eigen::Index columns = clips.empty() ? 0 : clips.front().cols();
  for (const MatrixF& clip : clips) {
    if (clip.cols() != columns) throw ShapeError("sequences: clips differ in columns");
    sequences.clips.push_back(
        {static_cast<std::size_t>(frames), static_cast<std::size_t>(clip.rows())});
    frames += clip.rows();
  }
  sequences.values = stacked(device, clips, frames, columns);
  if (!seen.empty()) sequences.seen = stacked(device, seen, frames, columns);
  return sequences;
}

std::vector<MatrixF> Sequences::to_host() const {
  const MatrixF all = values.to_host();
  std::vector<MatrixF> result;
  result.reserve(clips.size());
  for (const Clip& clip : clips)
    result.emplace_back(all.middleRows(static_cast<Eigen::Index>(clip.first),
                                       static_cast<Eigen::Index>(clip.frames)));
  return result;
}

std::vector<std::int32_t> Sequences::window_rows(std::size_t order) const {
  std::vector<std::int32_t> rows;
  for (const Clip& clip : clips)
    for (std::size_t t = valid_from + order; t < clip.frames; ++t)
      rows.push_back(static_cast<std::int32_t>(clip.first + t));
  return rows;
}

std::vector<double> Sequences::weights(std::span<const std::int32_t> rows) const {
  const auto differ = [](const Clip& a, const Clip& b) { return a.weight != b.weight; };
  if (std::adjacent_find(clips.begin(), clips.end(), differ) == clips.end()) return {};
  std::vector<double> weights;
  weights.reserve(rows.size());
  auto clip = clips.begin();
  for (const std::int32_t row : rows) {
    while (static_cast<std::size_t>(row) >= clip->first + clip->frames) ++clip;
    weights.push_back(clip->weight);
  }
  return weights;
}

}  // namespace mcdbn
