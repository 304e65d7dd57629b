#pragma once

#include <nlohmann/json.hpp>

#include "mcdbn/features/modalities.hpp"

namespace mcdbn {

/// As a model's file holds them. The skeleton is BVH header text.
nlohmann::json modalities_json(const Modalities& modalities);
/// @throws InputError, or nlohmann::json's own for a field that is missing
Modalities modalities_from(const nlohmann::json& entry);

nlohmann::json pose_features_json(const PoseFeatures& features);
/// @throws InputError
PoseFeatures pose_features_from(const nlohmann::json& entry);

}  // namespace mcdbn
