#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/scratch_folder.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "motion_model/clip_scene.hpp"

namespace mcdbn::test {

/// A small body that swings its limbs faster or slower, at 30 frames a second.
inline Motion paced_clip(int frames, double pace) {
  Motion motion = swinging(small_body(), frames, 30 * pace);
  motion.frame_time_s = 1.0 / 30;
  return motion;
}

/// Clips that a model was trained on, and others to test it on, all in files.
struct ClipFiles {
  using Named = std::vector<std::pair<std::string, Motion>>;

  ClipFiles(const Named& training_clips, const Named& test_clips, const CameraPlacement& view)
      : model_view(view), modalities(modalities_of(motions(training_clips), view)) {
    for (const auto& [name, motion] : training_clips) training.push_back(write(name, motion));
    for (const auto& [name, motion] : test_clips) tests.push_back(write(name, motion));
  }
  std::filesystem::path write(const std::string& name, const Motion& motion) const {
    write_bvh(folder / name, motion);
    return folder / name;
  }
  Model model(Device& device) const {
    Model model{random_network(device, modalities), modalities, {}, {}};
    for (const auto& file : training) model.training_clips.push_back(identify_clip(file));
    return model;
  }

  ScratchFolder folder;
  CameraPlacement model_view;
  std::vector<std::filesystem::path> training, tests;
  Modalities modalities;

 private:
  static std::vector<Motion> motions(const Named& clips) {
    std::vector<Motion> motions;
    for (const auto& [name, motion] : clips) motions.push_back(motion);
    return motions;
  }
};

}  // namespace mcdbn::test
