#include "corpus/detector_view.hpp"

#include "base/random_sequence.hpp"
#include "camera/detector_track.hpp"

namespace mcdbn {

AugmentedView detector_view(const Motion& motion, const DetectorViews& views, std::uint64_t seed) {
  // A seed that nothing else uses: code that gets the track must not draw the same numbers.
  const std::uint64_t own = mixed_seed({seed, 0x64657465});
  AugmentedView view;
  view.motion = with_other_body(motion, views.body, own);
  view.camera = random_camera(view.motion, views.cameras, own);
  view.track = detector_track(view.motion, skeleton_roles(view.motion.skeleton), views.keypoints,
                              view.camera, views.noise, own);
  return view;
}

}  // namespace mcdbn
