#include "fitting/mirrored_bones.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "fitting/clip_windows.hpp"
#include "fitting/rotation.hpp"
#include "fitting/turned_bones.hpp"
#include "fitting/two_threads.hpp"
#include "fitting/window_problem.hpp"

namespace mcdbn {
namespace {

/// A bone may change sides in a frame in which this or less of its length is along the sight.
constexpr double kAcross = 0.3;
/// A stretch is worth a try if more than this of the bone is along the sight somewhere in it.
constexpr double kDeep = 0.1;
/// Frames about a stretch that are solved with it: three times what a prior's error lasts.
constexpr double kAround_s = 0.5;
/// What a mirrored stretch has to be likelier by, as −log: less is the solver's own rest.
constexpr double kLikelier = 1;
/// Steps of a try: whether it is likelier shows by then.
constexpr int kStepsOfTry = 8;

/// The way from a joint's parent to it, if nothing else hangs on the orientation that turns it.
struct Bone {
  int turn = 0;
  std::size_t joint = 0;
};

std::vector<Bone> bones_of(const PosteriorClip& clip) {
  std::vector<Bone> bones;
  for (int turn = 0; turn < std::ssize(clip.parents); ++turn) {
    std::vector<std::size_t> ends;
    for (std::size_t k = 0; k < clip.seen.front().size(); ++k) {
      const std::vector<Lever>& levers = clip.seen.front()[k].levers;
      if (!levers.empty() && levers.front().turn == turn) ends.push_back(k);
    }
    if (ends.size() == 1) bones.push_back({turn, ends.front()});
  }
  return bones;
}

Eigen::Matrix3d turned(const PosteriorPoint& point, Eigen::Index t, const Bone& bone) {
  return rotation_of(point.turns.row(t).segment<3>(3 * bone.turn).transpose());
}

Eigen::Vector3d vector_of(const PosteriorClip& clip, const PosteriorPoint& point, Eigen::Index t,
                          const Bone& bone) {
  return turned(point, t, bone) *
         clip.seen[static_cast<std::size_t>(t)][bone.joint].levers.front().bone;
}

/// The line of sight to the bone's lower end, of length 1.
Eigen::Vector3d sight_of(const PosteriorClip& clip, const PosteriorPoint& point, Eigen::Index t,
                         const Bone& bone) {
  return place_of(clip, point, t, bone.joint).normalized();
}

/// From each frame in which the bone comes nearest to lying across the sight to the next one.
std::vector<ClipWindow> stretches_of(const PosteriorClip& clip, const PosteriorPoint& point,
                                     const Bone& bone) {
  const Eigen::Index frames = clip.frames();
  Eigen::VectorXd depth(frames);  // shares of the bone's length
  for (Eigen::Index t = 0; t < frames; ++t)
    depth[t] =
        std::abs(sight_of(clip, point, t, bone).dot(vector_of(clip, point, t, bone).normalized()));
  std::vector<ClipWindow> stretches;
  Eigen::Index first = 0;
  for (Eigen::Index t = 1; t <= frames; ++t) {
    const bool across =
        t + 1 < frames && depth[t] < kAcross && depth[t] <= depth[t - 1] && depth[t] < depth[t + 1];
    if (t < frames && !across) continue;
    if (depth.segment(first, t - first).maxCoeff() > kDeep) stretches.push_back({first, t - first});
    first = t;
  }
  return stretches;
}

void mirror(const PosteriorClip& clip, const PosteriorPoint& from, const ClipWindow& stretch,
            const Bone& bone, PosteriorPoint& point) {
  for (Eigen::Index t = stretch.first; t < stretch.end(); ++t) {
    const Eigen::Vector3d vector = vector_of(clip, from, t, bone);
    const Eigen::Vector3d sight = sight_of(clip, from, t, bone);
    const Eigen::Matrix3d other_way =
        Eigen::Quaterniond::FromTwoVectors(vector, vector - 2 * vector.dot(sight) * sight)
            .toRotationMatrix();
    point.turns.row(t).segment<3>(3 * bone.turn) =
        rotation_vector(other_way * turned(from, t, bone)).transpose();
  }
}

/// A bone, mirrored over a stretch.
struct Try {
  Bone bone;
  ClipWindow stretch;
  ClipWindow window;     ///< about the stretch
  PosteriorPoint found;  ///< of the window, mirrored
  double gain = 0;       ///< of energy, over what stands
};

class MirroredBones {
 public:
  MirroredBones(const PosteriorClip& clip, const RayNoise& noise, const TrackFitSettings& settings)
      : clip_(clip),
        noise_(noise),
        settings_(settings),
        bones_(bones_of(clip)),
        around_(std::lround(kAround_s / clip.frame_time_s)) {}

