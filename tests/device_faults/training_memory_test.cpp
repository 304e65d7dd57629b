// What the end of a training takes of a device's memory.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "base/random_matrix.hpp"
#include "device_faults/tiny_training.hpp"
#include "features/small_figure.hpp"
#include "learning/learnt_deviation.hpp"
#include "machines/answer_batches.hpp"
#include "motion_model/clip_scene.hpp"
#include "motion_model/sample_calibration.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

namespace {

/// A clip of 100 s among many of 2 s.
struct OneLongClip {
  Modalities modalities = SmallFigure().modalities();
  std::vector<MatrixF> tracks, poses;

  OneLongClip() {
    for (unsigned i = 0; i < 60; ++i) {
      const std::size_t frames = i == 7 ? 3000 : 60;
      tracks.push_back(random_matrix(frames, columns(modalities.track_scale), 100 + i));
      poses.push_back(random_matrix(frames, columns(modalities.pose_scale), 200 + i));
    }
  }
  std::size_t widest() const {
    return std::max(columns(modalities.track_scale), columns(modalities.pose_scale));
  }

 private:
  static std::size_t columns(const Standardizer& scale) {
    return static_cast<std::size_t>(scale.output_dimension());
  }
};

}  // namespace

TEST_CASE(
    "what a trained network answers takes memory for some frames, not for all clips as long as "
    "the longest") {
  const HealthyDriver driver;
  const OneLongClip clips;
  Device device = Device::open();
  const Mcdbn network = random_network(device, clips.modalities);
  const std::array<ModalityClips, 2> modalities{ModalityClips{"2d", clips.tracks},
                                                ModalityClips{"3d", clips.poses}};
  // A clip is run in and looked ahead from for less than it has frames; rows are padded.
  const std::size_t most =
      sizeof(float) * 2 * static_cast<std::size_t>(kFramesInStep) * (clips.widest() + 16);
  layer::heal();
  learnt_deviation(network, {{modalities.begin(), modalities.end()}, {}}, nullptr);
  CHECK(layer::largest_buffer_bytes() > 0);
  CHECK(layer::largest_buffer_bytes() < most);
  layer::heal();
  calibrated_sampling(network, clips.modalities, clips.tracks, clips.poses);
  CHECK(layer::largest_buffer_bytes() > 0);
  CHECK(layer::largest_buffer_bytes() < most);
}
