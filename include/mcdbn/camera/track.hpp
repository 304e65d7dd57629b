#pragma once

#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"
#include "mcdbn/camera/keypoint.hpp"

namespace mcdbn {

/// 2D joints over time as one camera sees them. A missing joint is NaN with confidence 0.
struct Track2d {
  std::vector<std::string> joint_names;
  /// Keypoint of each column, of a detector's joint set; empty where the columns are a skeleton's
  /// own joints, which are joined by name.
  std::vector<Keypoint> keypoints;
  MatrixD x_px, y_px, confidence;  ///< each [frames x joints]
  double fps = 30.0;
  int width_px = 1920, height_px = 1080;

  int frames() const { return static_cast<int>(x_px.rows()); }
  int joint_count() const { return static_cast<int>(joint_names.size()); }
  /// Column of the joint of that name; −1 if there is none.
  int find(const std::string& name) const;
};

}  // namespace mcdbn
