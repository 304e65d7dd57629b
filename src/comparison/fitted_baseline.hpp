#pragma once

#include <memory>
#include <string>
#include <vector>

#include "comparison/baseline.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn {

/// What baselines learn from: standardized features, [frames x dimension] a clip.
struct BaselineLessons {
  std::vector<MatrixF> tracks, poses;  ///< the model's training clips
  /// The views that the model's fine-tuning saw, for those that learn from views (the MLP), so that
  /// both learnt from the same; may be empty.
  std::vector<MatrixF> view_tracks, view_poses;
};

/// The model's training clips as they are. @throws InputError if one is gone
BaselineLessons clip_lessons(const Model& model, bool keep_first_frame);
/// With the views of the model's fine-tuning, made again, if that baseline learns from views.
/// @param name of all_baselines()
/// @throws InputError likewise; ConfigError if the model's record of settings is not this program's
BaselineLessons lessons_of(const std::string& name, const Model& model);

/// @param name of all_baselines()  @throws ConfigError
std::unique_ptr<Baseline> fitted_baseline(const std::string& name, const Model& model,
                                          const BaselineLessons& lessons);

}  // namespace mcdbn
