#include "independent_scores.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>

namespace mcdbn::test {
namespace {

using Points = std::vector<Eigen::Matrix3Xd>;  ///< of each frame

Eigen::Vector3d unit_axis(Channel channel) {
  return Eigen::Vector3d::Unit(static_cast<int>(channel) % 3);
}

/// Where all joints are, in file units, and how they are turned in the world.
struct Poses {
  Points places;
  std::vector<std::vector<Eigen::Matrix3d>> turns;  ///< of each frame and joint
};

Poses poses_of(const Motion& motion) {
  Poses poses;
  const auto& joints = motion.skeleton.joints;
  for (int t = 0; t < motion.frames(); ++t) {
    Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(joints.size()));
    std::vector<Eigen::Matrix3d> turns;
    Eigen::Index column = 0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      Eigen::Vector3d offset = joints[j].offset;
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      for (const Channel channel : joints[j].channels) {
        const double value = motion.channels(t, column++);
        if (static_cast<int>(channel) < 3)
          offset[static_cast<int>(channel)] = value;
        else
          turn *= Eigen::AngleAxisd(value * std::acos(-1.0) / 180, unit_axis(channel))
                      .toRotationMatrix();
      }
      const int parent = joints[j].parent;
      const auto at = static_cast<Eigen::Index>(j);
      if (parent < 0) {
        places.col(at) = offset;
        turns.push_back(turn);
      } else {
        const Eigen::Matrix3d& above = turns[static_cast<std::size_t>(parent)];
        places.col(at) = places.col(parent) + above * offset;
        turns.emplace_back(above * turn);
      }
    }
    poses.places.push_back(places);
    poses.turns.push_back(turns);
  }
  return poses;
}

/// Rotations by an angle are √8·sin of half of it apart. All joints have channels here.
double mean_angle_deg(const Poses& a, const Poses& b) {
  double sum = 0;
  for (std::size_t t = 0; t < a.turns.size(); ++t)
    for (std::size_t j = 0; j < a.turns[t].size(); ++j)
      sum += 2 * std::asin(std::min(1.0, (a.turns[t][j] - b.turns[t][j]).norm() / std::sqrt(8.0)));
  return sum / static_cast<double>(a.turns.size() * a.turns[0].size()) * 180 / std::acos(-1.0);
}

/// A leg, thigh and shank, is 0.491 of the height; a body is 1.7 m tall. The root's own offset and
/// what hangs from it directly are no leg's bones.
double mm_per_unit(const Skeleton& skeleton) {
  double leg = 0;
  for (const Joint& joint : skeleton.joints)
    if (joint.parent > 0)
      leg =
          std::max(leg, joint.offset.norm() +
                            skeleton.joints[static_cast<std::size_t>(joint.parent)].offset.norm());
  return 1700 * 0.491 / leg;
}

/// Joints that do not stand where their parent stands; without the root.
std::vector<Eigen::Index> judged_joints(const Skeleton& skeleton) {
  std::vector<Eigen::Index> judged;
  for (std::size_t j = 1; j < skeleton.joints.size(); ++j)
    if (skeleton.joints[j].offset.norm() > 1e-9) judged.push_back(static_cast<Eigen::Index>(j));
  return judged;
}

/// [3 x joints] a frame, relative to the root.
Points relative(const Points& places, const std::vector<Eigen::Index>& joints, double scale) {
  Points result;
  for (const Eigen::Matrix3Xd& frame : places) {
    Eigen::Matrix3Xd chosen(3, static_cast<Eigen::Index>(joints.size()));
    for (std::size_t i = 0; i < joints.size(); ++i)
      chosen.col(static_cast<Eigen::Index>(i)) = scale * (frame.col(joints[i]) - frame.col(0));
    result.push_back(chosen);
  }
  return result;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mean_x = 0, mean_y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) mean_x += x[i] / n, mean_y += y[i] / n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  return xy / std::sqrt(xx * yy);
}

std::vector<double> series(const Points& frames, Eigen::Index joint, int axis,
                           const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  std::vector<double> values;
  for (const Eigen::Matrix3Xd& frame : frames) values.push_back((turn * frame.col(joint))[axis]);
  return values;
}

double flat_correlation(const Points& a, const Points& b) {
  std::vector<double> x, y;
  for (Eigen::Index joint = 0; joint < a[0].cols(); ++joint)
    for (int axis = 0; axis < 3; ++axis) {
      for (const double value : series(a, joint, axis)) x.push_back(value);
      for (const double value : series(b, joint, axis)) y.push_back(value);
    }
  return correlation(x, y);
}

