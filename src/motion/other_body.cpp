#include "motion/other_body.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random_streams.hpp"
#include "mcdbn/base/random.hpp"
#include "motion/body_size.hpp"
#include "motion/mirror.hpp"

namespace mcdbn {
namespace {

void scale_positions(Motion& motion, int joint, double factor) {
  const std::vector<Channel>& channels = motion.skeleton.joints[joint].channels;
  for (std::size_t k = 0; k < channels.size(); ++k)
    if (!is_rotation(channels[k]))
      motion.channels.col(motion.skeleton.first_channel(joint) + static_cast<int>(k)) *= factor;
}

}  // namespace

void scale_bones(Motion& motion, const std::function<double(int joint)>& factor) {
  Skeleton& skeleton = motion.skeleton;
  const double size = body_height(skeleton);
  const std::vector<int> opposite = opposite_joints(skeleton);
  const int root = moving_root({&motion});
  for (int j = 0; j < skeleton.joint_count(); ++j) {
    const double longer = factor(opposite.empty() ? j : std::min(j, opposite[j]));
    skeleton.joints[j].offset *= longer;
    // Positions stand for offsets.
    if (j > root) scale_positions(motion, j, longer);
  }
  // The path is the sum of what these joints travel.
  for (int j = 0; j <= root; ++j) scale_positions(motion, j, body_height(skeleton) / size);
}

Motion with_other_body(Motion motion, const OtherBody& deviations, std::uint64_t seed) {
  const RandomKey key{seed, 0, random_streams::kOtherBody, 0};
  const double height = deviations.height * random_normal(key, 0, 0);
  scale_bones(motion, [&](int joint) {
    return std::exp(height + deviations.proportions *
                                 random_normal(key, 1, static_cast<std::uint32_t>(joint)));
  });
  return motion;
}

}  // namespace mcdbn
