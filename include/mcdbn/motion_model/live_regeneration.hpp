#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mcdbn/camera/track_frame.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"

namespace mcdbn {

/// One frame of regenerated motion.
struct LiveFrame {
  RowVectorD channels;  ///< of LiveRegeneration::skeleton(), degrees and file units
  /// Whether the track's frame shows anybody. Where not, it is the model's mean pose until a person
  /// is found, and later follows from the frames around.
  bool seen = true;
};

/// 3D motion from a 2D track that is still growing, frame by frame. Frames come back in order, each
/// once, at most latency_frames() frames of the model's rate after they were pushed; memory and
/// time of a frame do not grow beyond what the last 15 s take. A frame that was returned does not
/// change any more, so that the motion differs a little from the whole clip's answer
/// (docs/concepts.md, Live). Body and camera are looked for on a thread of its own. Clips are
/// independent: one object each.
class LiveRegeneration {
 public:
  /// Frames that an answer waits for beside the model's look-ahead, so that the fit sees how the
  /// track goes on.
  static constexpr int kMoreFrames = 3;

  /// @param model has to outlive this
  /// @param like a track without frames: its joints, rate and image size
  /// @param placement as for regenerate_clip; a fit is needed
  /// @param look_ahead frames of the model's rate that an answer waits for, at most and by default
  ///        the model's own; with fewer the network sees the track carried on instead
  /// @throws ConfigError without a fit, for a look-ahead beyond the model's, or a skeleton of other
  ///         joints than the model's; InputError if the track shows too little of the model's
  ///         joints
  LiveRegeneration(const Model& model, const Track2d& like, const ClipPlacement& placement,
                   std::optional<std::size_t> look_ahead = {});
  ~LiveRegeneration();
  LiveRegeneration(const LiveRegeneration&) = delete;
  LiveRegeneration& operator=(const LiveRegeneration&) = delete;

  /// What comes back for frames before a person is found: the model's mean pose above the origin,
  /// its feet on the ground. The track's joints may not be known yet: it is for a detector's track.
  /// @return one frame, on the skeleton that the fit to such a track begins with
  /// @throws ConfigError as the constructor does
  static Motion before_anybody(const Model& model, const ClipPlacement& placement,
                               std::optional<std::size_t> look_ahead = {});

  /// The next frame of the track. @return those that are finished now, at the track's rate
  /// @throws ShapeError if it has other joints
  std::vector<LiveFrame> push(const TrackFrame& frame);
  /// The track has ended. @return the rest; frames pushed and frames returned are as many
  std::vector<LiveFrame> finish();

  int latency_frames() const { return latency_frames_; }  ///< at most, of the model's rate
  /// The person's own, or the model's with bones as long as they are estimated by now.
  const Skeleton& skeleton() const;
  double fps() const;     ///< of the frames, the track's
  Camera camera() const;  ///< that sees the motion as the track shows it, in its file units

 private:
  int latency_frames_;
  class Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

}  // namespace mcdbn
