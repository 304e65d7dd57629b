#include <algorithm>
#include <cmath>
#include <numbers>

#include "synthesis/synthesize_actions.hpp"
#include "synthesis/synthesize_curves.hpp"
#include "synthesis/synthesize_flight.hpp"

namespace mcdbn::synthesis {
namespace {

/// Hops between feet together with arms down and feet apart with arms up. Hop h begins at take-off
/// from stance h and lands in stance h + 1; stance 0 is feet together, odd ones are open.
class JumpingJacks {
 public:
  explicit JumpingJacks(ClipSetup& setup);

  Frame frame(double t_s) const;

 private:
  static constexpr double kTakeOffPitch_deg = -32, kLandingPitch_deg = -24;
  static constexpr double kDip_s = 0.22;  ///< before the first and after the last hop

  static bool is_open(int stance) { return stance % 2 == 1; }
  double half_width(int stance) const;
  FootPrint print(Side side, int stance) const;
  double hips_over_toes(int stance, double pitch_deg) const;
  Flight flight(int hop) const;
  double height_before(double t) const;
  double height_after(double t) const;
  double hips_height(int hop, double t) const;
  double pitch_deg(int hop, double t) const;
  Foot foot(Side side, int hop, double t) const;
  Posture posture(int hop, double t) const;

