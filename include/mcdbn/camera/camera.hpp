// The room camera: cameras, and the 2D tracks that they see: projection, rays, damage, other rates.
// It uses motion.
// Add here: what happens to tracks; a file of them belongs to formats.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// A pinhole camera with OpenCV's distortion, or with OpenCV's fisheye lens. Rays beyond the angle
/// at which the distortion turns back are not seen. Camera axes are OpenCV's: x right, y down, z
/// forward.
struct Camera {
  /// Range of an image's width and height.
  static constexpr Range kImage_px = within(1, 100'000);

  Eigen::Matrix3d camera_from_world = Eigen::Matrix3d::Identity();  ///< rotation
  Eigen::Vector3d translation{0, 0, 0};  ///< x_camera = R·x_world + translation
  double fx_px = 1000, fy_px = 1000, cx_px = 960, cy_px = 540;
  std::vector<double> distortion;  ///< k1 k2 p1 p2 [k3 …], of a fisheye k1 k2 k3 k4; may be empty
  bool fisheye = false;            ///< rays 84 degrees aside and more are not seen
  int width_px = 1920, height_px = 1080;
  bool size_is_guess = false;  ///< twice the principal point: its file gives none
  /// How many metres the translation's unit is; unset: it is in file units of the motion seen.
  std::optional<double> unit_m;
};

/// The camera with its translation in file units of a motion of that skeleton: a person is taken
/// to be 1.7 m tall. A camera without a unit is returned as it is.
Camera in_file_units(Camera camera, const Skeleton& skeleton);
/// The other way round: a camera in file units of a motion of that skeleton, with their length, so
/// that it can be brought into another motion's. One that has a unit is returned as it is.
Camera with_unit(Camera camera, const Skeleton& skeleton);

/// The camera with its view unchanged, in an image of another size.
Camera scaled(Camera camera, int width_px, int height_px);
/// The camera of its own images scaled to that size, which is rounded to whole pixels. Where the
/// size of its own is a guess the images are taken to be its own.
/// @param notices if given, collects that it was scaled
/// @throws InputError naming both sizes if they have another shape: then the images were cut or
///         turned, which nothing shows; of a guess if the principal point is far from their middle
Camera of_scaled_images(Camera camera, int width_px, int height_px,
                        std::vector<std::string>* notices = nullptr);

/// Where to put a camera that looks at a clip. Azimuth 0 looks along the clip's −z axis
/// (at a figure that faces +z), positive azimuth moves the camera to the figure's left (+x).
struct CameraPlacement {
  /// A pinhole sees less than a half space.
  static constexpr Range kFieldOfView_deg = between(0, 180);

  double azimuth_deg = 30.0;
  double elevation_deg = 10.0;
  std::optional<double> distance;   ///< file units; unset: the whole clip's body just fits in view
  double field_of_view_deg = 45.0;  ///< vertical
  int width_px = 1920, height_px = 1080;
  bool operator==(const CameraPlacement&) const = default;

  /// The view; how far away the camera stands and its image are for place_camera alone.
  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"azimuth", within(-360, 360), "degrees",
                  "the camera's direction around the figure, towards its left (+x); 0: in front of "
                  "a figure that faces +z"},
          self.azimuth_deg);
    // From right above a figure nothing shows which way it faces.
    visit(Setting{"elevation", within(-89, 89), "degrees", "the camera's angle above the horizon"},
          self.elevation_deg);
    visit(Setting{"fov", kFieldOfView_deg, "degrees", "vertical field of view"},
          self.field_of_view_deg);
  }
};

/// `count` placements evenly around the figure: `first`, then each further to the figure's left.
std::vector<CameraPlacement> placements_around(const CameraPlacement& first, std::size_t count);

/// camera_from_world of that azimuth and elevation, with the world's +y up.
Eigen::Matrix3d camera_rotation(double azimuth_deg, double elevation_deg);

/// The placement's rotation and lens, the camera at the world's origin.
/// @throws ConfigError if the placement has no pinhole camera's field of view, or no image
Camera camera_at_origin(const CameraPlacement& placement);

/// Aims a camera at the centre of the clip, with every joint of every frame in view.
Camera place_camera(const Motion& motion, const CameraPlacement& placement);
/// As place_camera() for a motion, for points. @param points [frames x 3·joints] world
/// @throws InputError if none
Camera place_camera(const MatrixD& points, const CameraPlacement& placement);

/// Projects world points through the camera by cv::projectPoints or cv::fisheye::projectPoints.
/// @param points [frames x 3·joints]  @return [frames x 2·joints] pixels, NaN where it sees none
MatrixD project_points(const Camera& camera, const MatrixD& points);

/// The 2D track of a clip's joints as the camera sees it; confidence 1, NaN and 0 where a joint is
/// behind the camera, or further aside than its lens sees.
Track2d project_motion(const Motion& motion, const Camera& camera);

}  // namespace mcdbn
