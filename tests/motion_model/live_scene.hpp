#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "features/clip_modalities.hpp"
#include "mcdbn/motion_model/live_regeneration.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "motion/body_size.hpp"
#include "motion_model/live_networks.hpp"

namespace mcdbn::test {

/// A walk that a camera sees, and a model of another walk.
struct LiveScene {
  Motion training = walk(1, 60, 30);
  CameraPlacement view{35, 12, std::nullopt, 45, 1920, 1080};
  Modalities modalities = modalities_of({training}, view);
  Motion clip;
  Camera camera;
  Track2d track;

  explicit LiveScene(double fps = 30, int frames = 50)
      : clip(walk(2, frames, fps)),
        camera(place_camera(clip, view)),
        track(project_motion(clip, camera)) {}
  ClipPlacement placement() const {
    ClipPlacement placement{{camera, clip.skeleton}};
    // How exact the track is, live and whole clip would learn at their own pace.
    placement.fit->most_solutions = 1;
    return placement;
  }
  Model model(Device& device) const {
    return {quiet_network(device, modalities), modalities, {}, {}};
  }

 private:
  static Motion walk(int clip, int frames, double fps) {
    SynthesisOptions options;
    options.clip = clip;
    options.seconds = (frames + 1) / fps;
    options.fps = fps;
    Motion motion = synthesize(options);
    motion.channels.conservativeResize(frames, Eigen::NoChange);
    return motion;
  }
};

/// Joints from the root, mm of a 1.7 m body. [frames x 3·joints]
inline MatrixD places_mm(const Motion& motion) {
  const MatrixD all = joint_positions(motion);
  return 1000 / file_units_per_metre(motion.skeleton) *
         (all - all.leftCols(3).replicate(1, all.cols() / 3));
}

/// Mean distance between two motions' joints, from frame `first` on.
inline double apart_mm(const Motion& one, const Motion& other, Eigen::Index first = 0) {
  const MatrixD off = (places_mm(one) - places_mm(other)).bottomRows(one.frames() - first);
  double sum = 0;
  for (Eigen::Index column = 0; column < off.cols(); column += 3)
    sum += off.middleCols<3>(column).rowwise().norm().mean();
  return 3 * sum / static_cast<double>(off.cols());
}

inline TrackFrame frame_of(const Track2d& track, Eigen::Index frame) {
  return {track.x_px.row(frame), track.y_px.row(frame), track.confidence.row(frame)};
}

/// Of all joints, or of one.
inline void hide(Track2d& track, Eigen::Index first, Eigen::Index count, Eigen::Index joint = -1) {
  for (Eigen::Index t = first; t < first + count; ++t)
    for (Eigen::Index j = 0; j < track.joint_count(); ++j) {
      if (joint >= 0 && j != joint) continue;
      track.x_px(t, j) = track.y_px(t, j) = std::numeric_limits<double>::quiet_NaN();
      track.confidence(t, j) = 0;
    }
}

/// All that comes back, on the body as it is known in the end.
inline Motion followed(LiveRegeneration& live, const Track2d& track) {
  std::vector<LiveFrame> frames;
  const auto add = [&](std::vector<LiveFrame> more) {
    for (LiveFrame& frame : more) frames.push_back(std::move(frame));
  };
  for (int t = 0; t < track.frames(); ++t) add(live.push(frame_of(track, t)));
  add(live.finish());
  Motion motion{live.skeleton(), 1 / live.fps(),
                MatrixD(std::ssize(frames), live.skeleton().channel_count())};
  for (std::size_t t = 0; t < frames.size(); ++t)
    motion.channels.row(static_cast<Eigen::Index>(t)) = frames[t].channels;
  return motion;
}

}  // namespace mcdbn::test
