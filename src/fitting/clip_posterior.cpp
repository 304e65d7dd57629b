#include "fitting/clip_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "fitting/clip_windows.hpp"
#include "fitting/two_threads.hpp"
#include "fitting/window_problem.hpp"

namespace mcdbn {
namespace {

/// Puts a window's solution beside what stands, which fades out over the frames that both have.
/// @param known frames that stand already
void join(PosteriorPoint& whole, Eigen::Index known, const PosteriorPoint& part,
          const ClipWindow& window) {
  for (Eigen::Index t = 0; t < window.frames; ++t) {
    const double share = share_of_window(window, known, t);
    for (const auto rows : {&PosteriorPoint::turns, &PosteriorPoint::shift})
      (whole.*rows).row(window.first + t) =
          (1 - share) * (whole.*rows).row(window.first + t) + share * (part.*rows).row(t);
  }
}

/// The other frames take what a window has found of what all frames share. One camera does not
/// distinguish a large body from a near one, nor a long lens from a short distance: they start
/// where that body is seen through that lens as theirs was.
void start_as_seen(PosteriorPoint& from, const PosteriorClip& clip, const ClipWindow& window,
                   const PosteriorPoint& found) {
  if (clip.body_unknown || clip.camera) {
    const auto depth = [&](const MatrixD& shift) {
      return (clip.root.middleRows(window.first, window.frames) + shift).col(2).sum();
    };
    const double further =
        depth(found.shift) / depth(from.shift.middleRows(window.first, window.frames));
    const double sideways = further * std::exp(from.log_focal - found.log_focal);
    const MatrixD root = clip.root + from.shift;
    from.shift += root * Eigen::Vector3d(sideways - 1, sideways - 1, further - 1).asDiagonal();
  }
  from.take_shared(found);
}

/// Every so-manieth row, from the first on.
MatrixD thinned(const MatrixD& rows, Eigen::Index every) {
  return rows(Eigen::seq(0, rows.rows() - 1, every), Eigen::all);
}

/// The clip as a camera of that much slower rate has it.
PosteriorClip thinned(const PosteriorClip& clip, Eigen::Index every) {
  PosteriorClip coarse = clip;
  for (const auto rows : {&PosteriorClip::turn_deviation_rad, &PosteriorClip::root,
                          &PosteriorClip::travelled, &PosteriorClip::planted})
    coarse.*rows = thinned(clip.*rows, every);
  if (clip.mean_lean.rows() > 0) coarse.mean_lean = thinned(clip.mean_lean, every);
  coarse.seen.clear();
  for (Eigen::Index t = 0; t < clip.frames(); t += every) {
    coarse.seen.push_back(clip.seen[static_cast<std::size_t>(t)]);
    // A foot stands if it does from each frame to the next.
    if (t > 0)
      coarse.planted.row(t / every) =
          clip.planted.middleRows(t - every + 1, every).colwise().minCoeff();
  }
  coarse.frame_time_s *= static_cast<double>(every);
  return coarse;
}

/// Straight lines between rows that are `every` frames apart; the last one stays.
MatrixD between(const MatrixD& rows, Eigen::Index every, Eigen::Index frames) {
  MatrixD all(frames, rows.cols());
  for (Eigen::Index t = 0; t < frames; ++t) {
    const Eigen::Index before = t / every, after = std::min(before + 1, rows.rows() - 1);
    const double share = static_cast<double>(t % every) / static_cast<double>(every);
    all.row(t) = (1 - share) * rows.row(before) + share * rows.row(after);
  }
  return all;
}

}  // namespace

PosteriorPoint PosteriorPoint::zero(const PosteriorClip& clip) {
  const auto turns = 3 * static_cast<Eigen::Index>(clip.parents.size());
  const int lengths =
      clip.lengths.empty() ? 0 : 1 + *std::max_element(clip.lengths.begin(), clip.lengths.end());
  const int grounds =
      clip.grounds.empty() ? 0 : 1 + *std::max_element(clip.grounds.begin(), clip.grounds.end());
  return {MatrixD::Zero(clip.frames(), turns), MatrixD::Zero(clip.frames(), 3),
          Eigen::VectorXd::Zero(lengths), Eigen::VectorXd::Zero(grounds)};
}

void PosteriorPoint::take_shared(const PosteriorPoint& other) {
  log_lengths = other.log_lengths;
  ground_m = other.ground_m;
  lean = other.lean;
  log_focal = other.log_focal;
}

std::size_t most_seen(const PosteriorClip& clip, const std::vector<ClipWindow>& windows) {
  const auto seen_in = [&](const ClipWindow& window) {
    std::ptrdiff_t joints = 0;
    for (Eigen::Index t = window.first; t < window.end(); ++t)
      joints += std::ranges::count_if(clip.seen[static_cast<std::size_t>(t)],
                                      [](const SeenJoint& joint) { return joint.confidence > 0; });
    return joints;
  };
  std::vector<std::pair<std::ptrdiff_t, std::ptrdiff_t>> ranks;
  ranks.reserve(windows.size());
  for (const ClipWindow& window : windows)
    ranks.emplace_back(seen_in(window), -std::abs(std::ssize(ranks) - std::ssize(windows) / 2));
  return static_cast<std::size_t>(std::ranges::max_element(ranks) - ranks.begin());
}

PosteriorPoint map_solution(const PosteriorClip& clip, const RayNoise& noise,
                            const TrackFitSettings& settings, PosteriorPoint from,
                            SharedUnknowns shared, double small_gain, const WindowSizes& sizes) {
  const std::vector<ClipWindow> windows = windows_of(clip.frames(), sizes);
  const auto solved = [&](const ClipWindow& window, bool shared_too) {
    WindowProblem problem(clip, noise, settings, from, window.first, window.frames);
    problem.solve(shared_too, small_gain);
    return problem.solution();
  };
  if (windows.size() == 1) return solved(windows.front(), true);
  std::vector<PosteriorPoint> parts(windows.size());
  std::vector<std::size_t> others(windows.size());
  std::iota(others.begin(), others.end(), 0);
  if (shared == SharedUnknowns::to_be_found) {
    const std::size_t first = most_seen(clip, windows);
    parts[first] = solved(windows[first], true);
    start_as_seen(from, clip, windows[first], parts[first]);
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(first));
  }
  on_two_threads(others.size(),
                 [&](std::size_t i) { parts[others[i]] = solved(windows[others[i]], false); });
  PosteriorPoint whole = from;
  whole.energy = 0;  // frames that two windows have count twice
  for (std::size_t i = 0; i < windows.size(); ++i) {
    join(whole, i == 0 ? 0 : windows[i - 1].end(), parts[i], windows[i]);
    whole.energy += parts[i].energy;
  }
  return whole;
}

