#include "fitting/unknown_camera.hpp"

#include <cmath>

#include "base/numbers.hpp"
#include "fitting/camera_angles.hpp"

namespace mcdbn {

std::optional<UnknownCamera> unknown_camera_of(const KnownOfClip& known,
                                               const Modalities& modalities, const Track2d& track,
                                               const TrackFitSettings& settings) {
  if (known.camera || !modalities.level_view) return {};
  const Camera assumed = known.camera_of(track, modalities),
               usual = modalities.assumed_camera(known.view, track.width_px, track.height_px);
  const Eigen::Vector3d up = usual.camera_from_world.col(1),
                        up_now = assumed.camera_from_world.col(1);
  UnknownCamera camera;
  camera.usual = {pitch_rad(up) - pitch_rad(up_now), roll_from_to_rad(up_now, up),
                  settings.pitch_deviation_deg * kRadiansPerDegree,
                  settings.roll_deviation_deg * kRadiansPerDegree};
  camera.pitch_known = known.view.pitch_deg.has_value();
  camera.roll_known = known.view.roll_deg.has_value();
  camera.focal_known = known.view.field_of_view_deg.has_value();
  camera.log_focal = std::log(usual.fy_px / assumed.fy_px);
  camera.log_focal_deviation = settings.focal_log_deviation;
  return camera;
}

}  // namespace mcdbn
