#pragma once

#include <doctest/doctest.h>

#include "fitting/sliding_fit.hpp"
#include "fitting/track_smoothing.hpp"

namespace mcdbn::test {

inline PosePrior some_rows(const PosePrior& prior, Eigen::Index first, Eigen::Index count) {
  if (!prior.has_deviation()) return MatrixF(prior.mean.middleRows(first, count));
  return {prior.mean.middleRows(first, count), prior.deviation.middleRows(first, count)};
}

inline Track2d some_rows(const Track2d& track, Eigen::Index first, Eigen::Index count) {
  Track2d part = track;
  part.x_px = track.x_px.middleRows(first, count);
  part.y_px = track.y_px.middleRows(first, count);
  part.confidence = track.confidence.middleRows(first, count);
  return part;
}

/// Frame after frame, each settled when `lag` more have come.
/// @param look is called after each frame, with how many have come
/// @return the channels as they settled
template <typename Look>
MatrixD settled_channels(SlidingFit& fit, const PosePrior& prior, const Track2d& track,
                         Eigen::Index lag, const Look& look) {
  const Eigen::Index frames = track.frames();
  MatrixD channels;
  Eigen::Index first = 0, settled = 0;
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index count = t + 1 - first;
    fit.solve(some_rows(prior, first + fit.held(), count - fit.held()),
              some_rows(track, first, count), track_noise_px(some_rows(track, 0, t + 1)));
    look(t + 1);
    const Eigen::Index done = (t + 1 == frames ? frames : t + 1 - lag) - settled;
    if (done <= 0) continue;
    channels.conservativeResize(settled + done, fit.motion().channels.cols());
    channels.bottomRows(done) = fit.motion().channels.middleRows(fit.held(), done);
    settled += done;
    first += fit.settle(done);
    DOCTEST_CHECK(fit.held() <= SlidingFit::kHeld);
    DOCTEST_CHECK(fit.motion().frames() == t + 1 - first);
  }
  return channels;
}

}  // namespace mcdbn::test
