#pragma once

#include <string>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// A track as the rays that the camera saw its joints along, the lens's distortion taken out.
struct TrackRays {
  std::vector<std::string> joint_names;  ///< of the joints that the track has
  std::vector<int> indices;  ///< by joint, its index among the names that were asked for
  int asked = 0;             ///< how many names were asked for
  MatrixD rays;              ///< [frames x 2·joints] x/z and y/z in camera axes
  MatrixD confidence;        ///< [frames x joints], 0 where there is no ray
  double fps = 30;           ///< the track's

  Eigen::Index frames() const { return rays.rows(); }
  Eigen::Index joints() const { return confidence.cols(); }
  bool seen(Eigen::Index frame, Eigen::Index joint) const { return confidence(frame, joint) > 0; }
};

/// The joints that both `joint_names` and the track know, joined by name.
TrackRays track_rays(const std::vector<std::string>& joint_names, const Track2d& track,
                     const Camera& camera);

}  // namespace mcdbn
