#include "fitting/limb_sides.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fitting/prior_errors.hpp"
#include "motion/rotation_vector.hpp"

namespace mcdbn {
namespace {

/// Two sides each, and three frames in a row: more would take long.
constexpr std::size_t kMostBones = 4;
/// How much of what noise leaves open of a bone's direction excuses it from a steady turn.
constexpr double kExcused = 0.1;
/// Frames: what is on another side for less is noise.
constexpr Eigen::Index kLeastStretch = 2;

/// A limb in one frame with each of its bones on one side or the other.
struct Sides {
  std::array<Eigen::Vector3d, kMostBones> turn;      ///< radians
  std::array<Eigen::Vector3d, kMostBones> residual;  ///< from what is expected, in deviations
  std::array<double, kMostBones> open;               ///< variance by noise of `residual`
};

/// A limb in all frames; sets of sides are numbered by their bits, 0 is as the solution has it.
class LimbInTime {
 public:
  LimbInTime(const PosteriorClip& clip, const RayNoise& noise, const TrackFitSettings& settings,
             const PosteriorPoint& point, const Limb& limb)
      : clip_(clip),
        point_(point),
        limb_(limb),
        prior_(clip, noise, settings),
        noise_(std::hypot(noise.white, noise.lasting)) {
    for (Eigen::Index t = 0; t < clip.frames(); ++t)
      for (std::size_t set = 0; set < sets(); ++set) sides_.push_back(with_sides(t, set));
  }

  /// The sequence of the least energy, by frame; there are at least three frames.
  std::vector<std::size_t> likeliest() const {
    const std::size_t sets = this->sets();
    const Eigen::Index frames = clip_.frames();
    // By the sets of the last frame but one and the last: the least energy, and what it came from.
    std::vector<double> least(sets * sets);
    std::vector<std::vector<std::uint8_t>> before(static_cast<std::size_t>(frames));
    for (std::size_t a = 0; a < sets; ++a)
      for (std::size_t b = 0; b < sets; ++b) least[a * sets + b] = value(0, a) + value(1, b);
    for (Eigen::Index t = 2; t < frames; ++t) {
      std::vector<double> next(sets * sets, std::numeric_limits<double>::infinity());
      auto& from = before[static_cast<std::size_t>(t)];
      from.resize(sets * sets);
      for (std::size_t b = 0; b < sets; ++b)
        for (std::size_t c = 0; c < sets; ++c) {
          const double own = value(t, c);
          for (std::size_t a = 0; a < sets; ++a) {
            const double energy = least[a * sets + b] + bend(t, a, b, c) + own;
            if (!(energy < next[b * sets + c])) continue;
            next[b * sets + c] = energy;
            from[b * sets + c] = static_cast<std::uint8_t>(a);
          }
        }
      least = std::move(next);
    }
    const auto best = static_cast<std::size_t>(std::ranges::min_element(least) - least.begin());
    std::vector<std::size_t> path(static_cast<std::size_t>(frames));
    path[path.size() - 1] = best % sets;
    path[path.size() - 2] = best / sets;
    for (std::size_t t = path.size(); t-- > 2;)
      path[t - 2] = before[t][path[t - 1] * sets + path[t]];
    return path;
  }

  const Sides& at(Eigen::Index t, std::size_t set) const {
    return sides_[static_cast<std::size_t>(t) * sets() + set];
  }

 private:
  std::size_t sets() const { return std::size_t{1} << limb_.size(); }

  Sides with_sides(Eigen::Index t, std::size_t set) const {
    Sides sides;
    const int top = clip_.parents[static_cast<std::size_t>(limb_.front().turn)];
    Eigen::Vector3d parent(0, 0, 0);
    if (top >= 0) parent = point_.turns.row(t).segment<3>(3 * top).transpose();
    Eigen::Vector3d upper =
        place_of(clip_, point_, t, limb_.front().joint) - vector_of(t, limb_.front());
    for (std::size_t i = 0; i < limb_.size(); ++i) {
      const Bone& bone = limb_[i];
      const Eigen::Vector3d expected = prior_.expected_turn(t, bone.turn, parent, point_.lean);
      const bool other = (set >> i & 1) != 0;
      const Eigen::Vector3d vector = on_side(t, bone, upper, other);
      const Eigen::Matrix3d as_expected = rotation_of(expected);
      sides.turn[i] =
          rotation_vector(Eigen::Quaterniond::FromTwoVectors(as_expected * mean_of(t, bone), vector)
                              .toRotationMatrix() *
                          as_expected);
      const double deviation = prior_.own_deviation_rad(t, bone.turn);
      sides.residual[i] = (sides.turn[i] - expected) / deviation;
      upper += vector;
      sides.open[i] = std::pow(open_rad(upper, vector) / deviation, 2);
      parent = sides.turn[i];
    }
    return sides;
  }

  /// Where the prior's mean has it.
  const Eigen::Vector3d& mean_of(Eigen::Index t, const Bone& bone) const {
    return clip_.seen[static_cast<std::size_t>(t)][bone.joint].levers.front().bone;
  }
  Eigen::Vector3d vector_of(Eigen::Index t, const Bone& bone) const {
    return rotation_of(point_.turns.row(t).segment<3>(3 * bone.turn).transpose()) *
           mean_of(t, bone);
  }

