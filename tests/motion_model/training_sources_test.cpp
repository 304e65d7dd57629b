#include "mcdbn/motion_model/training_sources.hpp"

#include <doctest/doctest.h>

#include "features/small_figure.hpp"

namespace training_sources_test {

using namespace mcdbn;
using namespace mcdbn::test;

TEST_CASE("a training set's clips hold what was seen of the tracks, and of nothing else") {
  const SmallFigure figure;
  TrainingSet set{figure.modalities(), {MatrixF::Zero(4, 3)}, {MatrixF::Ones(4, 2)}, {}, {}, {}};
  CHECK(ClipSource(set).sequences().modalities[kTrack].seen.empty());
  set.tracks_seen = {MatrixF::Zero(4, 3)};
  set.tracks_seen[0](2, 1) = 1;
  const SynchronizedClips clips = ClipSource(set).sequences();
  CHECK_NOTHROW(clips.check());
  REQUIRE(clips.modalities[kTrack].seen.size() == 1);
  CHECK(clips.modalities[kTrack].seen[0] == set.tracks_seen[0]);
  CHECK(clips.modalities[kPose].seen.empty());
}

TEST_CASE(
    "a training set's clips are grouped by person and action, by person where none are given") {
  const SmallFigure figure;
  TrainingSet set{figure.modalities(),
                  {MatrixF::Zero(4, 3), MatrixF::Zero(4, 3)},
                  {MatrixF::Ones(4, 2), MatrixF::Ones(4, 2)},
                  {},
                  {},
                  {}};
  set.people = {7, 7};
  CHECK(ClipSource(set).sequences().groups.back() == 7);
  set.groups = {3, 4};
  CHECK(ClipSource(set).sequences().groups.back() == 4);
}

}  // namespace training_sources_test
