#include "formats/likely_joint_set.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "camera/keypoint_places.hpp"
#include "mcdbn/base/matrices.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/motion/humanoid.hpp"

namespace mcdbn {
namespace {

/// By how much the cosine of another set has to be greater. Measured on 91 clips of people who
/// walk, run, bow, wave and jump, with a detector's noise, each from two random sides, whole and in
/// 15 kinds of part: of people of the usual set the other was greater by at most 0.054 (shoulders
/// and arms alone), of whole people of the other set by at least 0.097.
constexpr double kClearly = 0.06;
constexpr std::size_t kLeastJoints = 3;
/// People of all frames who are looked at, evenly over the film.
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

/// Distances between a set's joints in each of those poses. [joints x joints]
std::vector<MatrixD> standing_distances(const JointSet& set) {
  const MatrixD places = keypoint_places(standing_poses(), humanoid_roles(), set.keypoints);
  const auto joints = std::ssize(set.keypoints);
  std::vector<MatrixD> poses;
  for (Eigen::Index pose = 0; pose < places.rows(); ++pose) {
    MatrixD distances(joints, joints);
    for (Eigen::Index i = 0; i < joints; ++i)
      for (Eigen::Index k = 0; k < joints; ++k)
        distances(i, k) =
            (places.row(pose).segment<3>(3 * i) - places.row(pose).segment<3>(3 * k)).norm();
    poses.push_back(std::move(distances));
  }
  return poses;
}

/// The largest cosine over the poses, of the pairs of these joints.
double likeness(const SeenPerson& person, std::span<const std::size_t> joints,
                const std::vector<MatrixD>& poses) {
  double best = 0;
  for (const MatrixD& standing : poses) {
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

}  // namespace

void name_likeliest_set(SeenPeople& people, const std::vector<std::vector<SeenPerson>>& frames) {
  if (people.possible_sets.size() < 2) return;
  std::vector<std::vector<MatrixD>> standing;
  for (const std::string& set : people.possible_sets)
    standing.push_back(standing_distances(joint_set(set)));
  // Each person counts as much as there are pairs of joints.
  std::vector<double> sums(standing.size());
  double pairs = 0;
  for (const SeenPerson* person : people_to_judge(frames)) {
    const std::vector<std::size_t> joints = seen_joints(*person);
    const double weight = 0.5 * static_cast<double>(joints.size() * (joints.size() - 1));
    pairs += weight;
    for (std::size_t set = 0; set < standing.size(); ++set)
      sums[set] += weight * likeness(*person, joints, standing[set]);
  }
  const auto best = std::ranges::max_element(sums) - sums.begin();
  if (!(sums[static_cast<std::size_t>(best)] - sums.front() > kClearly * pairs)) return;
  SeenPeople named = people_of_set(people.possible_sets[static_cast<std::size_t>(best)]);
  people.joint_names = std::move(named.joint_names);
  people.keypoints = std::move(named.keypoints);
}

}  // namespace mcdbn
