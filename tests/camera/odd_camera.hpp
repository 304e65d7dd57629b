#pragma once

#include "mcdbn/camera/camera.hpp"

namespace mcdbn::test {

/// No two of its numbers are alike, none is round.
inline Camera odd_camera() {
  Camera camera;
  camera.camera_from_world = camera_rotation(-123.4, 17.3);
  camera.translation = {0.1, -2.0 / 3, 412.7};
  camera.fx_px = 1234.5;
  camera.fy_px = 1200 / 0.7;
  camera.cx_px = 611.1;
  camera.cy_px = 377.7;
  camera.distortion = {-0.21, 0.07, 1e-3, -2e-3, 0.01};
  camera.width_px = 1280;
  camera.height_px = 720;
  return camera;
}

}  // namespace mcdbn::test
