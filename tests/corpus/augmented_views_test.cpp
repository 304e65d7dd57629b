#include "corpus/augmented_views.hpp"
#include "corpus/corpus_config.hpp"

#include <doctest/doctest.h>

#include "base/scratch_folder.hpp"
#include "mcdbn/corpus/training_set.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/synthesis/synthesize.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("scaling for fine-tuning covers what mirrored views move") {
  const ScratchFolder folder;
  SynthesisOptions options;
  options.action = SynthesisAction::wave_one;  // the other arm hangs
  options.seconds = 3.0;
  const std::vector<std::filesystem::path> files{folder / "wave.bvh"};
  write_bvh(files.front(), synthesize(options));

  CorpusConfig config;
  config.augment.views = 8;
  const auto largest = [&](const CorpusConfig& scaled_for) {
    const TrainingSet set = make_training_set(files, scaled_for, nullptr);
    CHECK(set.poses.size() == 1);  // views scale, they are not clips
    const TrainingSet views = make_augmented_views(files, set.modalities, config);
    CHECK(views.poses.size() == 8);
    CHECK(views.clips.size() == 8);
    float value = 0;
    for (const MatrixF& pose : views.poses) value = std::max(value, pose.cwiseAbs().maxCoeff());
    return value;
  };
  CorpusConfig clips_alone = config;
  clips_alone.with_views = false;
  const float with_views = largest(config), without = largest(clips_alone);
  CHECK(with_views < 10.0F);
  CHECK(without > 5.0F * with_views);
}
