#include <cmath>
#include <numbers>

#include "base/numbers.hpp"
#include "synthesis/synthesize_actions.hpp"
#include "synthesis/synthesize_curves.hpp"

namespace mcdbn::synthesis {
namespace {

// Normative sagittal angles of level walking at a free cadence (after Winter), in per cent of the
// cycle from heel contact to heel contact of the same foot; the thigh's is against the vertical.
// Flexion and dorsiflexion are positive.
const std::vector<KeyCurve::Key> kThighFlexion{
    {0, 23},   {5, 22},  {10, 19}, {20, 10}, {30, 0},  {40, -9}, {50, -15.5}, {53, -16},
    {60, -10}, {65, -2}, {70, 7},  {75, 15}, {80, 21}, {87, 25}, {94, 24}};
const std::vector<KeyCurve::Key> kKneeFlexion{
    {0, 5},   {5, 11},  {10, 17}, {14, 19}, {20, 17}, {30, 10}, {38, 6},  {45, 8}, {50, 14},
    {55, 25}, {60, 40}, {65, 54}, {71, 62}, {76, 58}, {82, 43}, {88, 24}, {94, 8}, {97, 4}};
const std::vector<KeyCurve::Key> kAnkleFlexion{
    {0, 0},   {3, -3},   {7, -5},   {12, -1},  {20, 4},  {30, 7}, {40, 9.5}, {45, 9.5}, {50, 5},
    {55, -5}, {60, -16}, {63, -19}, {67, -16}, {75, -4}, {82, 0}, {90, 2},   {95, 1.5}};
// Pelvis against the direction of walking, by the left foot's cycle.
const std::vector<KeyCurve::Key> kPelvisTurnRight{{0, 5},   {15, 3.5},  {30, 0},
                                                  {50, -5}, {65, -3.5}, {80, 0}};
const std::vector<KeyCurve::Key> kPelvisDropRight{{0, 0},  {12, 4},  {30, 1.5},
                                                  {50, 0}, {62, -4}, {80, -1.5}};

constexpr double kToeOff = 0.58;         ///< of the cycle; the foot stands from 0 to here
constexpr double kMidStance = 0.25;      ///< the foot is flat, its print is taken
constexpr double kDoubleSupport = 0.09;  ///< of the cycle

/// One leg in the sagittal plane, relative to its hip; angles in degrees, cm.
struct LegPose {
  double forward, up;  ///< of the ankle
  double pitch_deg;    ///< of the foot, toes up
};

/// The gait of one clip as functions of the left foot's phase in cycles.
class Gait {
 public:
  Gait(ClipSetup& setup, double last_phase);

  Frame frame(double phase) const;

 private:
  static constexpr int kStepsPerCycle = 256;
  static constexpr double kFirstPhase = -2;

  /// State of the travelling body: where the path is, and how high the hips are above the ground.
  struct Travel {
    Eigen::Vector3d position{0, 0, 0};
    double heading_deg = 0;
    double hips_height = 0;
  };

  double foot_phase(Side side, double phase) const { return side == kLeft ? phase : phase + 0.5; }
  double stride_scale(double phase) const { return stride_ * (1 + stride_noise_(phase)); }
  LegPose leg(Side side, double phase) const;
  double pelvis_turn_deg(double phase) const;
  double hip_lead(Side side, double phase) const;
  Travel travel(double phase) const;
  void integrate_travel(double last_phase);
  FootPrint print(Side side, double cycle) const;
  Eigen::Vector3d free_ankle(Side side, double phase) const;
  Foot foot(Side side, double phase) const;
  Foot swinging_foot(Side side, double phase, double cycle) const;
  Posture posture(double phase) const;

