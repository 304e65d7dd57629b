#include "motion_model/modalities_json.hpp"

#include <fmt/format.h>

#include "base/shown.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/motion/frame_rate.hpp"

namespace mcdbn {
namespace {

using nlohmann::json;

json camera_json(const CameraPlacement& camera) {
  return {{"azimuth_deg", camera.azimuth_deg},
          {"elevation_deg", camera.elevation_deg},
          {"distance", camera.distance ? json(*camera.distance) : json(nullptr)},
          {"field_of_view_deg", camera.field_of_view_deg},
          {"width_px", camera.width_px},
          {"height_px", camera.height_px}};
}

CameraPlacement camera_from(const JsonPlace& entry) {
  CameraPlacement camera;
  camera.azimuth_deg = entry["azimuth_deg"].number(any_number());
  camera.elevation_deg = entry["elevation_deg"].number(within(-90, 90));
  if (const JsonPlace distance = entry["distance"]; !distance.value().is_null())
    camera.distance = distance.number(above(0));
  camera.field_of_view_deg = entry["field_of_view_deg"].number(CameraPlacement::kFieldOfView_deg);
  camera.width_px = static_cast<int>(entry["width_px"].count(Camera::kImage_px));
  camera.height_px = static_cast<int>(entry["height_px"].count(Camera::kImage_px));
  return camera;
}

/// The skeleton's header, with its errors' lines under the place that it stands at.
Skeleton skeleton_from(const JsonPlace& entry) {
  return parse_bvh_header(entry.text(), entry.where());
}

/// Joints of the 2D modality are the skeleton's: what is sought there by name must be found.
void check_joints(const JsonPlace& entry, const Modalities& modalities) {
  const JsonPlace root = entry["root"];
  if (root.text() != modalities.root_name())
    root.fail(fmt::format("{}, but the moving joint is {}", shown(root.text()),
                          shown(modalities.root_name())));
  for (const JsonPlace& joint : entry["joints"].list())
    if (modalities.pose_features.skeleton().find(joint.text()) < 0)
      joint.fail(fmt::format("the skeleton has no joint {}", shown(joint.text())));
}

void check_dimension(const JsonPlace& scale, int columns, int dimension) {
  if (columns != dimension)
    scale["mean"].fail(fmt::format("{} numbers for {} features", columns, dimension));
}

}  // namespace

json pose_features_json(const PoseFeatures& features) {
  const RowVectorD& fixed = features.fixed_channels();
  return {{"skeleton", bvh_header_text(features.skeleton())},
          {"root", features.root()},
          {"joints", features.joints()},
          {"constant_channels", std::vector<double>(fixed.begin(), fixed.end())}};
}

PoseFeatures pose_features_from(const JsonPlace& entry) {
  const std::vector<double> constants = entry["constant_channels"].finite_numbers();
  Skeleton skeleton = skeleton_from(entry["skeleton"]);
  const Range joints = within(0, skeleton.joint_count() - 1);
  std::vector<int> moving;
  for (const JsonPlace& joint : entry["joints"].list()) {
    moving.push_back(static_cast<int>(joint.count(joints)));
    if (moving.size() > 1 && moving.back() <= moving[moving.size() - 2])
      joint.fail("joints do not rise; the model file is damaged");
  }
  if (static_cast<int>(constants.size()) != skeleton.channel_count())
    entry["constant_channels"].fail(
        fmt::format("{} numbers for {} channels", constants.size(), skeleton.channel_count()));
  return PoseFeatures::restored(
      std::move(skeleton), static_cast<int>(entry["root"].count(joints)), std::move(moving),
      RowVectorD::Map(constants.data(), static_cast<Eigen::Index>(constants.size())));
}

json modalities_json(const Modalities& modalities) {
  return {{"pose_features", pose_features_json(modalities.pose_features)},
          {"track_features", modalities.track_features.to_json()},
          {"pose_scale", modalities.pose_scale.to_json()},
          {"track_scale", modalities.track_scale.to_json()},
          {"fps", modalities.fps},
          {"camera", camera_json(modalities.camera)},
          {"directions", modalities.directions},
          {"level_view", modalities.level_view}};
}

Modalities modalities_from(const JsonPlace& entry) {
  const JsonPlace track = entry["track_features"], pose_scale = entry["pose_scale"],
                  track_scale = entry["track_scale"];
  Modalities modalities{pose_features_from(entry["pose_features"]),
                        TrackFeatures::from_json(track.value(), track.where()),
                        Standardizer::from_json(pose_scale.value(), pose_scale.where()),
                        Standardizer::from_json(track_scale.value(), track_scale.where()),
                        entry["fps"].number(kFrameRate_hz),
                        camera_from(entry["camera"])};
  // Models from before there were these do not have them.
  if (entry.has("directions"))
    modalities.directions = entry["directions"].count(Modalities::kDirections);
  if (entry.has("level_view")) modalities.level_view = entry["level_view"].truth();
  check_joints(track, modalities);
  check_dimension(pose_scale, modalities.pose_scale.input_dimension(),
                  modalities.pose_features.dimension());
  check_dimension(track_scale, modalities.track_scale.input_dimension(),
                  modalities.track_features.dimension());
  return modalities;
}

}  // namespace mcdbn
