#pragma once

#include <fmt/format.h>

#include <vector>

#include "base/scratch_folder.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

namespace mcdbn::test {

/// A file of synthesized walking to be trained on.
struct WalkFile {
  int subject = 1, clip = 1;
  double fps = 30.0, seconds = 1.5;
};

/// BVH files in a folder of their own.
class TrainingFiles {
 public:
  explicit TrainingFiles(const std::vector<WalkFile>& walks) {
    for (const WalkFile& walk : walks) {
      SynthesisOptions options;
      options.subject = walk.subject;
      options.clip = walk.clip;
      options.fps = walk.fps;
      options.seconds = walk.seconds;
      files_.push_back(folder_ / fmt::format("walk_{}_{}.bvh", walk.subject, walk.clip));
      write_bvh(files_.back(), synthesize(options));
    }
  }
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  ScratchFolder folder_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace mcdbn::test