  /// All that a bone may do in windows which meet one of those that are given, each from the same
  /// point.
  std::vector<Try> tries(const PosteriorPoint& point, const std::vector<ClipWindow>& within) const {
    std::vector<Try> all;
    for (const Bone& bone : bones_)
      for (const ClipWindow& stretch : stretches_of(clip_, point, bone)) {
        const ClipWindow window = window_about(stretch);
        if (std::ranges::any_of(within, [&](const ClipWindow& w) { return meet(w, window); }))
          all.push_back({bone, stretch, window, {}});
      }
    on_two_threads(all.size(), [&](std::size_t i) { solve_mirrored(point, all[i]); });
    return all;
  }

  /// The best of those that are likelier and do not meet a better one. @return their windows
  std::vector<ClipWindow> take_best(std::vector<Try> tries, PosteriorPoint& point) const {
    std::ranges::stable_sort(tries, std::ranges::greater{}, &Try::gain);
    std::vector<ClipWindow> taken;
    for (const Try& one : tries) {
      const auto meets = [&](const ClipWindow& window) { return meet(window, one.window); };
      if (!(one.gain > kLikelier) || std::ranges::any_of(taken, meets)) continue;
      join(point, one);
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

  void solve_mirrored(const PosteriorPoint& point, Try& one) const {
    WindowProblem problem(clip_, noise_, settings_, point, one.window.first, one.window.frames);
    const double stands = problem.energy();
    std::optional<double> stands_solved;
    for (const bool all_below : {false, true}) {
      PosteriorPoint other = point;
      std::vector<int> turns;
      for (const Bone& each : bones_) {
        if (!hangs_from(clip_.parents, each.turn, one.bone.turn)) continue;
        turns.push_back(each.turn);
        if (all_below || each.turn == one.bone.turn) mirror(clip_, point, one.stretch, each, other);
      }
      if (all_below && turns.size() == 1) break;
      problem.start_from(other);
      problem.solve_turns(turns, kSmallGainOfAll, kStepsOfTry);
      if (problem.energy() > stands) continue;  // while nothing but the limb moves
      problem.solve(false, kSmallGainOfAll, kStepsOfTry);
      const PosteriorPoint found = problem.solution();
      if (!stands_solved) {
        problem.start_from(point);
        problem.solve(false, kSmallGainOfAll, kStepsOfTry);
        stands_solved = problem.solution().energy;
      }
      const double gain = *stands_solved - found.energy;
      if (!(gain > one.gain)) continue;
      one.gain = gain;
      one.found = found;
    }
  }

  /// The stretch as it was found; about it, it fades into what stands.
  void join(PosteriorPoint& point, const Try& one) const {
    for (Eigen::Index i = 0; i < one.window.frames; ++i) {
      const Eigen::Index t = one.window.first + i;
      const Eigen::Index off = std::max({one.stretch.first - t, t - one.stretch.end() + 1, {}});
      const double share = 1 - static_cast<double>(off) / static_cast<double>(around_ + 1);
      for (const auto rows : {&PosteriorPoint::turns, &PosteriorPoint::shift})
        (point.*rows).row(t) += share * ((one.found.*rows).row(i) - (point.*rows).row(t));
    }
  }

  const PosteriorClip& clip_;
  const RayNoise& noise_;
  const TrackFitSettings& settings_;
  std::vector<Bone> bones_;
  Eigen::Index around_;
};

}  // namespace

PosteriorPoint likeliest_in_depth(const PosteriorClip& clip, const RayNoise& noise,
                                  const TrackFitSettings& settings, PosteriorPoint point) {
  const MirroredBones bones(clip, noise, settings);
  std::vector<ClipWindow> changed{{0, clip.frames()}};
  for (std::size_t round = 0; round < settings.alternatives; ++round) {
    changed = bones.take_best(bones.tries(point, changed), point);
    if (changed.empty()) break;
    point = most_likely(clip, noise, settings, std::move(point));
  }
  return point;
}

}  // namespace mcdbn
