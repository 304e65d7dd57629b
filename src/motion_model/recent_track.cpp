#include "motion_model/recent_track.hpp"

#include <fmt/format.h>

#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr auto kValues = {&Track2d::x_px, &Track2d::y_px, &Track2d::confidence};

}  // namespace

void append(Track2d& track, const TrackFrame& frame) {
  const Eigen::Index joints = track.joint_count();
  for (const RowVectorD* row : {&frame.x_px, &frame.y_px, &frame.confidence})
    if (row->size() != joints)
      throw ShapeError(fmt::format("a frame of {} joints of a track of {}", row->size(), joints));
  const Eigen::Index at = track.x_px.rows();
  for (const auto values : kValues) (track.*values).conservativeResize(at + 1, joints);
  track.x_px.row(at) = frame.x_px;
  track.y_px.row(at) = frame.y_px;
  track.confidence.row(at) = frame.confidence;
}

void drop_first(Track2d& track, Eigen::Index frames) {
  for (const auto values : kValues)
    track.*values = MatrixD((track.*values).bottomRows((track.*values).rows() - frames));
}

Track2d without_frames(Track2d track) {
  drop_first(track, track.x_px.rows());
  return track;
}

Track2d some_frames(const Track2d& track, Eigen::Index first, Eigen::Index count) {
  Track2d part = track;
  for (const auto values : kValues)
    part.*values = MatrixD((track.*values).middleRows(first, count));
  return part;
}

void replace_frames(Track2d& track, Eigen::Index first, const Track2d& part) {
  for (const auto values : kValues)
    (track.*values).middleRows(first, (part.*values).rows()) = part.*values;
}

}  // namespace mcdbn
