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
  /// Gone on from its end, and from moments `every_s` apart before it while seed_frames() frames
  /// are left; 0: from its end alone.
  double every_s = 0;
};

/// Motion that goes on where each clip ends, or from moments all over it, `samples` times each
/// (Algorithm 4 on the model's 3D CDBN).
/// The person is the clip's own, seen as the model's camera would see it, in each sample from the
/// next of the directions that the model was trained on; the root keeps the features'
/// height and travels by their velocity.
/// @param health if given, of the standardized features of all samples of all clips; their speed is
///        compared with the whole clip's
/// @return the new frames alone, at the model's rate, result[moment · samples + sample], the
///         moments of all clips one after another
/// @throws InputError naming the clip that lacks a joint of the model or is too short
std::vector<Motion> generate_clips(const Model& model, const std::vector<SeedClip>& seeds,
                                   const GenerationOptions& options = {},
                                   GenerationHealth* health = nullptr);

}  // namespace mcdbn
