#pragma once

#include <cstdint>

#include "corpus/augmented_views.hpp"
#include "mcdbn/corpus/training_set.hpp"

namespace mcdbn::test {

/// All that decides what a corpus becomes.
struct CorpusConfig : CorpusSettings {
  std::uint64_t seed = 1;
  bool with_views = true;
};

inline TrainingSet make_training_set(const std::vector<std::filesystem::path>& files,
                                     const CorpusConfig& config,
                                     std::vector<std::string>* notices) {
  return mcdbn::make_training_set(load_clips(files, config.keep_first_frame, notices), config,
                                  config.seed, config.with_views);
}

inline TrainingSet make_augmented_views(const std::vector<std::filesystem::path>& files,
                                        const Modalities& modalities, const CorpusConfig& config) {
  return mcdbn::make_augmented_views(load_clips(files, config.keep_first_frame), modalities, config,
                                     config.seed);
}

}  // namespace mcdbn::test
