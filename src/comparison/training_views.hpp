#pragma once

#include "comparison/comparison_run.hpp"

namespace mcdbn {

/// Gives a test run the views that the model's fine-tuning learnt from, made again, if one of its
/// baselines learns from views (the MLP). Nothing if there was no fine-tuning, or a training clip
/// is gone: run_test reports it where it needs one.
/// @throws InputError if a training clip cannot be read
/// @throws ConfigError if the model's record of settings is not this program's
void add_training_views(const Model& model, TestRunOptions& run);

}  // namespace mcdbn
