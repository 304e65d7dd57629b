#include "comparison/clip_pairs.hpp"

#include <fmt/core.h>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {

void check_clip_pairs(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  if (tracks.size() != poses.size())
    throw ShapeError(
        fmt::format("{} tracks do not pair up with {} poses", tracks.size(), poses.size()));
  Eigen::Index frames = 0;
  for (std::size_t clip = 0; clip < tracks.size(); ++clip) {
    const MatrixF &track = tracks[clip], &pose = poses[clip];
    if (track.rows() != pose.rows() || track.cols() != tracks[0].cols() ||
        pose.cols() != poses[0].cols())
      throw ShapeError(fmt::format("clip {}: a track of {}x{} does not fit a pose of {}x{}", clip,
                                   track.rows(), track.cols(), pose.rows(), pose.cols()));
    frames += track.rows();
  }
  if (frames == 0) throw ShapeError("a baseline needs at least one training frame");
}

void check_track(const MatrixF& track, Eigen::Index fitted_dimension) {
  if (fitted_dimension == 0) throw ShapeError("the baseline was not fitted yet");
  if (track.cols() != fitted_dimension)
    throw ShapeError(fmt::format("a track of {} columns, but the baseline was fitted to {}",
                                 track.cols(), fitted_dimension));
}

MatrixF stacked(const std::vector<MatrixF>& clips) {
  Eigen::Index rows = 0;
  for (const MatrixF& clip : clips) rows += clip.rows();
  MatrixF all(rows, clips.at(0).cols());
  Eigen::Index row = 0;
  for (const MatrixF& clip : clips) {
    all.middleRows(row, clip.rows()) = clip;
    row += clip.rows();
  }
  return all;
}

}  // namespace mcdbn