  /// The bone as it reaches from its upper end to the ray. One that is too short for that lies
  /// across; where there is no ray it is mirrored.
  Eigen::Vector3d on_side(Eigen::Index t, const Bone& bone, const Eigen::Vector3d& upper,
                          bool other) const {
    const SeenJoint& joint = clip_.seen[static_cast<std::size_t>(t)][bone.joint];
    const Eigen::Vector3d now = vector_of(t, bone);
    if (!(joint.confidence > 0)) {
      const Eigen::Vector3d ray = place_of(clip_, point_, t, bone.joint).normalized();
      return other ? Eigen::Vector3d(now - 2 * now.dot(ray) * ray) : now;
    }
    const Eigen::Vector3d ray = joint.ray.homogeneous().normalized();
    const double along = ray.dot(upper), length = now.norm();
    const double half =
        std::sqrt(std::max(0.0, length * length - (upper.squaredNorm() - along * along)));
    const bool away = (now.dot(ray) > 0) != other;
    return length * ((along + (away ? half : -half)) * ray - upper).normalized();
  }

  /// How far a bone may turn while the ray's noise hides it.
  /// @param place of its lower end
  double open_rad(const Eigen::Vector3d& place, const Eigen::Vector3d& vector) const {
    const double noise = noise_ * place.z() / vector.norm();
    const double along_ray = std::abs(place.normalized().dot(vector.normalized()));
    return std::min(noise / std::max(along_ray, noise), std::sqrt(2 * noise));
  }

  double value(Eigen::Index t, std::size_t set) const {
    double squares = 0;
    for (std::size_t i = 0; i < limb_.size(); ++i) squares += at(t, set).residual[i].squaredNorm();
    return prior_.process().value_weight / 2 * squares;
  }

  /// @param t the last of the three frames
  double bend(Eigen::Index t, std::size_t a, std::size_t b, std::size_t c) const {
    const Sides &first = at(t - 2, a), &second = at(t - 1, b), &third = at(t, c);
    double squares = 0;
    for (std::size_t i = 0; i < limb_.size(); ++i) {
      const double open = first.open[i] + 4 * second.open[i] + third.open[i];
      squares += (first.residual[i] - 2 * second.residual[i] + third.residual[i]).squaredNorm() /
                 (1 + kExcused * prior_.process().curvature_weight * open);
    }
    return prior_.process().curvature_weight / 2 * squares;
  }

  const PosteriorClip& clip_;
  const PosteriorPoint& point_;
  const Limb& limb_;
  PriorErrors prior_;
  double noise_;
  std::vector<Sides> sides_;  ///< by frame and set
};

}  // namespace

std::vector<Limb> limbs_of(const PosteriorClip& clip) {
  std::vector<Limb> limbs;
  for (int turn = 0; turn < std::ssize(clip.parents); ++turn) {
    std::vector<std::size_t> ends;
    for (std::size_t k = 0; k < clip.seen.front().size(); ++k) {
      const std::vector<Lever>& levers = clip.seen.front()[k].levers;
      if (!levers.empty() && levers.front().turn == turn) ends.push_back(k);
    }
    if (ends.size() != 1) continue;
    const int parent = clip.parents[static_cast<std::size_t>(turn)];
    const auto above = std::ranges::find_if(limbs, [&](const Limb& limb) {
      return limb.back().turn == parent && limb.size() < kMostBones;
    });
    if (above == limbs.end())
      limbs.push_back({{turn, ends.front()}});
    else
      above->push_back({turn, ends.front()});
  }
  return limbs;
}

std::vector<OtherSides> likelier_sides(const PosteriorClip& clip, const RayNoise& noise,
                                       const TrackFitSettings& settings,
                                       const PosteriorPoint& point, const Limb& limb) {
  constexpr Eigen::Index kBend = 3;
  if (clip.frames() < kBend) return {};
  const LimbInTime in_time(clip, noise, settings, point, limb);
  const std::vector<std::size_t> path = in_time.likeliest();
  std::vector<OtherSides> others;
  const auto is_other = [](std::size_t set) { return set != 0; };
  for (auto first = std::ranges::find_if(path, is_other); first != path.end();) {
    const auto end = std::find(first, path.end(), std::size_t{0});
    const ClipWindow stretch{first - path.begin(), end - first};
    if (stretch.frames >= kLeastStretch) {
      OtherSides other{stretch, MatrixD(stretch.frames, 3 * std::ssize(limb))};
      for (Eigen::Index i = 0; i < stretch.frames; ++i) {
        const Eigen::Index t = stretch.first + i;
        const Sides& sides = in_time.at(t, path[static_cast<std::size_t>(t)]);
        for (std::size_t bone = 0; bone < limb.size(); ++bone)
          other.turns.row(i).segment<3>(3 * static_cast<Eigen::Index>(bone)) =
              sides.turn[bone].transpose();
      }
      others.push_back(std::move(other));
    }
    first = std::find_if(end, path.end(), is_other);
  }
  return others;
}

}  // namespace mcdbn
