#include "formats/standing_likeness.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera/keypoint_places.hpp"
#include "mcdbn/motion/humanoid.hpp"

namespace mcdbn {
namespace {

constexpr std::size_t kMostJudged = 1000;

/// Arms at 80 degrees below and above the level.
Motion standing_poses() {
  const Skeleton& skeleton = canonical_humanoid();
  constexpr double kArm_deg = 80;
  Motion motion{skeleton, 1, MatrixD::Zero(2, skeleton.channel_count())};
  for (const auto& [role, up_deg] : {std::pair{JointRole::left_shoulder, kArm_deg},
                                     std::pair{JointRole::right_shoulder, -kArm_deg}}) {
    const int joint = humanoid_roles().joint(role);
    const auto& channels = skeleton.joints[static_cast<std::size_t>(joint)].channels;
    const auto about_z = std::ranges::find(channels, Channel::z_rotation) - channels.begin();
    motion.channels(0, skeleton.first_channel(joint) + about_z) = -up_deg;
    motion.channels(1, skeleton.first_channel(joint) + about_z) = up_deg;
  }
  return motion;
}

}  // namespace

StandingLikeness::StandingLikeness(const std::vector<Keypoint>& keypoints) {
  const MatrixD places = keypoint_places(standing_poses(), humanoid_roles(), keypoints);
  const auto joints = std::ssize(keypoints);
  for (Eigen::Index pose = 0; pose < places.rows(); ++pose) {
    MatrixD distances(joints, joints);
    for (Eigen::Index i = 0; i < joints; ++i)
      for (Eigen::Index k = 0; k < joints; ++k)
        distances(i, k) =
            (places.row(pose).segment<3>(3 * i) - places.row(pose).segment<3>(3 * k)).norm();
    distances_.push_back(std::move(distances));
  }
}

double StandingLikeness::of(const SeenPerson& person, std::span<const std::size_t> joints) const {
  double best = 0;
  for (const MatrixD& standing : distances_) {
    double both = 0, seen = 0, stood = 0;
    for (std::size_t a = 0; a < joints.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const std::size_t i = joints[a], k = joints[b];
        const double distance =
            std::hypot(person.x_px[i] - person.x_px[k], person.y_px[i] - person.y_px[k]);
        const double expected =
            standing(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
        both += distance * expected;
        seen += distance * distance;
        stood += expected * expected;
      }
    if (seen > 0 && stood > 0) best = std::max(best, both / std::sqrt(seen * stood));
  }
  return best;
}

std::vector<std::size_t> seen_joints(const SeenPerson& person) {
  std::vector<std::size_t> joints;
  for (std::size_t joint = 0; joint < person.confidence.size(); ++joint)
    if (person.confidence[joint] > 0) joints.push_back(joint);
  return joints;
}

std::vector<const SeenPerson*> people_to_judge(const std::vector<std::vector<SeenPerson>>& frames) {
  std::vector<const SeenPerson*> people;
  for (const auto& frame : frames)
    for (const SeenPerson& person : frame)
      if (seen_joints(person).size() >= kLeastJoints) people.push_back(&person);
  if (people.size() <= kMostJudged) return people;
  std::vector<const SeenPerson*> some;
  for (std::size_t i = 0; i < kMostJudged; ++i)
    some.push_back(people[i * people.size() / kMostJudged]);
  return some;
}

}  // namespace mcdbn
