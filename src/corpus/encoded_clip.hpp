#pragma once

#include <filesystem>

#include "corpus/clip_notices.hpp"
#include "mcdbn/corpus/augmentation.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/features/modalities.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {

/// One BVH clip as a trained model sees it: resampled, projected, encoded and standardized.
struct EncodedClip {
  std::filesystem::path file;
  Motion motion;  ///< at the model's rate
  Camera camera;
  MatrixD root_position;  ///< [frames x 3] world, file units
  Track2d track;
  MatrixF track_features, pose_features;  ///< [frames x dimension], standardized
};

/// @param notices gets what was odd, if not null
/// @param joint_map roles of the clip's joints, given by hand
/// @throws InputError naming the file
EncodedClip encode_clip(const std::filesystem::path& file, const Modalities& modalities,
                        const CameraPlacement& placement, bool keep_first_frame = false,
                        ClipNotices* notices = nullptr, const JointMap& joint_map = {});

/// A view made from that file, with its own motion and camera. The features are the pose's alone:
/// whether a network can take the track as it is depends on its columns.
EncodedClip encoded_view(const std::filesystem::path& file, const Modalities& modalities,
                         AugmentedView view);

}  // namespace mcdbn
