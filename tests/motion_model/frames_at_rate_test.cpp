// A growing track at another rate, against resample_track, which sees all of it.
#include "motion_model/frames_at_rate.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "camera/track_resample.hpp"
#include "mcdbn/base/errors.hpp"

namespace frames_at_rate_test {

using namespace mcdbn;

namespace {

Track2d some_track(double fps, Eigen::Index frames) {
  Track2d track;
  track.fps = fps;
  track.joint_names = {"hip", "knee"};
  track.x_px.resize(frames, 2);
  for (Eigen::Index t = 0; t < frames; ++t)
    track.x_px.row(t) << 100 + 5 * std::sin(0.7 * static_cast<double>(t)), static_cast<double>(t);
  track.y_px = 2 * track.x_px;
  track.confidence = MatrixD::Constant(frames, 2, 0.5);
  return track;
}

TrackFrame frame_of(const Track2d& track, Eigen::Index t) {
  return {track.x_px.row(t), track.y_px.row(t), track.confidence.row(t)};
}

}  // namespace

TEST_CASE("frames at rate: those of the whole track, each as soon as it is certain") {
  for (const double fps : {30.0, 12.0, 25.0, 75.0, 240.0}) {
    CAPTURE(fps);
    const Track2d track = some_track(fps, 40);
    const Track2d whole = resample_track(track, 30);
    FramesAtRate frames(track, 30);
    CHECK(frames.same_rate() == (fps == 30));
    Eigen::Index taken = 0;
    const auto check = [&](bool ended) {
      for (const TrackFrame& frame : frames.take(ended)) {
        REQUIRE(taken < whole.frames());
        CHECK((frame.x_px - whole.x_px.row(taken)).cwiseAbs().maxCoeff() < 1e-9);
        CHECK((frame.y_px - whole.y_px.row(taken)).cwiseAbs().maxCoeff() < 1e-9);
        CHECK((frame.confidence - whole.confidence.row(taken)).cwiseAbs().maxCoeff() < 1e-9);
        ++taken;
      }
    };
    for (Eigen::Index t = 0; t < track.frames(); ++t) {
      frames.push(frame_of(track, t));
      check(false);
      // The newest may wait for one track frame and for all that are averaged.
      CHECK(static_cast<double>(taken) > (static_cast<double>(t) / fps - 1 / fps) * 30 - 1);
    }
    check(true);
    CHECK(frames.pushed() == 40);
    CHECK(taken == 1 + static_cast<Eigen::Index>(std::floor(39 * 30 / fps + 1e-9)));
    CHECK(frames.take(true).empty());
  }
}

TEST_CASE("frames at rate: a frame of other joints is refused") {
  FramesAtRate frames(some_track(25, 1), 30);
  CHECK_THROWS_AS(frames.push(TrackFrame::unseen(3)), ShapeError);
}

}  // namespace frames_at_rate_test
