#pragma once

#include <optional>
#include <vector>

#include "camera/keypoint_map.hpp"
#include "mcdbn/motion_model/seen_clip.hpp"

namespace mcdbn {

/// Keypoints of the columns: those that the file specifies, else the joints that the names denote.
std::vector<Keypoint> keypoints_of_columns(const Track2d& track);

/// How the track's keypoints show the joints of the skeleton that is regenerated; none where its
/// columns are the model's joints (joined_by_name).
/// @throws InputError as KeypointMap
std::optional<KeypointMap> keypoint_map_of(const Modalities& modalities, const Track2d& track,
                                           const ClipPlacement& placement);

/// Features, and in the place of those that are unknown (NaN) the others.
MatrixF where_known(const MatrixF& features, const MatrixF& otherwise);

}  // namespace mcdbn
