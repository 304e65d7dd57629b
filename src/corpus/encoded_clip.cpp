#include "corpus/encoded_clip.hpp"

#include <utility>

#include "base/named_errors.hpp"
#include "mcdbn/corpus/training_clips.hpp"

namespace mcdbn {
namespace {

MatrixD root_path(const Motion& motion, const Modalities& modalities) {
  return joint_positions(motion).middleCols(3 * motion.skeleton.find(modalities.root_name()), 3);
}

EncodedClip encoded(const std::filesystem::path& file, Motion motion, const Modalities& modalities,
                    const CameraPlacement& placement) {
  EncodedClip clip;
  clip.file = file;
  clip.motion = std::move(motion);
  clip.camera = place_camera(clip.motion, placement);
  clip.track = project_motion(clip.motion, clip.camera);
  clip.track_features = modalities.encode_track(clip.track, clip.camera);
  clip.pose_features = modalities.encode_pose(clip.motion, clip.camera.camera_from_world);
  clip.root_position = root_path(clip.motion, modalities);
  return clip;
}

}  // namespace

EncodedClip encode_clip(const std::filesystem::path& file, const Modalities& modalities,
                        const CameraPlacement& placement, bool keep_first_frame,
                        ClipNotices* notices, const JointMap& joint_map) {
  ClipNotices ignored;
  Motion motion = load_clip(file, {.fps = modalities.fps, .keep_first_frame = keep_first_frame},
                            notices != nullptr ? *notices : ignored);
  return with_name(file.string(), [&] {
    return encoded(file,
                   for_skeleton(std::move(motion), modalities.pose_features.skeleton(), joint_map),
                   modalities, placement);
  });
}

EncodedClip encoded_view(const std::filesystem::path& file, const Modalities& modalities,
                         AugmentedView view) {
  EncodedClip clip;
  clip.file = file;
  clip.motion = std::move(view.motion);
  clip.camera = std::move(view.camera);
  clip.track = std::move(view.track);
  clip.pose_features = modalities.encode_pose(clip.motion, clip.camera.camera_from_world);
  clip.root_position = root_path(clip.motion, modalities);
  return clip;
}

}  // namespace mcdbn
