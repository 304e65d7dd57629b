#include "comparison/constant_pose.hpp"

#include "comparison/clip_pairs.hpp"

namespace mcdbn {

void ConstantPose::fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) {
  check_clip_pairs(tracks, poses);
  RowVectorD sum = RowVectorD::Zero(poses[0].cols());
  Eigen::Index frames = 0;
  for (const MatrixF& pose : poses) {
    sum += pose.cast<double>().colwise().sum();
    frames += pose.rows();
  }
  mean_ = (sum / static_cast<double>(frames)).cast<float>();
  track_dimension_ = tracks[0].cols();
}

MatrixF ConstantPose::predict(const MatrixF& track) const {
  check_track(track, track_dimension_);
  return mean_.replicate(track.rows(), 1);
}

}  // namespace mcdbn
