#pragma once

#include <vector>

#include "mcdbn/machines/generation.hpp"
#include "mcdbn/machines/generation_health.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn {

/// Motion that goes on where a clip ends, `samples` times (Algorithm 4 on the model's 3D CDBN). The
/// person is the clip's own, seen as the model's camera would see it; the root keeps the height
/// that the features say and travels by their velocity.
/// @param seed at any rate, at least seed_frames() frames at the model's
/// @param health if given, of the standardized features of all samples
/// @return the new frames alone, at the model's rate
/// @throws InputError if the clip lacks a joint of the model or is too short
std::vector<Motion> generate_clip(const Model& model, const Motion& seed,
                                  const GenerationOptions& options = {},
                                  GenerationHealth* health = nullptr);

}  // namespace mcdbn
