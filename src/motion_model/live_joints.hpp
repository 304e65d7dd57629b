#pragma once

#include <optional>

#include "camera/keypoint_map.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/camera/track_frame.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The last seconds of a growing track, at the model's rate, and the model's joints that they show.
/// The newest frames are open: which of a person's sides is which may still be found out.
class LiveJoints {
 public:
  /// @param like a track of the same joints and image size  @param fps the model's rate
  /// @param map of a detector's keypoints; without one the columns are the model's joints
  LiveJoints(const Track2d& like, double fps, std::optional<KeypointMap> map);

  /// @throws ShapeError if it has other joints
  void push(const TrackFrame& frame);
  /// Exchanges sides that a detector confused. Those of settled frames stay as they are.
  /// @param open how many of the newest frames may be changed
  void correct_sides(Eigen::Index open);
  /// Finds the joints of the frames from `first` on, after correct_sides().
  /// @param answer a motion of these frames, or of all of them but the newest; null: none is known
  /// @param camera that sees it
  void find(Eigen::Index first, const Motion* answer, const Camera& camera);
  /// The first open frames stay with the sides that they have now.
  /// @param open as for correct_sides  @param count how many settle
  void settle(Eigen::Index open, Eigen::Index count);
  void drop_oldest(Eigen::Index frames);
  void clear();

  Eigen::Index frames() const { return recent_.frames(); }
  bool from_keypoints() const { return map_.has_value(); }
  /// The joints of all frames, as they were found last.
  const Track2d& joints() const { return joints_; }
  /// What a fit may take the frames from `first` on for (KeypointMap::evidence).
  Track2d evidence(Eigen::Index first) const;

 private:
  Track2d recent_;     ///< settled frames with their sides put right, open ones as they came
  Track2d corrected_;  ///< recent_ with the sides of the open frames put right
  Track2d joints_;
  std::optional<KeypointMap> map_;
};

}  // namespace mcdbn
