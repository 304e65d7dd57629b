#include <algorithm>
#include <cmath>
#include <numbers>

#include "synthesis/synthesize_actions.hpp"
#include "synthesis/synthesize_curves.hpp"
#include "synthesis/synthesize_flight.hpp"

namespace mcdbn::synthesis {
namespace {

/// Height of the hips with the feet rolled onto their balls.
double tiptoe_height(const Body& body, double pitch_deg) {
  return standing_height(body) + planted_foot(body, {}, pitch_deg).ankle.y();
}

/// One jump with both feet, from standing to standing; times in seconds from its beginning.
class Jump {
 public:
  Jump(const Body& body, const Style& style, Random& random);

  double duration() const { return end_; }
  double distance() const { return distance_; }
  /// @param prints where the feet stand before it
  Frame frame(const std::array<FootPrint, 2>& prints, double t) const;

 private:
  double hips_height(double t) const;
  double hips_forward(double t) const;
  Foot flying_foot(const FootPrint& from, const FootPrint& to, double t) const;
  Posture posture(double t) const;

  Body body_;
  Posture standing_;
  double depth_, landing_depth_, distance_, tuck_, arm_reach_deg_, bend_deg_;
  double crouched_, take_off_, landing_, absorbed_, end_;
  Flight flight_;
  KeyCurve pitch_;
};

/// Times, heights and angles are drawn in the order in which they stand here.
Jump::Jump(const Body& body, const Style& style, Random& random)
    : body_(body),
      standing_(standing_posture(style)),
      depth_(body.leg() * std::clamp(random.normal(0.33, 0.05) * style.amplitude, 0.22, 0.45)),
      landing_depth_(depth_ * random.uniform(0.65, 0.95)),
      distance_(random.chance(0.5) ? random.uniform(0, 12) : random.uniform(25, 75)),
      tuck_(random.uniform(4, 14)),
      arm_reach_deg_(random.uniform(95, 165)),
      bend_deg_(random.uniform(30, 45)),
      crouched_(random.uniform(0.50, 0.65) / style.tempo),
      take_off_(crouched_ + random.uniform(0.26, 0.32)),
      landing_(take_off_ + random.uniform(0.34, 0.48) * std::sqrt(style.amplitude)),
      absorbed_(landing_ + random.uniform(0.22, 0.30)),
      end_(absorbed_ + random.uniform(0.6, 0.8) / style.tempo),
      flight_{tiptoe_height(body, -50), tiptoe_height(body, -28) - 4, landing_ - take_off_},
      pitch_({{crouched_ + 0.08, 0.0},
              {take_off_, -50.0},
              {take_off_ + 0.1, -55.0},
              {landing_ - 0.04, -28.0},
              {landing_ + 0.10, 0.0}}) {}

double Jump::hips_height(double t) const {
  const double stand = standing_height(body_), low = stand - depth_;
  const double landed_low = stand - landing_depth_;
  if (t < crouched_) return hermite(t, crouched_, stand, 0.0, low, 0.0);
  if (t < take_off_) {
    return hermite(t - crouched_, take_off_ - crouched_, low, 0.0, flight_.from,
                   flight_.take_off_speed());
  }
  if (t < landing_) return flight_.at(t - take_off_);
  if (t < absorbed_) {
    return hermite(t - landing_, absorbed_ - landing_, flight_.to, flight_.landing_speed(),
                   landed_low, 0.0);
  }
  return hermite(std::min(t, end_) - absorbed_, end_ - absorbed_, landed_low, 0.0, stand, 0.0);
}

double Jump::hips_forward(double t) const {
  // Crouching takes the hips back; the body leaves before the feet and lands behind them.
  const double back = -0.12 * depth_, leave = 2 + 0.2 * distance_, land = 0.86 * distance_;
  const double speed = (land - leave) / (landing_ - take_off_);
  if (t < crouched_) return hermite(t, crouched_, 0.0, 0.0, back, 0.0);
  if (t < take_off_) {
    return hermite(t - crouched_, take_off_ - crouched_, back, 0.0, leave, speed);
  }
  if (t < landing_) return leave + speed * (t - take_off_);
  const double settled = distance_ - 0.08 * landing_depth_;
  if (t < absorbed_) {
    return hermite(t - landing_, absorbed_ - landing_, land, speed, settled, 0.0);
  }
  return hermite(std::min(t, end_) - absorbed_, end_ - absorbed_, settled, 0.0, distance_, 0.0);
}

Foot Jump::flying_foot(const FootPrint& from, const FootPrint& to, double t) const {
  const Foot leaving = planted_foot(body_, from, pitch_(take_off_));
  const Foot landing = planted_foot(body_, to, pitch_(landing_));
  const double duration = landing_ - take_off_, u = (t - take_off_) / duration;
  const auto hips = [&](double at) {
    return Eigen::Vector3d(0, hips_height(at), hips_forward(at));
  };
  const Eigen::Vector3d still = Eigen::Vector3d::Zero();
  Foot foot = leaving;
  foot.planted = false;
  foot.pitch_deg = pitch_(t);
  foot.toe_bend_deg = leaving.toe_bend_deg * (1 - smooth_step(0, 0.3, u)) +
                      landing.toe_bend_deg * smooth_step(0.7, 1, u);
  foot.ankle =
      hips(t) + hermite<Eigen::Vector3d>(t - take_off_, duration, leaving.ankle - hips(take_off_),
                                         still, landing.ankle - hips(landing_), still);
  foot.ankle.y() += tuck_ * std::pow(std::sin(std::numbers::pi * u), 2);
  return foot;
}

Posture Jump::posture(double t) const {
  const double air = 0.5 * (take_off_ + landing_);
  Posture posture = standing_;
  const auto add = [&](int dof, const std::vector<KeyCurve::Key>& keys) {
    posture[dof] += KeyCurve(keys)(t);
  };
  add(kPelvisTilt, {{0, 0},
                    {crouched_, 0.75 * bend_deg_},
                    {take_off_, 4},
                    {air, 2},
                    {landing_, 8},
                    {absorbed_, 0.6 * bend_deg_},
                    {end_, 0}});
  add(kTrunkFlex, {{0, 0},
                   {crouched_, 0.6 * bend_deg_},
                   {take_off_, -6},
                   {air, 2},
                   {landing_, 6},
                   {absorbed_, 0.45 * bend_deg_},
                   {end_, 0}});
  add(kHeadNod, {{0, 0},
                 {crouched_, -0.8 * bend_deg_},
                 {take_off_, -4},
                 {air, 2},
                 {absorbed_, -0.5 * bend_deg_},
                 {end_, 0}});
  for (const Side side : kSides) {
    add(arm_dof(side, kFlexion), {{0, 0},
                                  {0.25 * crouched_, 12},
                                  {crouched_, -34},
                                  {take_off_, 0.85 * arm_reach_deg_},
                                  {air, arm_reach_deg_},
                                  {landing_, 0.55 * arm_reach_deg_},
                                  {absorbed_, 15},
                                  {end_, 0}});
    add(arm_dof(side, kElbow), {{0, 0},
                                {crouched_, 5},
                                {0.5 * (crouched_ + take_off_), 35},
                                {air, 12},
                                {absorbed_, 25},
                                {end_, 0}});
    add(arm_dof(side, kAbduction),
        {{0, 0}, {crouched_, 9}, {take_off_, 18}, {air, 18}, {absorbed_, 12}, {end_, 0}});
    add(arm_dof(side, kShrug), {{0, 0}, {crouched_, 0}, {air, 12}, {absorbed_, 0}, {end_, 0}});
  }
  return posture;
}

Frame Jump::frame(const std::array<FootPrint, 2>& prints, double t) const {
  Frame frame;
  frame.posture = posture(t);
  frame.hips = {0, hips_height(t), hips_forward(t)};
  for (const Side side : kSides) {
    FootPrint landed = prints[side];
    landed.ankle.z() += distance_;
    frame.feet[side] = t < take_off_  ? planted_foot(body_, prints[side], pitch_(t))
                       : t < landing_ ? flying_foot(prints[side], landed, t)
                                      : planted_foot(body_, landed, pitch_(t));
  }
  return frame;
}

}  // namespace

std::vector<Frame> jump(ClipSetup& setup) {
  const auto prints = standing_prints(setup.body, setup.style);
  std::vector<Frame> frames;
  double travelled = 0, start = setup.random.uniform(0.2, 0.6);
  Jump now(setup.body, setup.style, setup.random);
  for (int i = 0; i < setup.frame_count; ++i) {
    const double t_s = i / setup.fps;
    if (t_s > start + now.duration()) {
      travelled += now.distance();
      start += now.duration() + setup.random.uniform(0.1, 0.7);
      now = Jump(setup.body, setup.style, setup.random);
    }
    Frame frame = now.frame(prints, std::max(0.0, t_s - start));
    frame.hips.z() += travelled;
    for (Foot& foot : frame.feet) foot.ankle.z() += travelled;
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace mcdbn::synthesis
