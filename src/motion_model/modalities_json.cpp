#include "motion_model/modalities_json.hpp"

#include <fmt/format.h>

#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"

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

CameraPlacement camera_from(const json& entry) {
  CameraPlacement camera;
  camera.azimuth_deg = entry.at("azimuth_deg");
  camera.elevation_deg = entry.at("elevation_deg");
  if (!entry.at("distance").is_null()) camera.distance = entry.at("distance").get<double>();
  camera.field_of_view_deg = entry.at("field_of_view_deg");
  camera.width_px = entry.at("width_px");
  camera.height_px = entry.at("height_px");
  return camera;
}

}  // namespace

json pose_features_json(const PoseFeatures& features) {
  const RowVectorD& fixed = features.fixed_channels();
  return {{"skeleton", bvh_header_text(features.skeleton())},
          {"root", features.root()},
          {"joints", features.joints()},
          {"constant_channels", std::vector<double>(fixed.begin(), fixed.end())}};
}

PoseFeatures pose_features_from(const json& entry) {
  try {
    const auto constants = entry.at("constant_channels").get<std::vector<double>>();
    return PoseFeatures::restored(
        parse_bvh_header(entry.at("skeleton").get<std::string>(), "the model's skeleton"),
        entry.at("root"), entry.at("joints"),
        RowVectorD::Map(constants.data(), static_cast<Eigen::Index>(constants.size())));
  } catch (const json::exception& error) {
    throw InputError(fmt::format("pose features: {}; the model file is damaged", error.what()));
  }
}

json modalities_json(const Modalities& modalities) {
  return {{"pose_features", pose_features_json(modalities.pose_features)},
          {"track_features", modalities.track_features.to_json()},
          {"pose_scale", modalities.pose_scale.to_json()},
          {"track_scale", modalities.track_scale.to_json()},
          {"fps", modalities.fps},
          {"camera", camera_json(modalities.camera)},
          {"level_view", modalities.level_view}};
}

Modalities modalities_from(const json& entry) {
  return {pose_features_from(entry.at("pose_features")),
          TrackFeatures::from_json(entry.at("track_features")),
          Standardizer::from_json(entry.at("pose_scale")),
          Standardizer::from_json(entry.at("track_scale")),
          entry.at("fps"),
          camera_from(entry.at("camera")),
          entry.value("level_view", false)};  // models from before there was one
}

}  // namespace mcdbn