/// Every channel of these clips moves.
double channel_correlation(const Points& a, const Points& b, const Eigen::Matrix3d& turn) {
  double sum = 0;
  for (Eigen::Index joint = 0; joint < a[0].cols(); ++joint)
    for (int axis = 0; axis < 3; ++axis)
      sum += correlation(series(a, joint, axis, turn), series(b, joint, axis, turn));
  return sum / static_cast<double>(3 * a[0].cols());
}

/// Mean length of the difference after `order` differences over time, per second each.
double mean_difference(const Points& a, const Points& b, int order, double fps) {
  std::vector<Eigen::Matrix3Xd> change;
  for (std::size_t t = 0; t < a.size(); ++t) change.push_back(b[t] - a[t]);
  for (int i = 0; i < order; ++i) {
    for (std::size_t t = 0; t + 1 < change.size(); ++t)
      change[t] = (change[t + 1] - change[t]) * fps;
    change.pop_back();
  }
  double sum = 0;
  for (const Eigen::Matrix3Xd& frame : change) sum += frame.colwise().norm().mean();
  return sum / static_cast<double>(change.size());
}

/// The rotation nearest to `s`, source times target (Horn 1987).
Eigen::Matrix3d turn_by_horn(const Eigen::Matrix3d& s) {
  Eigen::Matrix4d n;
  n << s.trace(), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),  //
      s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),
      s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1),
      s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1);
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(n).eigenvectors().col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

/// Mean joint distance of a frame after the best similarity (Horn 1987), the root among the points.
double aligned_distance(const Eigen::Matrix3Xd& truth, const Eigen::Matrix3Xd& other) {
  Eigen::Matrix3Xd target(3, truth.cols() + 1), source(3, truth.cols() + 1);
  target << Eigen::Vector3d::Zero(), truth;
  source << Eigen::Vector3d::Zero(), other;
  const Eigen::Vector3d target_centre = target.rowwise().mean(),
                        source_centre = source.rowwise().mean();
  target.colwise() -= target_centre;
  source.colwise() -= source_centre;
  const Eigen::Matrix3d s = source * target.transpose();
  const Eigen::Matrix3d turn = turn_by_horn(s);
  const double scale = (turn * s).trace() / source.squaredNorm();
  return (scale * turn * source - target).rightCols(truth.cols()).colwise().norm().mean();
}

/// The 12 joints of limbs relative to the middle of the hips, by CMU's names. @return [3 x 12] each
Points limbs_of(const Points& places, const Skeleton& skeleton, double mm) {
  Points limbs;
  for (const Eigen::Matrix3Xd& frame : places) {
    const auto at = [&](const std::string& name) -> Eigen::Vector3d {
      return mm * frame.col(skeleton.find(name));
    };
    const Eigen::Vector3d hips = (at("LeftUpLeg") + at("RightUpLeg")) / 2;
    Eigen::Matrix3Xd points(3, 12);
    Eigen::Index column = 0;
    for (const char* joint : {"Arm", "ForeArm", "Hand", "UpLeg", "Leg", "Foot"})
      for (const char* side : {"Left", "Right"})
        points.col(column++) = at(std::string(side) + joint) - hips;
    limbs.push_back(points);
  }
  return limbs;
}

/// Of all frames in a row, the root not moved: Horn's quaternion once more.
Eigen::Matrix3d best_turn(const Points& targets, const Points& sources) {
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  for (std::size_t t = 0; t < targets.size(); ++t) s += sources[t] * targets[t].transpose();
  return turn_by_horn(s);
}

/// After the best similarity of each frame.
double aligned_limbs(const Eigen::Matrix3Xd& truth, const Eigen::Matrix3Xd& other) {
  Eigen::Matrix3Xd target = truth.colwise() - truth.rowwise().mean(),
                   source = other.colwise() - other.rowwise().mean();
  const Eigen::Matrix3d s = source * target.transpose(), turn = turn_by_horn(s);
  const double scale = (turn * s).trace() / source.squaredNorm();
  return (scale * turn * source - target).colwise().norm().mean();
}

bool is_foot(std::string name) {
  for (char& letter : name) letter = static_cast<char>(std::tolower(letter));
  return name.find("foot") != std::string::npos || name.find("toe") != std::string::npos ||
         name.find("ankle") != std::string::npos;
}

