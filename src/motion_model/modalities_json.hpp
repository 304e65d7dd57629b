#pragma once

#include <nlohmann/json.hpp>

#include "base/json_place.hpp"
#include "mcdbn/features/modalities.hpp"

namespace mcdbn {

/// The modalities as a model's file holds them. The skeleton is BVH header text.
nlohmann::json modalities_json(const Modalities& modalities);
/// Every number in its range, and all sizes as they must be. @throws InputError
Modalities modalities_from(const JsonPlace& entry);

nlohmann::json pose_features_json(const PoseFeatures& features);
/// @throws InputError
PoseFeatures pose_features_from(const JsonPlace& entry);

}  // namespace mcdbn
