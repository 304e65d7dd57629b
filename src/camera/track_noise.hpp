#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mcdbn/base/settings.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// What trackers do to a track: add_pixel_noise, drop_joints and hide_arm.
struct TrackDamage {
  double noise_px = 0;
  double missing_share = 0;
  double hidden_s = 0;

  static constexpr Range kNoise_px = within(0, 1000), kMissingShare = within(0, 1),
                         kHidden_s = within(0, 3600);

  template <typename Self, typename Visit>
  static void visit(Self& self, const Visit& visit) {
    visit(Setting{"noise-px", kNoise_px, "px",
                  "standard deviation of Gaussian noise on every joint's x and y"},
          self.noise_px);
    visit(Setting{"missing", kMissingShare, "",
                  "share of the joints of each frame that go missing, each on its own"},
          self.missing_share);
    visit(Setting{"hide", kHidden_s, "seconds",
                  "how long an arm is hidden, in the middle of the clip"},
          self.hidden_s);
  }
};

/// Adds independent Gaussian noise to every joint's x and y, as a 2D pose estimator does; missing
/// joints stay missing. The same seed gives the same noise.
/// @param deviation_px standard deviation in pixels, 0 changes nothing
/// @throws ConfigError if it is not in TrackDamage's range
void add_pixel_noise(Track2d& track, double deviation_px, std::uint64_t seed);

/// Lets every joint of every frame go missing (NaN, confidence 0), each independently of the others
/// with probability `share`. The same seed loses the same ones.
/// @throws ConfigError likewise
void drop_joints(Track2d& track, double share, std::uint64_t seed);

/// Hides an arm for `seconds` in the middle of the track: from the shoulder's child down, so that
/// the shoulder stays. Arms are the two longest chains of bones that hang from the chest, the joint
/// with the longest chains of all below the first at which the body branches. The seed decides
/// which of the two.
/// @param track of the skeleton's own joints, or of a detector's keypoints, which are hidden with
///        the joints of their roles
/// @return the columns that were hidden, by name; none if the body does not branch or the track
///         shows no arm
/// @throws ConfigError likewise
std::vector<std::string> hide_arm(Track2d& track, const Skeleton& skeleton, double seconds,
                                  std::uint64_t seed);

/// Hides limbs, as the body or a table would: every two seconds or so a joint with all
/// that hangs from it, at most a third of the joints, for 0.3 to 1.5 s. The same seed hides the
/// same.
void hide_limbs(Track2d& track, const Skeleton& skeleton, std::uint64_t seed);

/// All three, each from its own stream of the seed.
/// @throws ConfigError as they do; InputError if an arm is to be hidden and the track shows none
void damage_track(Track2d& track, const Skeleton& skeleton, const TrackDamage& damage,
                  std::uint64_t seed);

}  // namespace mcdbn
