#include "mcdbn/camera/joint_sets.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "camera/body_places.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

Keypoint named_place(const std::string& name, const std::string& place) {
  Keypoint keypoint = body_place(place).value_or(Keypoint{});
  keypoint.name = name;
  return keypoint;
}

/// The detector's names between spaces, each with `=place` where the place has another name.
JointSet set_of(std::string name, const std::string& names) {
  JointSet set{std::move(name), {}};
  std::istringstream words(names);
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    const std::string spelled = word.substr(0, equals);
    set.keypoints.push_back(named_place(
        spelled, equals == std::string::npos ? place_name_of(spelled) : word.substr(equals + 1)));
  }
  return set;
}

const std::string kCoco17 =
    "nose left_eye right_eye left_ear right_ear left_shoulder right_shoulder left_elbow "
    "right_elbow left_wrist right_wrist left_hip right_hip left_knee right_knee left_ankle "
    "right_ankle ";

std::vector<JointSet> all_sets() {
  return {
      set_of("BODY_25",
             "Nose Neck=mid_shoulder RShoulder RElbow RWrist LShoulder LElbow LWrist MidHip RHip "
             "RKnee RAnkle LHip LKnee LAnkle REye LEye REar LEar LBigToe LSmallToe LHeel RBigToe "
             "RSmallToe RHeel"),
      set_of("BODY_25B",
             "Nose LEye REye LEar REar LShoulder RShoulder LElbow RElbow LWrist RWrist LHip RHip "
             "LKnee RKnee LAnkle RAnkle Neck=upper_neck HeadTop LBigToe LSmallToe LHeel RBigToe "
             "RSmallToe RHeel"),
      set_of("COCO_18",
             "Nose Neck=mid_shoulder RShoulder RElbow RWrist LShoulder LElbow LWrist RHip RKnee "
             "RAnkle LHip LKnee LAnkle REye LEye REar LEar"),
      set_of("COCO_17", kCoco17),
      set_of("HALPE_26", kCoco17 + "head=head_top neck hip=mid_hip left_big_toe right_big_toe "
                                   "left_small_toe right_small_toe left_heel right_heel"),
      set_of("COCO_23", kCoco17 +
                            "left_big_toe left_small_toe left_heel right_big_toe right_small_toe "
                            "right_heel"),
      set_of("MEDIAPIPE_33",
             "nose left_eye_inner left_eye left_eye_outer right_eye_inner right_eye "
             "right_eye_outer left_ear right_ear mouth_left mouth_right left_shoulder "
             "right_shoulder left_elbow right_elbow left_wrist right_wrist left_pinky right_pinky "
             "left_index right_index left_thumb right_thumb left_hip right_hip left_knee "
             "right_knee left_ankle right_ankle left_heel right_heel left_foot_index "
             "right_foot_index"),
      set_of("H36M_17",
             "root right_hip right_knee right_foot=right_ankle left_hip left_knee "
             "left_foot=left_ankle spine thorax neck_base=upper_neck head=head_top left_shoulder "
             "left_elbow left_wrist right_shoulder right_elbow right_wrist"),
  };
}

}  // namespace

std::span<const JointSet> joint_sets() {
  static const std::vector<JointSet> sets = all_sets();
  return sets;
}

const JointSet& joint_set(std::string_view name) {
  std::vector<std::string> names;
  for (const JointSet& set : joint_sets()) {
    if (set.name == name) return set;
    names.push_back(set.name);
  }
  throw InputError(
      fmt::format("no joint set is called {}; there are: {}", name, fmt::join(names, ", ")));
}

const JointSet* joint_set_of(std::span<const std::string> names) {
  for (const JointSet& set : joint_sets())
    if (std::ranges::equal(set.keypoints, names, {}, &Keypoint::name)) return &set;
  return nullptr;
}

Keypoint keypoint_of(const std::string& name) {
  return named_place(name, place_name_of(name));
}

std::vector<Keypoint> keypoints_of(std::span<const std::string> names) {
  if (const JointSet* set = joint_set_of(names)) return set->keypoints;
  std::vector<Keypoint> keypoints;
  std::set<JointRole> roles;
  for (const std::string& name : names) {
    keypoints.push_back(keypoint_of(name));
    if (const auto role = keypoints.back().role) roles.insert(*role);
  }
  int pairs = 0;
  for (const JointRole left :
       {JointRole::left_shoulder, JointRole::left_elbow, JointRole::left_wrist, JointRole::left_hip,
        JointRole::left_knee, JointRole::left_ankle})
    pairs += roles.contains(left) && roles.contains(other_side(left)) ? 1 : 0;
  if (pairs < 2) {
    for (Keypoint& keypoint : keypoints) keypoint = Keypoint{keypoint.name, {}, {0, 0, 0}, {}};
    return keypoints;
  }
  for (Keypoint& keypoint : keypoints) {
    const std::string place = place_name_of(keypoint.name);
    if (!place.ends_with("_foot")) continue;
    const JointRole ankle =
        place.starts_with("left") ? JointRole::left_ankle : JointRole::right_ankle;
    if (!roles.contains(ankle)) keypoint.role = ankle;
  }
  return keypoints;
}

}  // namespace mcdbn
