#pragma once

#include <memory>
#include <vector>

#include "mcdbn/corpus/clip.hpp"

namespace mcdbn {

/// Metadata of a clip: all but its motion.
struct ClipRecord {
  TrainingClip clip;
  Skeleton skeleton;
  double frame_time_s = 0;
  int frames = 0;

  double seconds() const { return frames * frame_time_s; }
};

/// Where the channels of clips lie: in memory, or in a file that is mapped into it.
class ClipChannels {
 public:
  virtual ~ClipChannels() = default;
  /// Several threads may ask at once. @return [frames x channels]
  virtual MatrixD rows(std::size_t clip, int first, int frames) const = 0;
};

/// Clips to train on, each at its file's own rate, of which pieces are copied when they are wanted.
/// A copy of a store shares the clips.
class ClipStore {
 public:
  ClipStore(std::vector<ClipRecord> records, std::shared_ptr<const ClipChannels> channels)
      : records_(std::move(records)), channels_(std::move(channels)) {}
  // NOLINTNEXTLINE(google-explicit-constructor): clips in memory are a store of themselves.
  ClipStore(std::vector<LoadedClip> clips);

  std::size_t count() const { return records_.size(); }
  const ClipRecord& record(std::size_t clip) const { return records_[clip]; }
  const std::vector<ClipRecord>& records() const { return records_; }
  Motion motion(std::size_t clip) const { return piece(clip, 0, records_[clip].frames); }
  /// Some of a clip's frames. Several threads may ask at once.
  Motion piece(std::size_t clip, int first, int frames) const;
  /// Number of frames of all clips together at `fps`.
  double frames_at(double fps) const;

 private:
  std::vector<ClipRecord> records_;
  std::shared_ptr<const ClipChannels> channels_;
};

}  // namespace mcdbn
