#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/corpus/clip_list.hpp"
#include "mcdbn/corpus/training_set.hpp"

namespace mcdbn {

/// Reads clips to train on by several threads, all of one skeleton or, by settings.skeleton, on
/// the canonical humanoid.
/// @param notices as load_clip collects them, and what is lost on the humanoid
/// @throws InputError as load_clip does; naming the file whose skeleton lacks joints or is
/// not a person's
std::vector<LoadedClip> load_training_clips(const std::vector<ListedClip>& files,
                                            const CorpusSettings& settings,
                                            std::vector<std::string>* notices = nullptr);

/// The same, but they go through a file that is mapped into memory, and do not lie there as a
/// whole. Where the file is there already, of these very clips and settings, no clip is read; where
/// it is of others or damaged that is a notice, and it is made anew.
/// @throws InputError as load_training_clips does, or if the file cannot be written
ClipStore cached_training_clips(const std::vector<ListedClip>& files,
                                const CorpusSettings& settings, const std::filesystem::path& cache,
                                std::vector<std::string>* notices = nullptr);

/// The clip as a model of that skeleton takes it: brought onto the canonical humanoid if that is
/// the model's and the clip's is another.
/// @param joint_map roles of the clip's joints, given by hand
/// @throws InputError if it cannot be brought onto it
Motion for_skeleton(Motion clip, const Skeleton& model, const JointMap& joint_map = {});

}  // namespace mcdbn
