#pragma once

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

/// A detector's confidences as weights: how many times as sure as usual a place is, 1 at the median
/// confidence of the track's visible joints and at most 1.5. What detectors call confidence is on
/// scales of their own, so the track itself gives the scale. The variance of what changes from
/// frame to frame (third differences over time) falls with confidence to the power of 3.1 from
/// OpenPose on a treadmill, 2.0 on walking patients, 2.4 of MediaPipe, 3.9 of AlphaPose; 2.5 is
/// taken. 0 stays 0.
Track2d weighted_by_confidence(const Track2d& track);

}  // namespace mcdbn
