#include "corpus/new_poses.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "base/random_sequence.hpp"
#include "base/random_streams.hpp"
#include "motion/rotation_vector.hpp"

namespace mcdbn {
namespace {

using enum JointRole;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

/// A number that wanders smoothly about 0 with deviation 1: three waves of 0.1 to 0.8 Hz.
class Wandering {
 public:
  explicit Wandering(RandomSequence& random) {
    for (Wave& wave : waves_)
      wave = {2 * kPi * random.uniform(0.1, 0.8), random.uniform(0, 2 * kPi),
              random.normal() * std::sqrt(2.0 / 3.0)};
  }
  double at(double time_s) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += wave.height * std::sin(wave.rate * time_s + wave.phase);
    return sum;
  }

 private:
  struct Wave {
    double rate, phase, height;
  };
  std::array<Wave, 3> waves_;
};

/// Three numbers that wander independently.
struct WanderingVector {
  explicit WanderingVector(RandomSequence& random) : x(random), y(random), z(random) {}
  Vector3d at(double time_s) const { return {x.at(time_s), y.at(time_s), z.at(time_s)}; }
  Wandering x, y, z;
};

/// A direction that goes smoothly from one random place to the next.
class WanderingArm {
 public:
  WanderingArm(RandomSequence& random, double side, double seconds) : side_(side) {
    for (int step = 0; step * kStep_s < seconds + 2 * kStep_s; ++step)
      places_.push_back(drawn(random));
  }

  /// chest_from_upper_arm and the elbow's bend at a time.
  std::pair<Matrix3d, double> at(double time_s) const {
    const auto before = static_cast<std::size_t>(time_s / kStep_s);
    const double part = time_s / kStep_s - static_cast<double>(before),
                 smooth = part * part * (3 - 2 * part);
    const Place &from = places_[before], &to = places_[before + 1];
    return {from.turn.slerp(smooth, to.turn).toRotationMatrix(),
            (1 - smooth) * from.bend + smooth * to.bend};
  }

 private:
  static constexpr double kStep_s = 1.2;
  struct Place {
    Eigen::Quaterniond turn;
    double bend;
  };

  Place drawn(RandomSequence& random) const {
    constexpr double kFarthestBack = -0.5, kFarthestAcross = -0.7;
    Vector3d direction;
    do {
      // One by one: in which order arguments are evaluated is left to the compiler.
      const double z = random.normal(), y = random.normal(), x = random.normal();
      direction = Vector3d(x, y, z).normalized();
    } while (direction.z() < kFarthestBack || side_ * direction.x() < kFarthestAcross);
    constexpr double kTwist = 0.7, kMostBend = 2.4;  // 40 and 140 degrees
    const Vector3d rest = side_ * Vector3d::UnitX();
    const double twist = kTwist * random.uniform(-1, 1);
    const double most_bend = kMostBend * random.uniform();
    return {Eigen::Quaterniond::FromTwoVectors(rest, direction) *
                Eigen::Quaterniond(Eigen::AngleAxisd(twist, rest)),
            most_bend * random.uniform()};
  }

  double side_;
  std::vector<Place> places_;
};

/// The number of a view's draws.
enum Part : std::uint64_t { kExchange = 1, kTurns, kArms, kLean, kRound };

}  // namespace

Matrix3d heading_of(const Matrix3d& world_from_pelvis) {
  const Vector3d ahead = world_from_pelvis.col(2);
  return Eigen::AngleAxisd(std::atan2(ahead.x(), ahead.z()), Vector3d::UnitY()).toRotationMatrix();
}

void exchange_limbs(HumanoidPoses& poses, const PosePool& pool, std::uint64_t seed) {
  RandomSequence random(seed, random_streams::kNewPoses);
  const auto piece = [&] {
    const std::size_t clip = random.below(pool.clips());
    return pool.piece(clip, random.uniform(), poses.frames());
  };
  const HumanoidPoses upper = piece(), third = piece();
  const JointRole arm = random.chance(0.5) ? left_clavicle : right_clavicle;
  for (int t = 0; t < poses.frames(); ++t) {
    const Matrix3d turn =
        heading_of(poses.local(t, pelvis)) * heading_of(upper.local(t, pelvis)).transpose();
    for (const JointRole role : joint_roles())
      if (is_below(role, arm))
        poses.local(t, role) = third.local(t, role);
      else if (is_below(role, chest))
        poses.local(t, role) = upper.local(t, role);
    poses.set_world(t, spine, turn * upper.world(t, spine));
    poses.local(t, chest) = upper.local(t, chest);
  }
}

