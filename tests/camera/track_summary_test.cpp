#include "mcdbn/camera/track_summary.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "camera/track_noise.hpp"

namespace track_summary_test {

using namespace mcdbn;

namespace {

Track2d straight_track(int frames, int joints) {
  Track2d track;
  track.x_px = track.y_px = MatrixD::Zero(frames, joints);
  track.confidence = MatrixD::Ones(frames, joints);
  for (int joint = 0; joint < joints; ++joint) {
    track.joint_names.push_back("joint_" + std::to_string(joint));
    for (int frame = 0; frame < frames; ++frame) {
      track.x_px(frame, joint) = 2.5 * frame + joint;
      track.y_px(frame, joint) = 100 + 30 * joint;
    }
  }
  return track;
}

void lose(Track2d& track, int frame, int joint) {
  track.x_px(frame, joint) = track.y_px(frame, joint) = std::numeric_limits<double>::quiet_NaN();
  track.confidence(frame, joint) = 0;
}

}  // namespace

TEST_CASE("track summary: frames, gaps, joints and height") {
  Track2d track = straight_track(10, 3);
  for (const int frame : {0, 4, 5, 6}) {
    for (int joint = 0; joint < 3; ++joint) lose(track, frame, joint);
  }
  lose(track, 8, 2);
  const TrackSummary summary = summarize(track);
  CHECK(summary.frames == 10);
  CHECK(summary.seen_frames == 6);
  CHECK(summary.first_frame == 1);
  CHECK(summary.last_frame == 9);
  CHECK(summary.longest_gap_frames == 3);
  CHECK(summary.missing_joints == 13);
  CHECK(summary.joint_seen_share[0] == doctest::Approx(0.6));
  CHECK(summary.joint_seen_share[2] == doctest::Approx(0.5));
  CHECK(summary.height_px == doctest::Approx(60));
}

TEST_CASE("track summary: jitter is the deviation of the noise, and no motion") {
  Track2d track = straight_track(300, 5);
  CHECK(summarize(track).jitter_px == doctest::Approx(0).epsilon(1e-9));
  add_pixel_noise(track, 3, 7);
  CHECK(summarize(track).jitter_px == doctest::Approx(3).epsilon(0.05));
  CHECK(std::isnan(summarize(straight_track(2, 5)).jitter_px));
}

TEST_CASE("track summary: a track that shows no person") {
  Track2d track = straight_track(3, 1);
  for (int frame = 0; frame < 3; ++frame) lose(track, frame, 0);
  const TrackSummary summary = summarize(track);
  CHECK(summary.seen_frames == 0);
  CHECK(summary.first_frame == -1);
  CHECK(summary.longest_gap_frames == 0);
  CHECK(summary.height_px == 0);
}

}  // namespace track_summary_test
