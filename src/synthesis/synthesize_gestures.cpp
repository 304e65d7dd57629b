#include <algorithm>
#include <cmath>
#include <numbers>

#include "synthesis/synthesize_actions.hpp"
#include "synthesis/synthesize_curves.hpp"
#include "synthesis/synthesize_flight.hpp"

namespace mcdbn::synthesis {
namespace {

/// Rest, action, rest: when the arms come up and go down again, seconds.
class Interlude {
 public:
  Interlude(Random& random, double seconds) {
    begin_ = std::min(random.uniform(0.2, 0.7), 0.1 * seconds);
    up_ = begin_ + random.uniform(0.5, 0.75);
    const double rest = std::min(random.uniform(0.2, 0.6), 0.1 * seconds);
    down_ = std::max(up_ + 0.5, seconds - rest);
    lowering_ = std::max(up_, down_ - random.uniform(0.6, 0.9));
  }
  /// 0 at rest, 1 in the action.
  double weight(double t_s) const {
    return smooth_step(begin_, up_, t_s) * (1 - smooth_step(lowering_, down_, t_s));
  }

 private:
  double begin_, up_, lowering_, down_;
};

/// Standing on both feet, swaying a little.
class Standing {
 public:
  explicit Standing(ClipSetup& setup)
      : body_(setup.body),
        prints_(standing_prints(setup.body, setup.style)),
        aside_(setup.random, 0.9, 0.25),
        forward_(setup.random, 0.6, 0.3) {}

  Frame frame(double t_s) const {
    Frame frame;
    frame.hips = {aside_(t_s), standing_height(body_), forward_(t_s)};
    for (const Side side : kSides) frame.feet[side] = planted_foot(body_, prints_[side], 0);
    return frame;
  }

 private:
  Body body_;
  std::array<FootPrint, 2> prints_;
  SlowNoise aside_, forward_;
};

/// One waving arm: held up with the forearm rising, the forearm swinging from side to side.
struct Wave {
  double abduction, flexion, elbow, swing, rate_hz, phase;

  /// @param high 0: the elbow at the chest, 1: the hand over the head
  static Wave draw(Random& random, double high, const Style& style) {
    Wave wave{};
    wave.abduction = std::lerp(62, 122, high) + random.normal(0, 4);
    wave.flexion = random.uniform(5, 25);
    wave.elbow = std::lerp(104, 58, high) + random.normal(0, 4);
    wave.swing = random.uniform(20, 30) * style.amplitude;
    wave.rate_hz = random.uniform(1.1, 1.8) * style.tempo;
    wave.phase = random.uniform(0, 1);
    return wave;
  }

  void apply(Posture& posture, Side side, double cycles, double weight) const {
    const double swung = std::sin(2 * std::numbers::pi * (cycles + phase));
    const double follows = std::sin(2 * std::numbers::pi * (cycles + phase - 0.12));
    const auto set = [&](ArmDof dof, double to) {
      double& angle = posture[arm_dof(side, dof)];
      angle = std::lerp(angle, to, weight);
    };
    set(kAbduction, abduction - 4 * swung);
    set(kFlexion, flexion);
    set(kTwist, -90);
    set(kElbow, elbow + swing * swung);
    set(kWrist, -12 * follows);
    set(kShrug, 0.09 * abduction);
  }
};

}  // namespace

std::vector<Frame> wave(ClipSetup& setup, int hands) {
  Random& random = setup.random;
  const Interlude interlude(random, setup.seconds());
  const Standing standing(setup);
  const double high = hands == 1 ? random.uniform(0, 1) : random.uniform(0.35, 1);
  const Wave right = Wave::draw(random, high, setup.style);
  Wave left = Wave::draw(random, high, setup.style);
  left.rate_hz = right.rate_hz;
  // Two arms swing apart and together, or some people's to the same side.
  left.phase = right.phase + (random.chance(0.7) ? 0 : 0.5);
  left.phase += random.normal(0, 0.03);
  const SlowNoise tempo(random, 0.08, 0.3), size(random, 0.08, 0.3);
  std::vector<Frame> frames;
  for (int i = 0; i < setup.frame_count; ++i) {
    const double t_s = i / setup.fps;
    const double weight = interlude.weight(t_s);
    const double cycles = right.rate_hz * t_s + tempo(t_s);
    Frame frame = standing.frame(t_s);
    frame.posture = standing_posture(setup.style);
    const auto swing = [&](Wave arm, Side side) {
      arm.swing *= 1 + size(t_s);
      arm.apply(frame.posture, side, cycles, weight);
    };
    swing(right, kRight);
    if (hands == 2) swing(left, kLeft);
    if (hands == 1) {  // the body leans away from one raised arm
      frame.posture[kTrunkBend] -= 3 * weight;
      frame.hips.x() += 1.2 * weight;
    }
    frames.push_back(frame);
  }
  return frames;
}

std::vector<Frame> clap(ClipSetup& setup) {
  Random& random = setup.random;
  const Body& body = setup.body;
  const Interlude interlude(random, setup.seconds());
  const Standing standing(setup);
  const double rate_hz = random.uniform(1.6, 2.8) * setup.style.tempo;
  const double apart_cm = random.uniform(9, 17) * setup.style.amplitude;  // of each hand
  const double height = body.stature * random.uniform(-0.03, 0.06);
  const double reach = body.stature * random.uniform(0.19, 0.23);
  const double rise = random.uniform(0.4, 1.1);  // of the hands' direction
  const SlowNoise tempo(random, 0.08, 0.3), size(random, 0.1, 0.4);
  std::vector<Frame> frames;
  for (int i = 0; i < setup.frame_count; ++i) {
    const double t_s = i / setup.fps;
    const double weight = interlude.weight(t_s);
    const double turn = 2 * std::numbers::pi * (rate_hz * t_s + tempo(t_s));
    const double open = 0.5 - 0.5 * std::cos(turn);
    Frame frame = standing.frame(t_s);
    frame.posture = standing_posture(setup.style);
    frame.posture[kHeadNod] += 4 * weight;
    frame.posture[kTrunkFlex] += weight * (1.5 - 1.0 * open);
    for (const Side side : kSides) {
      constexpr double kPalmThickness = 2.2;
      const double aside = kPalmThickness + apart_cm * (1 + size(t_s)) * open;
      const Eigen::Vector3d wrist(sign_of(side) * aside, height + 0.1 * aside,
                                  reach - 0.12 * aside);
      const Eigen::Vector3d elbow(0.75 * sign_of(side), -1, -0.2);
      const Eigen::Vector3d hand(0.25 * sign_of(side) * open, rise, 1);
      frame.arms[side] = blend(arm_pose(frame.posture, side),
                               reaching_arm(body, side, wrist, elbow, hand), weight);
    }
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace mcdbn::synthesis
