#pragma once

#include <string>
#include <vector>

#include "mcdbn/machines/generation.hpp"
#include "mcdbn/machines/generation_health.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn {

/// A clip that generated motion goes on from.
struct SeedClip {
  std::string name;  ///< for messages
  Motion motion;     ///< at any rate, at least seed_frames() frames at the model's
};

/// Motion that goes on where each clip ends, `samples` times (Algorithm 4 on the model's 3D CDBN).
/// The person is the clip's own, seen as the model's camera would see it, in each sample from the
/// next of the directions that the model was trained on; the root keeps the height that the
/// features say and travels by their velocity.
/// @param health if given, of the standardized features of all samples of all clips
/// @return the new frames alone, at the model's rate, result[clip · samples + sample]
/// @throws InputError naming the clip that lacks a joint of the model or is too short
std::vector<Motion> generate_clips(const Model& model, const std::vector<SeedClip>& seeds,
                                   const GenerationOptions& options = {},
                                   GenerationHealth* health = nullptr);

}  // namespace mcdbn
