#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "comparison/baseline.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn {

/// What baselines learn from: standardized features, [frames x dimension] a clip.
struct BaselineTrainingData {
  std::vector<MatrixF> tracks, poses;  ///< the model's training clips
  /// The views that the model's fine-tuning saw, for those that learn from views (the MLP), so that
  /// both learnt from the same; may be empty.
  std::vector<MatrixF> view_tracks, view_poses;
};

/// @param otherwise what can be done besides, for the message
/// @throws InputError naming the first training clip of the model that is gone
void require_training_clips(const Model& model, std::string_view otherwise);
/// The model's training clips as they are.
/// @param joint_map roles of clips' joints, given by hand  @throws InputError if one is gone
BaselineTrainingData clip_training_data(const Model& model, bool keep_first_frame,
                                        const JointMap& joint_map = {});
/// With the views of the model's fine-tuning, made again, if that baseline learns from views.
/// @param name of all_baselines()
/// @throws InputError likewise; ConfigError if the model's record of settings is not this program's
BaselineTrainingData training_data_of(const std::string& name, const Model& model);

/// @param name of all_baselines()  @throws ConfigError
std::unique_ptr<Baseline> fitted_baseline(const std::string& name, const Model& model,
                                          const BaselineTrainingData& data);

}  // namespace mcdbn
