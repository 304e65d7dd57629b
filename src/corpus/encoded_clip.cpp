#include "corpus/encoded_clip.hpp"

namespace mcdbn {

EncodedClip encode_clip(const std::filesystem::path& file, const Modalities& modalities,
                        const CameraPlacement& placement, bool keep_first_frame,
                        std::vector<std::string>* notices) {
  EncodedClip clip;
  clip.file = file;
  clip.motion =
      load_clip(file, {.fps = modalities.fps, .keep_first_frame = keep_first_frame}, notices);
  clip.camera = place_camera(clip.motion, placement);
  clip.track = project_motion(clip.motion, clip.camera);
  clip.track_features = modalities.encode_track(clip.track, clip.camera);
  clip.pose_features = modalities.encode_pose(clip.motion, clip.camera.camera_from_world);
  const int root = clip.motion.skeleton.find(modalities.root_name());
  clip.root_position = joint_positions(clip.motion).middleCols(3 * root, 3);
  return clip;
}

}  // namespace mcdbn
