#pragma once

#include <string>
#include <vector>

#include "mcdbn/camera/track.hpp"

namespace mcdbn {

struct FrameRange {
  int first = 0, frames = 0;
  int end() const { return first + frames; }
  bool operator==(const FrameRange&) const = default;
};

/// First and last frames as text: "0-11, 30, 40-52".
/// @param numbers [frames] of the track's frames, as its file has them; none: counted from 0
std::string described(const std::vector<FrameRange>& ranges,
                      const std::vector<long long>& numbers = {});

/// The frames that show no joint at all, in order.
std::vector<FrameRange> frames_of_nobody(const Track2d& track);

/// A track in parts, each of which can be one person's motion.
struct TrackStretches {
  std::vector<FrameRange> stretches;  ///< all frames of the track, in order
  std::vector<FrameRange> strays;     ///< frames that show something elsewhere that is no stretch
};

/// Where a whole body is suddenly elsewhere, or of another size, the detector went on with another
/// person, or the film was cut. The middle of the joints that are seen moves by no more than three
/// quarters of the body's height on the image and seven heights a second: joints come and go, and a
/// runner's 12 m/s are as much. The distances between the joints that two frames both show, if they
/// are eight at least and each frame shows half of a body, grow or shrink by a factor of no more
/// than 1.5 at once, and of 20 in a second, in which somebody may have come nearer. What is
/// elsewhere for less than 0.3 s, or in no frame shows half of the joints that the track shows, is
/// a stray, and what comes before and after it may be one stretch. A detector's joints are those of
/// the limbs.
/// @return one stretch of all frames if there is no such jump, or nothing but jumps; none of no
///         frames
TrackStretches find_stretches(const Track2d& track);

/// The frames' joints are missing from then on.
void leave_out(Track2d& track, const std::vector<FrameRange>& frames);

}  // namespace mcdbn
