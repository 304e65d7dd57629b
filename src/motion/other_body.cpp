#include "motion/other_body.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random_streams.hpp"
#include "mcdbn/base/random.hpp"
#include "motion/body_size.hpp"
#include "motion/mirror.hpp"

namespace mcdbn {

void scale_bones(Motion& motion, const std::function<double(int joint)>& factor) {
  Skeleton& skeleton = motion.skeleton;
  const double size = body_height(skeleton);
  const std::vector<int> opposite = opposite_joints(skeleton);
  for (int j = 0; j < skeleton.joint_count(); ++j)
    skeleton.joints[j].offset *= factor(opposite.empty() ? j : std::min(j, opposite[j]));
  const int root = moving_root({&motion});
  const Joint& joint = skeleton.joints[root];
  for (std::size_t k = 0; k < joint.channels.size(); ++k)
    if (!is_rotation(joint.channels[k]))
      motion.channels.col(skeleton.first_channel(root) + static_cast<int>(k)) *=
          body_height(skeleton) / size;
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