  Body body_;
  Posture standing_;
  double hop_s_, flight_s_, first_take_off_s_;
  int hops_;
  double closed_half_width_, open_half_width_, arms_up_deg_, elbow_deg_;
  SlowNoise width_noise_, arm_noise_;  ///< over stances
};

JumpingJacks::JumpingJacks(ClipSetup& setup)
    : body_(setup.body), standing_(standing_posture(setup.style)) {
  Random& random = setup.random;
  const double amplitude = setup.style.amplitude;
  hop_s_ = random.normal(0.50, 0.035) / setup.style.tempo;
  flight_s_ = hop_s_ * random.uniform(0.42, 0.52);
  first_take_off_s_ = random.uniform(0.5, 0.9);
  // An even number of hops, so that the clip ends with the feet together; at least one pair, even
  // where the clip is too short to show it.
  const double room_s = setup.seconds() - first_take_off_s_ - 0.3;
  hops_ = 2 * std::max(1, static_cast<int>(std::floor(room_s / (2 * hop_s_))));
  closed_half_width_ = body_.hip_half_width * random.uniform(0.7, 1.0);
  open_half_width_ = body_.leg() * random.normal(0.34, 0.03) * amplitude;
  arms_up_deg_ = std::clamp(random.normal(158, 8) * std::sqrt(amplitude), 135.0, 172.0);
  elbow_deg_ = random.uniform(8, 28);
  width_noise_ = SlowNoise(random, 0.05, 0.2);
  arm_noise_ = SlowNoise(random, 5, 0.2);
}

double JumpingJacks::half_width(int stance) const {
  return (is_open(stance) ? open_half_width_ : closed_half_width_) * (1 + width_noise_(stance));
}

FootPrint JumpingJacks::print(Side side, int stance) const {
  const double turn_deg = is_open(stance) ? 16 : 6;
  return {{sign_of(side) * half_width(stance), body_.ankle_height, 0}, sign_of(side) * turn_deg};
}

/// Height of the hips with legs nearly straight over feet on their balls.
double JumpingJacks::hips_over_toes(int stance, double pitch_deg) const {
  const double across = half_width(stance) - body_.hip_half_width;
  const double reach = 0.985 * body_.leg();
  const double ankle = planted_foot(body_, print(kLeft, stance), pitch_deg).ankle.y();
  return ankle + std::sqrt(reach * reach - across * across) + body_.hip_drop;
}

Flight JumpingJacks::flight(int hop) const {
  return {hips_over_toes(hop, kTakeOffPitch_deg), hips_over_toes(hop + 1, kLandingPitch_deg) - 1.5,
          flight_s_};
}

/// @param t seconds to the first take-off, below 0
double JumpingJacks::height_before(double t) const {
  const double stand = standing_height(body_), low = stand - 9;
  if (t < -2 * kDip_s) return stand;
  if (t < -kDip_s) return hermite(t + 2 * kDip_s, kDip_s, stand, 0.0, low, 0.0);
  return hermite(t + kDip_s, kDip_s, low, 0.0, flight(0).from, flight(0).take_off_speed());
}

/// @param t seconds since the last landing
double JumpingJacks::height_after(double t) const {
  const double stand = standing_height(body_), low = stand - 8;
  const Flight last = flight(hops_ - 1);
  if (t < kDip_s) return hermite(t, kDip_s, last.to, last.landing_speed(), low, 0.0);
  return hermite(std::min(t, 3 * kDip_s) - kDip_s, 2 * kDip_s, low, 0.0, stand, 0.0);
}

double JumpingJacks::hips_height(int hop, double t) const {
  if (t < 0) return height_before(t);
  const Flight now = flight(hop);
  if (t < flight_s_) return now.at(t);
  if (hop + 1 == hops_) return height_after(t - flight_s_);
  const Flight next = flight(hop + 1);
  return hermite(t - flight_s_, hop_s_ - flight_s_, now.to, now.landing_speed(), next.from,
                 next.take_off_speed());
}

double JumpingJacks::pitch_deg(int hop, double t) const {
  constexpr double kRoll_s = 0.09;
  if (t < 0) return kTakeOffPitch_deg * smooth_step(-kRoll_s, 0, t);
  if (t < flight_s_) {
    return std::lerp(kTakeOffPitch_deg, kLandingPitch_deg, smooth_step(0, flight_s_, t));
  }
  const double landed = kLandingPitch_deg * (1 - smooth_step(0, kRoll_s, t - flight_s_));
  if (hop + 1 == hops_) return landed;
  return landed + kTakeOffPitch_deg * smooth_step(hop_s_ - kRoll_s, hop_s_, t);
}

Foot JumpingJacks::foot(Side side, int hop, double t) const {
  const double pitch = pitch_deg(hop, t);
  if (t < 0) return planted_foot(body_, print(side, hop), pitch);
  Foot landing = planted_foot(body_, print(side, hop + 1), pitch);
  if (t >= flight_s_) return landing;
  const Foot leaving = planted_foot(body_, print(side, hop), pitch);
  const double u = t / flight_s_, across = smooth_step(0, 1, u);
  Foot foot = landing;
  foot.planted = false;
  foot.turn_deg = std::lerp(leaving.turn_deg, landing.turn_deg, across);
  foot.toe_bend_deg *= 1 - std::sin(std::numbers::pi * u);
  foot.ankle = (1 - across) * leaving.ankle + across * landing.ankle;
  foot.ankle.y() += 0.8 * Flight{0, 0, flight_s_}.at(t);
  return foot;
}

Posture JumpingJacks::posture(int hop, double t) const {
  const double moved = smooth_step(0, 0.92 * hop_s_, t);
  const double up = is_open(hop + 1) ? moved : 1 - moved;
  const double up_deg = arms_up_deg_ + arm_noise_(is_open(hop) ? hop : hop + 1);
  Posture posture = standing_;
  for (const Side side : kSides) {
    const auto raise = [&](ArmDof dof, double to) {
      double& angle = posture[arm_dof(side, dof)];
      angle = std::lerp(angle, to, up);
    };
    raise(kAbduction, up_deg);
    raise(kElbow, elbow_deg_);
    raise(kTwist, -75);
    raise(kShrug, 22);
    posture[arm_dof(side, kElbow)] += 48 * up * (1 - up);  // swings in bent
  }
  posture[kTrunkFlex] += 4 * (1 - up);
  posture[kHeadNod] -= 4 * up;
  return posture;
}

Frame JumpingJacks::frame(double t_s) const {
  const double since = t_s - first_take_off_s_;
  const int hop = std::clamp(static_cast<int>(std::floor(since / hop_s_)), 0, hops_ - 1);
  const double t = since - hop * hop_s_;
  Frame frame;
  frame.posture = posture(hop, t);
  frame.hips = {0, hips_height(hop, t), 0};
  for (const Side side : kSides) frame.feet[side] = foot(side, hop, t);
  return frame;
}

}  // namespace

std::vector<Frame> jumping_jacks(ClipSetup& setup) {
  const JumpingJacks jacks(setup);
  std::vector<Frame> frames;
  frames.reserve(setup.frame_count);
  for (int i = 0; i < setup.frame_count; ++i) frames.push_back(jacks.frame(i / setup.fps));
  return frames;
}

}  // namespace mcdbn::synthesis
