#pragma once

#include <vector>

#include "comparison/comparison_run.hpp"
#include "evaluation/report_clip.hpp"

namespace mcdbn {

/// How clips are put under actions: `by_folder` by the name of the folder that they lie in; else
/// all under "all clips".
/// @return what a report needs, clips named by their file
std::vector<ReportClip> report_clips(const Model& model, const std::vector<ClipResult>& results,
                                     bool by_folder);

}  // namespace mcdbn