  Body body_;
  Style style_;
  CyclicCurve thigh_{kThighFlexion}, knee_{kKneeFlexion}, ankle_{kAnkleFlexion};
  CyclicCurve pelvis_turn_{kPelvisTurnRight}, pelvis_drop_{kPelvisDropRight};
  SlowNoise stride_noise_, turn_noise_;
  double stride_, turn_deg_per_cm_, step_half_width_, arm_asymmetry_;
  std::vector<Travel> travel_;
};

Gait::Gait(ClipSetup& setup, double last_phase)
    : body_(setup.body),
      style_(setup.style),
      stride_noise_(setup.random, 0.02, 0.25),
      turn_noise_(setup.random, 0.015, 0.15),
      stride_(0.97 * setup.style.amplitude * setup.random.normal(1, 0.04)),
      turn_deg_per_cm_(setup.random.normal(0, 0.02)),
      step_half_width_(setup.body.hip_half_width * setup.random.uniform(0.45, 0.7)),
      arm_asymmetry_(setup.random.normal(0, 0.12)) {
  integrate_travel(last_phase);
}

LegPose Gait::leg(Side side, double phase) const {
  const double cycle = foot_phase(side, phase);
  const double scale = stride_scale(phase);
  const double thigh = scale * thigh_(cycle), knee = scale * knee_(cycle), ankle = ankle_(cycle);
  const double shank = thigh - knee;
  double pitch = shank + ankle;
  const double in_cycle = cycle - std::floor(cycle);
  if (in_cycle < kToeOff) {
    // Standing, the foot rolls over the heel, lies flat, and rolls over the ball.
    const double heel = 1 - smooth_step(0.02, 0.10, in_cycle);
    const double ball = smooth_step(0.34, 0.48, in_cycle);
    pitch = in_cycle < kMidStance ? heel * std::max(0.0, pitch) : ball * std::min(0.0, pitch);
  }
  const double thigh_rad = thigh * kRadiansPerDegree, shank_rad = shank * kRadiansPerDegree;
  return {body_.thigh * std::sin(thigh_rad) + body_.shank * std::sin(shank_rad),
          -body_.thigh * std::cos(thigh_rad) - body_.shank * std::cos(shank_rad), pitch};
}

double Gait::pelvis_turn_deg(double phase) const {
  return -style_.amplitude * pelvis_turn_(phase);
}

double Gait::hip_lead(Side side, double phase) const {
  return (rotation_y(pelvis_turn_deg(phase)) * body_.hip_offset(side)).z();
}

Gait::Travel Gait::travel(double phase) const {
  const double at = (phase - kFirstPhase) * kStepsPerCycle;
  const auto i = static_cast<std::size_t>(at);
  const double u = at - static_cast<double>(i);
  const Travel &from = travel_.at(i), &to = travel_.at(i + 1);
  return {(1 - u) * from.position + u * to.position, std::lerp(from.heading_deg, to.heading_deg, u),
          std::lerp(from.hips_height, to.hips_height, u)};
}

/// Forward kinematics of the standing leg, backwards: what it leaves behind the body is travel,
/// what it is long is height. In double support the weight passes from one leg to the other.
void Gait::integrate_travel(double last_phase) {
  const int steps = static_cast<int>(std::ceil((last_phase - kFirstPhase) * kStepsPerCycle)) + 2;
  std::array<double, 2> behind{};
  Travel now;
  for (int i = 0; i < steps; ++i) {
    const double phase = kFirstPhase + static_cast<double>(i) / kStepsPerCycle;
    const double in_cycle = phase - std::floor(phase);
    const double left_weight =
        smooth_step(0, kDoubleSupport, in_cycle) - smooth_step(0.5, 0.5 + kDoubleSupport, in_cycle);
    double step = 0;
    now.hips_height = 0;
    for (const Side side : kSides) {
      const double weight = side == kLeft ? left_weight : 1 - left_weight;
      const LegPose pose = leg(side, phase);
      const Eigen::Vector3d rolled = planted_foot(body_, {}, pose.pitch_deg).ankle;
      const double print_forward = hip_lead(side, phase) + pose.forward - rolled.z();
      if (i > 0) step += weight * (behind[side] - print_forward);
      behind[side] = print_forward;
      now.hips_height += weight * (body_.ankle_height + rolled.y() - pose.up);
    }
    now.heading_deg += step * (turn_deg_per_cm_ + turn_noise_(phase));
    now.position += rotation_y(now.heading_deg) * Eigen::Vector3d(0, 0, step);
    travel_.push_back(now);
  }
}

FootPrint Gait::print(Side side, double cycle) const {
  const double phase = cycle + kMidStance - (side == kLeft ? 0 : 0.5);
  const Travel at = travel(phase);
  const double forward = hip_lead(side, phase) + leg(side, phase).forward;
  const Eigen::Vector3d offset(sign_of(side) * step_half_width_, body_.ankle_height, forward);
  return {at.position + rotation_y(at.heading_deg) * offset,
          at.heading_deg + sign_of(side) * style_.toe_out_deg};
}

/// The ankle as the curves alone have it, with nothing to hold it to the ground.
Eigen::Vector3d Gait::free_ankle(Side side, double phase) const {
  const Travel at = travel(phase);
  const LegPose pose = leg(side, phase);
  const Eigen::Vector3d offset(sign_of(side) * step_half_width_, at.hips_height + pose.up,
                               hip_lead(side, phase) + pose.forward);
  return at.position + rotation_y(at.heading_deg) * offset;
}

Foot Gait::swinging_foot(Side side, double phase, double cycle) const {
  const FootPrint before = print(side, cycle), after = print(side, cycle + 1);
  const double start = phase - (foot_phase(side, phase) - cycle - kToeOff);
  const double duration = 1 - kToeOff;
  // What the ground demands beyond the curves at both ends of the swing fades towards its middle.
  // Half of its slope is kept: the foot leaves and lands softly, yet is not drawn far off the
  // curve.
  const auto demand = [&](const FootPrint& on, double at) -> Eigen::Vector3d {
    return planted_foot(body_, on, leg(side, at).pitch_deg).ankle - free_ankle(side, at);
  };
  constexpr double kStep = 0.004;
  const Eigen::Vector3d leave = demand(before, start - kStep / 2);
  const Eigen::Vector3d leave_slope = 0.5 * (leave - demand(before, start - 1.5 * kStep)) / kStep;
  const double end = start + duration;
  const Eigen::Vector3d land = demand(after, end + kStep / 2);
  const Eigen::Vector3d land_slope = 0.5 * (demand(after, end + 1.5 * kStep) - land) / kStep;
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  const double t = phase - start, u = t / duration, half = duration / 2;

  Foot foot;
  foot.pitch_deg = leg(side, phase).pitch_deg;
  foot.turn_deg = std::lerp(before.turn_deg, after.turn_deg, smooth_step(0, 1, u));
  foot.toe_bend_deg = std::max(0.0, -foot.pitch_deg) * (1 - smooth_step(0.1, 0.65, u));
  foot.ankle =
      free_ankle(side, phase) + (t < half ? hermite(t, half, leave, leave_slope, none, none)
                                          : hermite(t - half, half, none, none, land, land_slope));
  constexpr double kClearance = 1.8;  // of the toes, beyond what the curves give
  foot.ankle.y() += kClearance * std::pow(std::sin(std::numbers::pi * u), 2);
  return foot;
}

Foot Gait::foot(Side side, double phase) const {
  const double at = foot_phase(side, phase);
  const double cycle = std::floor(at);
  if (at - cycle >= kToeOff) return swinging_foot(side, phase, cycle);
  return planted_foot(body_, print(side, cycle), leg(side, phase).pitch_deg);
}

Posture Gait::posture(double phase) const {
  constexpr double kTurn = 2 * std::numbers::pi;
  const double amplitude = style_.amplitude;
  Posture posture = standing_posture(style_);
  posture[kPelvisTurn] = pelvis_turn_deg(phase);
  posture[kPelvisTilt] += 2 + 1.5 * std::cos(2 * kTurn * (phase - 0.05));
  posture[kPelvisLean] = amplitude * pelvis_drop_(phase);
  posture[kTrunkFlex] += 1.5 * std::cos(2 * kTurn * (phase - 0.08));
  posture[kTrunkBend] = -1.3 * posture[kPelvisLean];
  posture[kTrunkTwist] = -2.1 * posture[kPelvisTurn];
  posture[kHeadTurn] = -0.9 * (posture[kPelvisTurn] + posture[kTrunkTwist]);
  posture[kHeadTilt] = -0.8 * (posture[kPelvisLean] + posture[kTrunkBend]);
  for (const Side side : kSides) {
    // Each arm swings with the other leg, most forward just after that heel strikes.
    const double swing = std::cos(kTurn * (foot_phase(side, phase) - 0.53));
    const double range = style_.arm_swing * amplitude * (1 + sign_of(side) * arm_asymmetry_);
    posture[arm_dof(side, kFlexion)] += range * (18 * swing - 3);
    posture[arm_dof(side, kElbow)] +=
        range * (10 + 12 * std::cos(kTurn * (foot_phase(side, phase) - 0.57)));
    posture[arm_dof(side, kShrug)] = 1.5 * swing;
  }
  return posture;
}

Frame Gait::frame(double phase) const {
  const Travel at = travel(phase);
  Frame frame;
  frame.heading_deg = at.heading_deg;
  frame.posture = posture(phase);
  // The body sways over the standing foot, furthest in its mid-stance.
  const double sway = 0.55 * step_half_width_ * std::sin(2 * std::numbers::pi * (phase - 0.05));
  frame.hips = at.position + rotation_y(at.heading_deg) *
                                 Eigen::Vector3d(sway, at.hips_height + body_.hip_drop, 0);
  for (const Side side : kSides) frame.feet[side] = foot(side, phase);
  return frame;
}

}  // namespace

std::vector<Frame> walk(ClipSetup& setup) {
  Random& random = setup.random;
  // Cadence falls with the square root of leg length, as a pendulum's does.
  const double cycle_s =
      1.08 * std::sqrt(setup.body.leg() / 84) / setup.style.tempo * random.normal(1, 0.04);
  const double start = random.uniform(0, 1);
  const SlowNoise tempo(random, 0.02, 0.2);
  const auto phase = [&](double t_s) { return start + t_s / cycle_s + tempo(t_s) - tempo(0); };
  const Gait gait(setup, phase(setup.seconds()) + 2);
  std::vector<Frame> frames;
  frames.reserve(setup.frame_count);
  for (int i = 0; i < setup.frame_count; ++i) frames.push_back(gait.frame(phase(i / setup.fps)));
  return frames;
}

}  // namespace mcdbn::synthesis
