#include "formats/likely_image.hpp"

#include <algorithm>
#include <array>

#include "formats/image_shares.hpp"
#include "formats/standing_likeness.hpp"

namespace mcdbn {
namespace {

/// Measured on 104 clips, each from six random sides in an image of either shape: with these joints
/// 97 % are told; with all 33 of MediaPipe 94 %, with all of BODY_25 89 %.
constexpr std::array kCompared{
    JointRole::head,        JointRole::left_shoulder, JointRole::right_shoulder,
    JointRole::left_elbow,  JointRole::right_elbow,   JointRole::left_wrist,
    JointRole::right_wrist, JointRole::left_hip,      JointRole::right_hip,
    JointRole::left_knee,   JointRole::right_knee,    JointRole::left_ankle,
    JointRole::right_ankle};

/// The first column of each of those roles, which in a detector's order is no heel.
std::vector<std::size_t> compared_joints(const std::vector<Keypoint>& keypoints) {
  std::vector<std::size_t> joints;
  for (const JointRole role : kCompared) {
    const auto found = std::ranges::find(keypoints, role, &Keypoint::role);
    if (found != keypoints.end())
      joints.push_back(static_cast<std::size_t>(found - keypoints.begin()));
  }
  return joints;
}

}  // namespace

std::optional<ImageSize> likely_image(const std::vector<Keypoint>& keypoints,
                                      const std::vector<std::vector<SeenPerson>>& frames) {
  const std::vector<std::size_t> compared = compared_joints(keypoints);
  if (compared.size() < kLeastJoints) return {};
  const StandingLikeness likeness(keypoints);
  double upright = 0, lying = 0;
  for (const SeenPerson* person : people_to_judge(frames)) {
    std::vector<std::size_t> joints = compared;
    std::erase_if(joints, [&](std::size_t joint) { return !(person->confidence[joint] > 0); });
    if (joints.size() < kLeastJoints) continue;
    const auto in_image = [&](const ImageSize& image) {
      std::vector<SeenPerson> placed{*person};
      shares_to_px(placed, image);
      return pairs_of(joints.size()) * likeness.of(placed.front(), joints);
    };
    upright += in_image(kUprightImage);
    lying += in_image(kLyingImage);
  }
  if (upright == lying) return {};
  return upright > lying ? kUprightImage : kLyingImage;
}

}  // namespace mcdbn
