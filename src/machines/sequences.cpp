#include "mcdbn/machines/sequences.hpp"

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

Sequences Sequences::from_host(Device& device, std::span<const MatrixF> clips) {
  Sequences sequences;
  Eigen::Index frames = 0;
  const Eigen::Index columns = clips.empty() ? 0 : clips.front().cols();
  for (const MatrixF& clip : clips) {
    if (clip.cols() != columns) throw ShapeError("sequences: clips differ in columns");
    sequences.clips.push_back(
        {static_cast<std::size_t>(frames), static_cast<std::size_t>(clip.rows())});
    frames += clip.rows();
  }
  MatrixF all(frames, columns);
  for (std::size_t i = 0; i < clips.size(); ++i)
    all.middleRows(static_cast<Eigen::Index>(sequences.clips[i].first), clips[i].rows()) = clips[i];
  sequences.values = Matrix::from_host(device, all);
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

}  // namespace mcdbn
