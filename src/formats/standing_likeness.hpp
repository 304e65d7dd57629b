#pragma once

#include <span>
#include <vector>

#include "formats/seen_people.hpp"

namespace mcdbn {

/// How alike the distances between a person's joints on the image are to those in a person who
/// stands, arms hanging or raised: the cosine of the angle between the two lists of distances. It
/// depends neither on the person's size nor on where and how they are turned in the image.
class StandingLikeness {
 public:
  explicit StandingLikeness(const std::vector<Keypoint>& keypoints);

  /// The larger cosine of both poses; 0 of fewer than two joints.
  /// @param person in pixels  @param joints those to compare, which the person shows
  double of(const SeenPerson& person, std::span<const std::size_t> joints) const;

 private:
  std::vector<MatrixD> distances_;  ///< of each pose [joints x joints]
};

/// Fewer joints of a person show no shape.
inline constexpr std::size_t kLeastJoints = 3;

/// The joints that the person shows.
std::vector<std::size_t> seen_joints(const SeenPerson& person);

/// Those who show kLeastJoints: at most 1000 of all frames, evenly over the film.
std::vector<const SeenPerson*> people_to_judge(const std::vector<std::vector<SeenPerson>>& frames);

/// Pairs of that many joints: by them a person counts.
inline double pairs_of(std::size_t joints) {
  return 0.5 * static_cast<double>(joints) * (static_cast<double>(joints) - 1);
}

}  // namespace mcdbn
