#include "camera/track_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"

namespace mcdbn {
namespace {

void hide(Track2d& track, Eigen::Index frame, Eigen::Index joint) {
  track.x_px(frame, joint) = track.y_px(frame, joint) = std::numeric_limits<double>::quiet_NaN();
  track.confidence(frame, joint) = 0;
}

/// What hangs below each joint: its children, and the length of the longest chain of bones.
struct Branches {
  std::vector<std::vector<int>> children;
  std::vector<double> reach;

  explicit Branches(const Skeleton& skeleton)
      : children(skeleton.joints.size()), reach(skeleton.joints.size(), 0) {
    for (int j = skeleton.joint_count() - 1; j > 0; --j) {
      const int parent = skeleton.joints[j].parent;
      children[parent].insert(children[parent].begin(), j);
      reach[parent] = std::max(reach[parent], reach[j] + skeleton.joints[j].offset.norm());
    }
  }
};

/// The joint that the arms hang from, or -1.
int chest_of(const Branches& branches) {
  int first = -1, chest = -1;
  for (int j = 0; j < static_cast<int>(branches.children.size()); ++j) {
    if (branches.children[j].size() < 2) continue;
    if (first < 0) {
      first = j;
    } else if (chest < 0 || branches.reach[j] > branches.reach[chest]) {
      chest = j;
    }
  }
  return chest < 0 ? first : chest;
}

void add_with_all_below(const Branches& branches, int joint, std::vector<int>& joints) {
  joints.push_back(joint);
  for (const int child : branches.children[joint]) add_with_all_below(branches, child, joints);
}

/// The skeleton's joint that each column of the track shows: by its role where the columns are a
/// detector's keypoints, else by its name. -1: none.
std::vector<int> joints_of_columns(const Track2d& track, const Skeleton& skeleton) {
  std::vector<int> joints;
  if (track.keypoints.empty()) {
    for (const std::string& name : track.joint_names) joints.push_back(skeleton.find(name));
    return joints;
  }
  const SkeletonRoles roles = skeleton_roles(skeleton);
  for (const Keypoint& keypoint : track.keypoints)
    joints.push_back(keypoint.role ? roles.joint(*keypoint.role) : -1);
  return joints;
}

/// The columns that show the joint or one below it. @param shown as joints_of_columns gives them
std::vector<int> columns_from(const std::vector<int>& shown, const Branches& branches, int joint) {
  std::vector<int> joints, columns;
  add_with_all_below(branches, joint, joints);
  for (const int below : joints)
    for (std::size_t column = 0; column < shown.size(); ++column)
      if (shown[column] == below) columns.push_back(static_cast<int>(column));
  return columns;
}

}  // namespace

void add_pixel_noise(Track2d& track, double deviation_px, std::uint64_t seed) {
  check_range("the pixel noise's deviation", TrackDamage::kNoise_px, deviation_px);
  if (deviation_px == 0) return;
  RandomSequence random(seed, random_streams::kPixelNoise);
  for (MatrixD* coordinate_px : {&track.x_px, &track.y_px})
    for (double& value : coordinate_px->reshaped()) value += deviation_px * random.normal();
}

void drop_joints(Track2d& track, double share, std::uint64_t seed) {
  check_range("the share of missing joints", TrackDamage::kMissingShare, share);
  if (share == 0) return;
  RandomSequence random(seed, random_streams::kMissingJoints);
  for (Eigen::Index frame = 0; frame < track.frames(); ++frame) {
    for (Eigen::Index joint = 0; joint < track.joint_count(); ++joint) {
      if (random.chance(share)) hide(track, frame, joint);
    }
  }
}

std::vector<std::string> hide_arm(Track2d& track, const Skeleton& skeleton, double seconds,
                                  std::uint64_t seed) {
  check_range("the seconds that an arm is hidden", TrackDamage::kHidden_s, seconds);
  const Branches branches(skeleton);
  const int chest = chest_of(branches);
  if (seconds == 0 || chest < 0) return {};
  std::vector<int> limbs = branches.children[chest];
  std::stable_sort(limbs.begin(), limbs.end(),
                   [&](int a, int b) { return branches.reach[a] > branches.reach[b]; });
  const int shoulder = limbs[RandomSequence(seed, random_streams::kHiddenArm).below(2)];
  const auto frames = std::min<Eigen::Index>(track.frames(), std::lround(seconds * track.fps));
  const Eigen::Index first = (track.frames() - frames) / 2;
  const std::vector<int> shown = joints_of_columns(track, skeleton);
  std::vector<std::string> names;
  for (const int child : branches.children[shoulder])
    for (const int column : columns_from(shown, branches, child)) {
      names.push_back(track.joint_names[static_cast<std::size_t>(column)]);
      for (Eigen::Index frame = first; frame < first + frames; ++frame) hide(track, frame, column);
    }
  return names;
}

void hide_limbs(Track2d& track, const Skeleton& skeleton, std::uint64_t seed) {
  constexpr double kEvery_s = 2.0, kShortest_s = 0.3, kLongest_s = 1.5;
  const Branches branches(skeleton);
  const std::vector<int> shown = joints_of_columns(track, skeleton);
  std::vector<std::vector<int>> limbs;  // as columns of the track
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    std::vector<int> columns = columns_from(shown, branches, joint);
    if (!columns.empty() && 3 * static_cast<int>(columns.size()) <= track.joint_count())
      limbs.push_back(std::move(columns));
  }
  if (limbs.empty()) return;
  RandomSequence random(seed, random_streams::kHiddenLimbs);
  const double duration_s = track.frames() / track.fps;
  const auto times = static_cast<int>(std::lround(std::max(1.0, duration_s / kEvery_s)));
  for (int i = 0; i < times; ++i) {
    const std::vector<int>& limb = limbs[random.below(limbs.size())];
    const double from_s = random.uniform(-kShortest_s, duration_s);
    const double to_s = from_s + random.uniform(kShortest_s, kLongest_s);
    const auto last = std::min<Eigen::Index>(track.frames(), std::lround(to_s * track.fps));
    for (auto frame = std::max<Eigen::Index>(0, std::lround(from_s * track.fps)); frame < last;
         ++frame)
      for (const int column : limb) hide(track, frame, column);
  }
}

void damage_track(Track2d& track, const Skeleton& skeleton, const TrackDamage& damage,
                  std::uint64_t seed) {
  // A seed that nothing else uses: later work on the track must not draw the same numbers.
  const std::uint64_t own = mixed_seed({seed, 0x74726163});
  add_pixel_noise(track, damage.noise_px, own);
  drop_joints(track, damage.missing_share, own);
  if (hide_arm(track, skeleton, damage.hidden_s, own).empty() && damage.hidden_s > 0)
    throw InputError("the track shows no arm that could be hidden (`track.hide`)");
}

}  // namespace mcdbn
