#include <algorithm>
#include <cmath>
#include <numbers>

#include "synthesis/synthesize_actions.hpp"
#include "synthesis/synthesize_curves.hpp"
#include "synthesis/synthesize_flight.hpp"

namespace mcdbn::synthesis {
namespace {

/// One overhand throw of the right hand with a step of the left foot; begins and ends standing.
class Throw {
 public:
  Throw(const Body& body, const Style& style, Random& random);

  double duration() const { return times_.back(); }
  Frame frame(const std::array<FootPrint, 2>& prints, double t) const;

 private:
  enum Phase {
    kStand,
    kSet,
    kWindUp,
    kStride,
    kCock,
    kRelease,
    kFollow,
    kReturn,
    kEnd,
    kPhaseCount
  };

  /// Values at the phases in turn, through which the angle runs.
  double run(const std::array<double, kPhaseCount>& values, double t) const;
  Posture posture(double t) const;
  Foot stepping_foot(const FootPrint& home, double t) const;
  Foot pivoting_foot(const FootPrint& home, double t) const;

  Body body_;
  Posture standing_;
  double size_, stride_, lift_;
  std::array<double, kPhaseCount> times_{};
};

Throw::Throw(const Body& body, const Style& style, Random& random)
    : body_(body),
      standing_(standing_posture(style)),
      size_(style.amplitude * random.normal(1, 0.06)),
      stride_(body.leg() * random.normal(0.48, 0.04) * style.amplitude),
      lift_(random.uniform(7, 16)) {
  constexpr std::array<double, kPhaseCount> kDurations{0,    0.42, 0.50, 0.34, 0.14,
                                                       0.10, 0.24, 0.60, 0.50};
  double t = 0;
  for (int phase = 0; phase < kPhaseCount; ++phase) {
    t += kDurations[phase] / style.tempo * random.normal(1, 0.05);
    times_[phase] = t;
  }
}

double Throw::run(const std::array<double, kPhaseCount>& values, double t) const {
  std::vector<KeyCurve::Key> keys;
  keys.reserve(kPhaseCount);
  for (int phase = 0; phase < kPhaseCount; ++phase) keys.emplace_back(times_[phase], values[phase]);
  return KeyCurve(keys)(t);
}

Posture Throw::posture(double t) const {
  Posture posture = standing_;
  const auto add = [&](int dof, const std::array<double, kPhaseCount>& values) {
    posture[dof] += size_ * run(values, t);
  };
  //                 stand set wind stride cock release follow return end
  add(kPelvisTurn, {0, -10, -55, -48, -10, 18, 34, 8, 0});
  add(kPelvisTilt, {0, 0, -3, -2, 4, 12, 20, 4, 0});
  add(kTrunkTwist, {0, -4, -18, -32, -22, 14, 26, 6, 0});
  add(kTrunkFlex, {0, 3, -3, -8, -8, 14, 30, 6, 0});
  add(kTrunkBend, {0, 0, 2, 4, -6, -13, -10, 0, 0});
  add(kHeadNod, {0, 0, 2, 5, 3, -14, -28, -4, 0});
  const auto set = [&](Side side, ArmDof dof, const std::array<double, kPhaseCount>& values) {
    // `values` count from the standing arm at both ends.
    double& angle = posture[arm_dof(side, dof)];
    std::array<double, kPhaseCount> keys = values;
    keys[kStand] = keys[kEnd] = angle;
    angle = run(keys, t);
  };
  set(kRight, kFlexion, {0, 32, -5, 60, 88, 96, 48, 20, 0});
  set(kRight, kAbduction, {0, 10, 52, 94, 98, 62, -14, 8, 0});
  set(kRight, kTwist, {0, 45, 15, -10, -28, 12, 45, 25, 0});
  set(kRight, kElbow, {0, 92, 48, 92, 96, 28, 34, 30, 0});
  set(kLeft, kFlexion, {0, 32, 50, 82, 62, 28, -8, 12, 0});
  set(kLeft, kAbduction, {0, 10, 28, 34, 34, 28, 24, 12, 0});
  set(kLeft, kTwist, {0, 45, 30, 20, 25, 30, 20, 18, 0});
  set(kLeft, kElbow, {0, 92, 60, 20, 62, 100, 78, 40, 0});
  // The eyes stay on the target.
  posture[kHeadTurn] =
      std::clamp(-0.9 * (posture[kPelvisTurn] + posture[kTrunkTwist]), -70.0, 70.0);
  return posture;
}

/// The left foot: lifted in the wind-up, set down ahead, taken back at the end.
Foot Throw::stepping_foot(const FootPrint& home, double t) const {
  const double lift_s = 0.5 * (times_[kSet] + times_[kWindUp]), land_s = times_[kStride];
  const double back_s = 0.5 * (times_[kFollow] + times_[kReturn]), home_s = times_[kReturn] + 0.12;
  FootPrint ahead = home;
  ahead.ankle.z() += stride_;
  if (t <= lift_s || t >= home_s) return planted_foot(body_, home, 0);
  if (t >= land_s && t <= back_s) return planted_foot(body_, ahead, 0);
  const bool out = t < land_s;
  const double u = out ? (t - lift_s) / (land_s - lift_s) : (t - back_s) / (home_s - back_s);
  const double arch = std::pow(std::sin(std::numbers::pi * u), 2);
  // Lifted first, then carried forward.
  const double way = out ? smooth_step(0.3, 1, u) : 1 - smooth_step(0, 1, u);
  Foot foot = planted_foot(body_, home, 0);
  foot.planted = false;
  foot.ankle += Eigen::Vector3d(0, (out ? lift_ : 5) * arch, stride_ * way);
  foot.pitch_deg = (out ? -18 + 26 * u : -12) * arch;
  return foot;
}

/// The right foot: it turns on its ball after the release, heel up, as the hips come through.
Foot Throw::pivoting_foot(const FootPrint& home, double t) const {
  const double heel_deg = size_ * run({0, 0, 0, 0, -12, -30, -42, 0, 0}, t);
  FootPrint print = home;
  print.turn_deg += size_ * run({0, 0, 0, 0, 6, 22, 34, 0, 0}, t);
  print.ankle += (rotation_y(home.turn_deg) - rotation_y(print.turn_deg)) * body_.ball_offset();
  return planted_foot(body_, print, heel_deg);
}

Frame Throw::frame(const std::array<FootPrint, 2>& prints, double t) const {
  Frame frame;
  frame.posture = posture(t);
  // The weight goes back over the right foot, then through to the left one.
  const double aside = run({0, -2, -5, -3, -1, 2, 4, 1, 0}, t);
  const double forward = stride_ * run({0, -0.03, -0.10, 0.36, 0.55, 0.66, 0.72, 0.2, 0}, t);
  const double sink = size_ * run({0, 1, 3, 6, 6, 5, 6, 2, 0}, t);
  frame.hips = {aside, standing_height(body_) - sink, forward};
  frame.feet[kLeft] = stepping_foot(prints[kLeft], t);
  frame.feet[kRight] = pivoting_foot(prints[kRight], t);
  return frame;
}

}  // namespace

std::vector<Frame> throw_object(ClipSetup& setup) {
  Random& random = setup.random;
  auto prints = standing_prints(setup.body, setup.style);
  prints[kRight].turn_deg -= random.uniform(12, 25);  // the back foot is turned out
  prints[kRight].ankle.z() -= random.uniform(3, 9);
  std::vector<Frame> frames;
  double start = random.uniform(0.1, 0.4);
  Throw now(setup.body, setup.style, random);
  for (int i = 0; i < setup.frame_count; ++i) {
    const double t_s = i / setup.fps;
    if (t_s > start + now.duration()) {
      start += now.duration() + random.uniform(0.1, 0.6);
      now = Throw(setup.body, setup.style, random);
    }
    frames.push_back(now.frame(prints, std::max(0.0, t_s - start)));
  }
  return frames;
}

}  // namespace mcdbn::synthesis
