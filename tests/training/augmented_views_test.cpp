#include "mcdbn/training/augmented_views.hpp"

#include <doctest/doctest.h>

#include "mcdbn/motion/bvh.hpp"
#include "mcdbn/motion/synthesize.hpp"
#include "motion/scratch_folder.hpp"

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("scaling for the joint stage knows what mirrored views move") {
  const ScratchFolder folder;
  SynthesisOptions options;
  options.action = SynthesisAction::wave_one;  // the other arm hangs
  options.seconds = 3.0;
  const std::vector<std::filesystem::path> files{folder / "wave.bvh"};
  write_bvh(files.front(), synthesize(options));

  TrainingConfig config;
  config.augment.views = 8;
  const auto largest = [&](const TrainingConfig& scaled_for) {
    const TrainingSet set = make_training_set(files, scaled_for, nullptr);
    CHECK(set.poses.size() == 1);  // views scale, they are not clips
    const TrainingSet views = make_augmented_views(files, set.modalities, config);
    CHECK(views.poses.size() == 8);
    CHECK(views.clips.size() == 8);
    float value = 0;
    for (const MatrixF& pose : views.poses) value = std::max(value, pose.cwiseAbs().maxCoeff());
    return value;
  };
  TrainingConfig clips_alone = config;
  clips_alone.joint.steps = 0;
  const float with_views = largest(config), without = largest(clips_alone);
  CHECK(with_views < 10.0F);
  CHECK(without > 5.0F * with_views);
}
