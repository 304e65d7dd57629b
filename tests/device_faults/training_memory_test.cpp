// What the end of a training takes of a device's memory.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "device_faults/tiny_training.hpp"
#include "learning/learnt_deviation.hpp"
#include "machines/answer_batches.hpp"
#include "motion_model/clip_scene.hpp"
#include "motion_model/sample_calibration.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE(
    "what a trained network answers takes memory for some frames, not for all clips as long as "
    "the longest") {
  const HealthyDriver driver;
  std::vector<std::size_t> frames(60, 60);
  frames[7] = 3000;  // 100 s among many of 2 s
  const RandomClips clips(frames);
  Device device = Device::open();
  const Mcdbn network = random_network(device, clips.modalities);
  const std::array<ModalityClips, 2> modalities{ModalityClips{"2d", clips.tracks},
                                                ModalityClips{"3d", clips.poses}};
  const std::size_t widest = std::max(RandomClips::columns(clips.modalities.track_scale),
                                      RandomClips::columns(clips.modalities.pose_scale));
  // A clip is run in and looked ahead from for less than it has frames; rows are padded.
  const std::size_t most =
      sizeof(float) * 2 * static_cast<std::size_t>(kFramesInStep) * (widest + 16);
  layer::heal();
  learnt_deviation(network, {{modalities.begin(), modalities.end()}, {}}, nullptr);
  CHECK(layer::largest_buffer_bytes() > 0);
  CHECK(layer::largest_buffer_bytes() < most);
  layer::heal();
  calibrated_sampling(network, clips.modalities, clips.tracks, clips.poses);
  CHECK(layer::largest_buffer_bytes() > 0);
  CHECK(layer::largest_buffer_bytes() < most);
}