PosteriorPoint coarse_solution(const PosteriorClip& clip, const RayNoise& noise,
                               const TrackFitSettings& settings, PosteriorPoint from) {
  const auto every =
      std::max<Eigen::Index>(1, std::lround(settings.first_solution_step_s / clip.frame_time_s));
  for (const auto rows : {&PosteriorPoint::turns, &PosteriorPoint::shift})
    from.*rows = thinned(from.*rows, every);
  PosteriorPoint point = map_solution(thinned(clip, every), noise, settings, std::move(from),
                                      SharedUnknowns::to_be_found, kSmallGainOfCoarse, kFewFrames);
  for (const auto rows : {&PosteriorPoint::turns, &PosteriorPoint::shift})
    point.*rows = between(point.*rows, every, clip.frames());
  return point;
}

Eigen::Vector3d place_of(const PosteriorClip& clip, const PosteriorPoint& point, Eigen::Index frame,
                         std::size_t joint) {
  const auto& levers = clip.seen[static_cast<std::size_t>(frame)][joint].levers;
  std::vector<double const*> unknowns;
  unknowns.reserve(2 * levers.size() + 1);
  for (const Lever& lever : levers) unknowns.push_back(&point.turns(frame, 3 * lever.turn));
  unknowns.push_back(&point.shift(frame, 0));
  for (const Lever& lever : levers)
    unknowns.push_back(&point.log_lengths[clip.lengths[static_cast<std::size_t>(lever.turn)]]);
  return JointPlace(levers, clip.root.row(frame).transpose(), true).at(unknowns.data());
}

}  // namespace mcdbn
