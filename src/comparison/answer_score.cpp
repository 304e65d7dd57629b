#include "comparison/answer_score.hpp"

#include <numeric>

#include "evaluation/bone_length.hpp"
#include "evaluation/foot_slide.hpp"
#include "evaluation/orientation_error.hpp"
#include "mcdbn/evaluation/interval_share.hpp"
#include "mcdbn/evaluation/pearson.hpp"
#include "motion/body_size.hpp"
#include "motion/foot_joints.hpp"

namespace mcdbn {
namespace {

void leave_out_missing(std::vector<std::string>& joints, const Skeleton& answered) {
  std::erase_if(joints, [&](const std::string& joint) { return answered.find(joint) < 0; });
}

std::vector<std::string> judged_joints(const Skeleton& truth, const Skeleton& answered,
                                       const std::string& root_name) {
  std::vector<std::string> names =
      TrackFeatures::for_skeleton(truth, truth.find(root_name)).joint_names();
  leave_out_missing(names, answered);
  return names;
}

std::vector<std::string> judged_feet(const Skeleton& truth, const Skeleton& answered) {
  std::vector<std::string> names;
  for (const int foot : foot_joints(truth))
    names.push_back(truth.joints[static_cast<std::size_t>(foot)].name);
  leave_out_missing(names, answered);
  return names;
}

/// The columns of some joints.
/// @param all [frames x 3·joints] of the skeleton  @return [frames x 3·joints]
MatrixD of_joints(const MatrixD& all, const Skeleton& skeleton,
                  const std::vector<std::string>& joints) {
  MatrixD some(all.rows(), 3 * std::ssize(joints));
  for (std::size_t i = 0; i < joints.size(); ++i)
    some.middleCols(3 * static_cast<Eigen::Index>(i), 3) =
        all.middleCols(3 * skeleton.find(joints[i]), 3);
  return some;
}

/// @param places [frames x 3·joints] from the root  @return [frames x 3 + 3·joints] the root first
MatrixD with_root(const MatrixD& places) {
  MatrixD all = MatrixD::Zero(places.rows(), 3 + places.cols());
  all.rightCols(places.cols()) = places;
  return all;
}

/// @param places [frames x 3·joints]  @return the same along other axes
MatrixD turned(MatrixD places, const Eigen::Matrix3d& axes_from_world) {
  for (Eigen::Index joint = 0; joint < places.cols(); joint += 3)
    places.middleCols(joint, 3) = places.middleCols(joint, 3) * axes_from_world.transpose();
  return places;
}

/// Mean distance of the answer's root from the true one, in mm on a 1.7 m body.
double root_error_mm(const EncodedClip& truth, const Motion& answer, const std::string& root_name) {
  const auto mm = [](const Motion& motion) {
    return 1000.0 / file_units_per_metre(motion.skeleton);
  };
  const MatrixD path = joint_positions(answer).middleCols(3 * answer.skeleton.find(root_name), 3);
  return (mm(answer) * path - mm(truth.motion) * truth.root_position).rowwise().norm().mean();
}

}  // namespace

JudgedPlaces judged_places(const EncodedClip& truth, const Motion& answer,
                           const MatrixD& deviation_mm, const std::string& root_name) {
  const Skeleton &own = truth.motion.skeleton, &answered = answer.skeleton;
  const std::vector<std::string> joints = judged_joints(own, answered, root_name);
  const auto places = [&](const Motion& motion) {
    return of_joints(root_relative_positions_mm(motion, motion.skeleton.find(root_name)),
                     motion.skeleton, joints);
  };
  return {joints, places(truth.motion), places(answer),
          deviation_mm.size() == 0 ? MatrixD() : of_joints(deviation_mm, answered, joints)};
}

ClipScore score_clip(const EncodedClip& truth, const Motion& answer, const std::string& root_name) {
  const Skeleton &own = truth.motion.skeleton, &answered = answer.skeleton;
  const JudgedPlaces judged = judged_places(truth, answer, {}, root_name);
  ClipScore score;
  // Without the root's own columns, which are zero on both sides: they would flatter the figure.
  score.pcc_flat = pearson_flat(judged.truth_mm, judged.answer_mm);
  // Along the camera's axes (docs/concepts.md, PCC): along the world's own a walk straight ahead
  // has channels in which next to nothing moves.
  const Eigen::Matrix3d& axes = truth.camera.camera_from_world;
  score.pcc_channel =
      pearson_per_channel(turned(judged.truth_mm, axes), turned(judged.answer_mm, axes));
  score.error =
      joint_error(with_root(judged.truth_mm), with_root(judged.answer_mm), truth.motion.fps(), 0);
  score.limbs = limb_error(limb_positions_mm(truth.motion), limb_positions_mm(answer));
  score.mpjae_deg = mpjae_deg(truth.motion, answer);
  score.root_mm = root_error_mm(truth, answer, root_name);
  const MatrixD world = world_positions_mm(answer);
  const std::vector<std::string> feet = judged_feet(own, answered);
  std::vector<int> columns(feet.size());
  std::iota(columns.begin(), columns.end(), 0);
  score.foot_slide = foot_slide(of_joints(world_positions_mm(truth.motion), own, feet),
                                of_joints(world, answered, feet), columns, truth.motion.fps());
  score.bone_length_spread_mm = bone_length_spread_mm(world, answered, answered.find(root_name));
  return score;
}

double share_within_90(const EncodedClip& truth, const ScoredAnswer& answer,
                       const std::string& root_name) {
  const JudgedPlaces judged = judged_places(truth, answer.motion, answer.deviation_mm, root_name);
  return share_within_90(judged.truth_mm, judged.answer_mm, judged.deviation_mm);
}

}  // namespace mcdbn
