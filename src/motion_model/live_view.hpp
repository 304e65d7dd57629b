#pragma once

#include "fitting/sliding_fit.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"

namespace mcdbn {

/// The camera of a track that is still growing. A known one stays. Of one that is assumed feet on
/// level ground tell pitch and roll (levelled_view): the first frames before any comes back, then
/// the last ten seconds every second; what changes comes in slowly, so that the world does not
/// jump. The world's origin is below where the first frame showed the root.
class LiveView {
 public:
  LiveView(const Modalities& modalities, const ClipPlacement& placement, int width_px,
           int height_px);

  /// In metres or file units, as it was given.
  const Camera& camera() const { return camera_; }
  /// As the fit takes it. @return in file units of the fit's skeleton
  Camera camera_in_file_units(const SlidingFit& fit) const {
    return known_ ? fit.camera() : camera_;
  }

  /// One frame's change of view.
  void step();
  /// What the fit has found. @param prior whose features say how high the root is
  void see(const SlidingFit& fit, const PosePrior& prior);
  /// A pose that came back. @param pose [1 x channels]
  void keep(const Skeleton& skeleton, const RowVectorD& pose);

 private:
  void look(const AssumedView& view);

  const Modalities& modalities_;
  AssumedView said_, view_, wanted_;
  bool known_, finds_;
  int width_px_, height_px_;
  Camera camera_;
  Motion kept_;  ///< the last of them, in the world of kept_in_
  Camera kept_in_;
  Eigen::Index kept_since_ = 0;  ///< since pitch and roll were asked last
};

}  // namespace mcdbn