void turn_limbs(HumanoidPoses& poses, const PosePool& pool, double deviation_deg,
                std::uint64_t seed) {
  RandomSequence random(seed, random_streams::kNewPoses);
  const double step_s = poses.frame_time_s();
  for (const JointRole role : joint_roles()) {
    const WanderingVector wandering(random);
    if (role == pelvis) continue;
    // The turns of a trunk's joints add up.
    const double deviation = deviation_deg * kRadiansPerDegree * (role <= head ? 0.5 : 1.0);
    for (int t = 0; t < poses.frames(); ++t) {
      const Matrix3d was = poses.local(t, role);
      poses.local(t, role) =
          pool.limits(role).clamped(was * rotation_of(deviation * wandering.at(t * step_s)), was);
    }
  }
}

void put_arms_anywhere(HumanoidPoses& poses, std::uint64_t seed) {
  RandomSequence random(seed, random_streams::kNewPoses);
  const double step_s = poses.frame_time_s();
  for (const bool right : {false, true}) {
    const double side = right ? -1 : 1;
    const WanderingArm arm(random, side, poses.frames() * step_s);
    const auto role = [&](JointRole left) { return right ? other_side(left) : left; };
    for (int t = 0; t < poses.frames(); ++t) {
      const auto [turn, bend] = arm.at(t * step_s);
      poses.set_world(t, role(left_shoulder), poses.world(t, chest) * turn);
      poses.local(t, role(left_elbow)) =
          Eigen::AngleAxisd(-side * bend, Vector3d::UnitY()).toRotationMatrix();
    }
  }
}

void lean(HumanoidPoses& poses, double deviation_deg, std::uint64_t seed) {
  RandomSequence random(seed, random_streams::kNewPoses);
  const Wandering x(random), z(random);
  const double deviation = deviation_deg * kRadiansPerDegree;
  for (int t = 0; t < poses.frames(); ++t) {
    const Matrix3d left = poses.world(t, left_hip), right = poses.world(t, right_hip);
    const double time_s = t * poses.frame_time_s();
    poses.local(t, pelvis) =
        rotation_of(deviation * Vector3d(x.at(time_s), 0, z.at(time_s))) * poses.local(t, pelvis);
    poses.set_world(t, left_hip, left);
    poses.set_world(t, right_hip, right);
  }
}

void turn_round(HumanoidPoses& poses, std::uint64_t seed) {
  RandomSequence random(seed, random_streams::kNewPoses);
  const Wandering heading(random);
  const double most = kPi * random.uniform();
  Vector3d was = poses.root.row(0).transpose(), is = was;
  for (int t = 0; t < poses.frames(); ++t) {
    const Matrix3d turn =
        Eigen::AngleAxisd(most * heading.at(t * poses.frame_time_s()), Vector3d::UnitY())
            .toRotationMatrix();
    const Vector3d now = poses.root.row(t).transpose();
    is += turn * (now - was);
    was = now;
    poses.root.row(t) = is.transpose();
    poses.local(t, pelvis) = turn * poses.local(t, pelvis);
  }
}

Motion with_new_poses(const Motion& motion, const AugmentationSettings& settings,
                      const PosePool& pool, const RandomKey& key) {
  HumanoidPoses poses(motion);
  const Eigen::VectorXd stood = poses.lowest_foot();
  bool changed = false;
  const auto in_share = [&](Part part, double share, const auto& change) {
    const std::uint64_t seed = mixed_seed({key.seed, key.step, key.stream, part});
    if (!(RandomSequence(seed).uniform() < share)) return;
    changed = true;
    change(seed);
  };
  in_share(kExchange, settings.limbs_exchanged,
           [&](std::uint64_t seed) { exchange_limbs(poses, pool, seed); });
  in_share(kTurns, settings.limbs_turned,
           [&](std::uint64_t seed) { turn_limbs(poses, pool, settings.limbs_turned_deg, seed); });
  in_share(kArms, settings.arms_anywhere,
           [&](std::uint64_t seed) { put_arms_anywhere(poses, seed); });
  in_share(kLean, settings.leaning,
           [&](std::uint64_t seed) { lean(poses, settings.leaning_deg, seed); });
  in_share(kRound, settings.turning_round, [&](std::uint64_t seed) { turn_round(poses, seed); });
  if (!changed) return motion;
  poses.root.col(1) += stood - poses.lowest_foot();
  return poses.motion();
}

}  // namespace mcdbn
