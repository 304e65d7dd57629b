#pragma once

#include <Eigen/Core>
#include <vector>

namespace mcdbn {

/// A foot in one frame: along which ray (x/z and y/z) it was seen, how surely (0…1), and how far
/// from the camera the answer has it.
struct SeenFoot {
  Eigen::Vector2d ray{0, 0};
  double surely = 0;
  double depth = 0;
};

/// How far from the camera a foot that stands is.
struct FootDepth {
  double depth = 0;
  double surely = 0;  ///< 0…1
};

/// A foot that stays where it is on the image stands (StandingOnImage), and comes no nearer either:
/// by frame, the mean of the depths it has in the frames around, each counted by how little it is
/// elsewhere on the image there. A foot that moves or rolls is hardly held, as only few frames
/// share its position.
/// @param still on the rays, how far apart a foot that stands is seen
/// @param around_frames deviation of the Gaussian that says which frames are around
std::vector<FootDepth> standing_depths(const std::vector<SeenFoot>& foot, double still,
                                       double around_frames);

}  // namespace mcdbn