/// Horizontal speed of `moving` where `truth`'s feet stand.
double foot_slide(const Points& truth, const Points& moving, const Motion& motion, double mm) {
  double sum = 0;
  int planted = 0;
  for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
    if (!is_foot(motion.skeleton.joints[j].name)) continue;
    const auto at = static_cast<Eigen::Index>(j);
    double ground = 1e300;
    for (const Eigen::Matrix3Xd& frame : truth) ground = std::min(ground, mm * frame(1, at));
    for (std::size_t t = 0; t + 1 < truth.size(); ++t) {
      const double height = mm * std::max(truth[t](1, at), truth[t + 1](1, at)) - ground;
      const double speed =
          mm * (truth[t + 1].col(at) - truth[t].col(at)).norm() / motion.frame_time_s;
      if (height > 40 || speed > 400) continue;
      const Eigen::Vector3d step = moving[t + 1].col(at) - moving[t].col(at);
      sum += mm * std::hypot(step.x(), step.z()) / motion.frame_time_s;
      ++planted;
    }
  }
  return sum / planted;
}

double bone_spread(const Points& places, const Skeleton& skeleton, double mm) {
  double sum = 0;
  int bones = 0;
  for (std::size_t j = 1; j < skeleton.joints.size(); ++j, ++bones) {
    double mean = 0, square = 0;
    const auto count = static_cast<double>(places.size());
    for (const Eigen::Matrix3Xd& frame : places)
      mean +=
          mm *
          (frame.col(static_cast<Eigen::Index>(j)) - frame.col(skeleton.joints[j].parent)).norm() /
          count;
    for (const Eigen::Matrix3Xd& frame : places)
      square += std::pow(mm * (frame.col(static_cast<Eigen::Index>(j)) -
                               frame.col(skeleton.joints[j].parent))
                                     .norm() -
                             mean,
                         2) /
                count;
    sum += std::sqrt(square);
  }
  return sum / bones;
}

}  // namespace

std::map<std::string, double> independent_scores(const Motion& truth, const Motion& regenerated,
                                                 const Eigen::Matrix3d& camera_from_world) {
  const double mm = mm_per_unit(truth.skeleton), other_mm = mm_per_unit(regenerated.skeleton);
  const Poses real_poses = poses_of(truth), other_poses = poses_of(regenerated);
  const Points &real = real_poses.places, &other = other_poses.places;
  const auto joints = judged_joints(truth.skeleton);
  const Points a = relative(real, joints, mm), b = relative(other, joints, other_mm);
  std::map<std::string, double> scores;
  scores["pcc_flat"] = flat_correlation(a, b);
  scores["pcc_channel"] = channel_correlation(a, b, camera_from_world);
  scores["mpjpe_mm"] = mean_difference(a, b, 0, 0);
  scores["mpjve_mm_s"] = mean_difference(a, b, 1, 1 / truth.frame_time_s);
  scores["acceleration_error_mm_s2"] = mean_difference(a, b, 2, 1 / truth.frame_time_s);
  double aligned = 0, square = 0, within = 0, root = 0;
  const auto frames = static_cast<double>(a.size());
  for (std::size_t t = 0; t < a.size(); ++t) {
    aligned += aligned_distance(a[t], b[t]) / frames;
    const Eigen::ArrayXd distance = (b[t] - a[t]).colwise().norm().transpose().array();
    square += distance.square().mean() / frames;
    within += (distance <= 150).cast<double>().mean() / frames;
    root += mm * (other[t].col(0) - real[t].col(0)).norm() / frames;
  }
  scores["pa_mpjpe_mm"] = aligned;
  scores["rmse_mm"] = std::sqrt(square);
  scores["pck_150mm"] = within;
  scores["root_mm"] = root;
  scores["mpjae_deg"] = mean_angle_deg(real_poses, other_poses);
  const Points limbs = limbs_of(real, truth.skeleton, mm),
               made = limbs_of(other, regenerated.skeleton, other_mm);
  const Eigen::Matrix3d turn = best_turn(limbs, made);
  double limb = 0, turned = 0, limb_aligned = 0;
  for (std::size_t t = 0; t < limbs.size(); ++t) {
    limb += (made[t] - limbs[t]).colwise().norm().mean() / frames;
    turned += (turn * made[t] - limbs[t]).colwise().norm().mean() / frames;
    limb_aligned += aligned_limbs(limbs[t], made[t]) / frames;
  }
  scores["limb_mpjpe_mm"] = limb;
  scores["limb_turned_mpjpe_mm"] = turned;
  scores["limb_pa_mpjpe_mm"] = limb_aligned;
  scores["foot_slide_of_truth_mm_s"] = foot_slide(real, real, truth, mm);
  scores["foot_slide_mm_s"] = foot_slide(real, other, truth, mm);
  scores["bone_length_spread_mm"] = bone_spread(other, regenerated.skeleton, other_mm);
  return scores;
}

}  // namespace mcdbn::test
