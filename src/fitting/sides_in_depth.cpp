#include "fitting/sides_in_depth.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fitting/limb_sides.hpp"
#include "fitting/two_threads.hpp"
#include "fitting/window_problem.hpp"

namespace mcdbn {
namespace {

/// Frames about a stretch that are solved with it: three times what a prior's error lasts.
constexpr double kAround_s = 0.5;
/// Least decrease of the energy for other sides to be taken: less may be the solver's own error.
constexpr double kLikelier = 0.3;
/// How many times the energy may be once the limb alone has settled on other sides: what moves with
/// it lowers that.
constexpr double kLimbAlone = 1.1;
/// Steps with an alternative: whether it is likelier shows by then.
constexpr int kStepsOfAlternative = 8;
/// Factor by which the noise is lowered at each step.
constexpr double kNoiseStep = 3;
/// An energy that grows by more than this factor as the noise is lowered is that of noise in the
/// track: other sides do not lower it.
constexpr double kNoise = 2;

/// A limb's other sides, and the solution from there.
struct Alternative {
  std::size_t limb = 0;
  OtherSides sides;
  ClipWindow window;     ///< about their stretch
  PosteriorPoint found;  ///< of the window, from there
  double gain = 0;       ///< how much lower the energy is than without
};

class SidesInDepth {
 public:
  SidesInDepth(const PosteriorClip& clip, const RayNoise& noise, const TrackFitSettings& settings)
      : clip_(clip),
        noise_(noise),
        settings_(settings),
        limbs_(limbs_of(clip)),
        around_(std::lround(kAround_s / clip.frame_time_s)) {}

  /// Other sides that are likelier for a limb by itself, in windows that overlap one of `within`.
  std::vector<Alternative> alternatives(const PosteriorPoint& point,
                                        const std::vector<ClipWindow>& within) const {
    std::vector<std::vector<OtherSides>> others(limbs_.size());
    on_two_threads(limbs_.size(), [&](std::size_t limb) {
      others[limb] = likelier_sides(clip_, noise_, settings_, point, limbs_[limb]);
    });
    std::vector<Alternative> all;
    for (std::size_t limb = 0; limb < limbs_.size(); ++limb)
      for (OtherSides& sides : others[limb]) {
        const ClipWindow window = window_about(sides.stretch);
        if (std::ranges::any_of(within, [&](const ClipWindow& w) { return meet(w, window); }))
          all.push_back({limb, std::move(sides), window, {}});
      }
    on_two_threads(all.size(), [&](std::size_t i) { solve(point, all[i]); });
    return all;
  }

  /// Puts the likelier alternatives into `point`, each limb over its stretch. @return their windows
  std::vector<ClipWindow> take_likelier(const std::vector<Alternative>& alternatives,
                                        PosteriorPoint& point) const {
    std::vector<ClipWindow> taken;
    for (const Alternative& one : alternatives) {
      if (!(one.gain > kLikelier)) continue;
      const ClipWindow& stretch = one.sides.stretch;
      for (const Bone& bone : limbs_[one.limb])
        point.turns.block(stretch.first, 3 * bone.turn, stretch.frames, 3) = one.found.turns.block(
            stretch.first - one.window.first, 3 * bone.turn, stretch.frames, 3);
      taken.push_back(one.window);
    }
    return taken;
  }

 private:
  static bool meet(const ClipWindow& a, const ClipWindow& b) {
    return a.first < b.end() && b.first < a.end();
  }

  ClipWindow window_about(const ClipWindow& stretch) const {
    const Eigen::Index first = std::max<Eigen::Index>(0, stretch.first - around_);
    return {first, std::min(clip_.frames(), stretch.end() + around_) - first};
  }

  void solve(const PosteriorPoint& point, Alternative& one) const {
    const ClipWindow& stretch = one.sides.stretch;
    PosteriorPoint other = point;
    std::vector<int> turns;
    for (const Bone& bone : limbs_[one.limb]) {
      other.turns.block(stretch.first, 3 * bone.turn, stretch.frames, 3) =
          one.sides.turns.middleCols(3 * std::ssize(turns), 3);
      turns.push_back(bone.turn);
    }
    WindowProblem problem(clip_, noise_, settings_, point, one.window.first, one.window.frames);
    const double stands = problem.energy();
    problem.start_from(other);
    problem.solve_turns(turns, kSmallGainOfAll, kStepsOfAlternative);
    if (problem.energy() > kLimbAlone * stands) return;
    problem.solve(false, kSmallGainOfAll, kStepsOfAlternative);
    one.found = problem.solution();
    // The solution so far only gets likelier once it has settled, too.
    if (!(stands - one.found.energy > kLikelier)) return;
    problem.start_from(point);
    problem.solve(false, kSmallGainOfAll, kStepsOfAlternative);
    one.gain = problem.solution().energy - one.found.energy;
  }

  const PosteriorClip& clip_;
  const RayNoise& noise_;
  const TrackFitSettings& settings_;
  std::vector<Limb> limbs_;
  Eigen::Index around_;
};

}  // namespace

PosteriorPoint likeliest_in_depth(const PosteriorClip& clip, const RayNoise& noise,
                                  const TrackFitSettings& settings, PosteriorPoint point) {
  const SidesInDepth sides(clip, noise, settings);
  std::vector<ClipWindow> changed{{0, clip.frames()}};
  for (std::size_t round = 0; round < settings.most_alternatives; ++round) {
    changed = sides.take_likelier(sides.alternatives(point, changed), point);
    if (changed.empty()) break;
    point = map_solution(clip, noise, settings, std::move(point));
  }
  return point;
}

PosteriorPoint likeliest_of_exact(const PosteriorClip& clip, RayNoise& noise,
                                  const TrackFitSettings& settings, double least,
                                  PosteriorPoint point) {
  point = likeliest_in_depth(clip, noise, settings, std::move(point));
  while (noise.white > least) {
    RayNoise less = noise;
    less.white = std::max(least, noise.white / kNoiseStep);
    less.lasting = 0;
    PosteriorPoint nearer = map_solution(clip, less, settings, point);
    if (!(nearer.energy < kNoise * point.energy)) break;
    nearer = likeliest_in_depth(clip, less, settings, std::move(nearer));
    if (!(nearer.energy < settings.exact_energy_ratio * point.energy)) break;
    noise = less;
    point = std::move(nearer);
  }
  return point;
}

}  // namespace mcdbn
