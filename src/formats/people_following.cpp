#include "formats/people_following.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/interruption.hpp"
#include "formats/assignment.hpp"
#include "formats/person_box.hpp"

namespace mcdbn {
namespace {

using Point = Eigen::Vector2d;
using Frames = std::vector<std::vector<SeenPerson>>;

/// How far a body may be from where it is expected, as a share of its box's diagonal.
constexpr double kReach = 0.5;
constexpr double kReachGrowth = 0.05;  // with every frame unseen
constexpr double kFarthestReach = 1.0;
constexpr double kForbidden = 1e6;
constexpr double kSpeedMemory = 0.7;
constexpr int kFewJoints = 3;
constexpr double kOverlapWeight = 0.5, kJointWeight = 0.5;
/// A body that was found in parts is the one known before, not the new part.
constexpr double kYouth = 0.3;
constexpr std::size_t kFewFrames = 5;

double overlap(const PersonBox& a, const PersonBox& b) {
  const Point extent =
      (a.most.cwiseMin(b.most) - a.least.cwiseMax(b.least)).cwiseMax(Point::Zero());
  const double both = extent.prod(), either = a.area() + b.area() - both;
  return either > 0 ? both / either : 0.0;
}

class Follower {
 public:
  Follower(const Frames& frames, int patience) : frames_(frames), patience_(patience) {}

  std::vector<Followed> run() {
    for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
      check_interruption();
      add_frame(static_cast<int>(frame));
    }
    std::vector<Followed> people;
    people.reserve(paths_.size());
    for (Path& path : paths_) people.push_back(std::move(path.seen));
    return people;
  }

 private:
  struct Path {
    Followed seen;
    int last_frame;
    SeenPerson pose;   ///< where each joint was seen last, moved along with the body since then
    Point step{0, 0};  ///< a frame
  };

  void add_frame(int frame) {
    const auto& people = frames_[frame];
    std::vector<std::size_t> awaited;
    for (std::size_t i = 0; i < paths_.size(); ++i)
      if (frame - paths_[i].last_frame <= patience_) awaited.push_back(i);
    std::vector<bool> known(people.size(), false);
    if (!awaited.empty() && !people.empty()) {
      MatrixD costs(static_cast<Eigen::Index>(awaited.size()),
                    static_cast<Eigen::Index>(people.size()));
      for (Eigen::Index i = 0; i < costs.rows(); ++i) {
        check_interruption();
        for (Eigen::Index k = 0; k < costs.cols(); ++k)
          costs(i, k) = cost(paths_[awaited[i]], people[k], frame);
      }
      const std::vector<int> person_of = cheapest_assignment(costs);
      for (std::size_t i = 0; i < awaited.size(); ++i) {
        const int person = person_of[i];
        if (person < 0 || costs(static_cast<Eigen::Index>(i), person) >= kForbidden) continue;
        extend(paths_[awaited[i]], frame, person);
        known[person] = true;
      }
    }
    for (std::size_t person = 0; person < people.size(); ++person) {
      if (known[person]) continue;
      paths_.push_back({{{frame, static_cast<int>(person)}}, frame, people[person]});
    }
  }

  void extend(Path& path, int frame, int person) const {
    const SeenPerson& seen = frames_[frame][person];
    const int gap = frame - path.last_frame;
    const Point moved = mean_step(path.pose, seen);
    path.step = kSpeedMemory * path.step + (1 - kSpeedMemory) * moved / gap;
    for (std::size_t joint = 0; joint < seen.x_px.size(); ++joint) {
      const bool visible = seen.confidence[joint] > 0;
      path.pose.x_px[joint] = visible ? seen.x_px[joint] : path.pose.x_px[joint] + moved.x();
      path.pose.y_px[joint] = visible ? seen.y_px[joint] : path.pose.y_px[joint] + moved.y();
      if (visible) path.pose.confidence[joint] = seen.confidence[joint];
    }
    path.seen.push_back({frame, person});
    path.last_frame = frame;
  }

  /// Mean step of the joints that both show; without any, the step of the boxes' centres.
  static Point mean_step(const SeenPerson& from, const SeenPerson& to) {
    Point sum(0, 0);
    int common = 0;
    for (std::size_t joint = 0; joint < to.x_px.size(); ++joint) {
      if (!(to.confidence[joint] > 0) || !(from.confidence[joint] > 0)) continue;
      sum += Point(to.x_px[joint] - from.x_px[joint], to.y_px[joint] - from.y_px[joint]);
      ++common;
    }
    return common > 0 ? Point(sum / common) : box_of(to).centre() - box_of(from).centre();
  }

  static double cost(const Path& path, const SeenPerson& candidate, int frame) {
    const int gap = frame - path.last_frame;
    const Point moved = path.step * gap;
    PersonBox awaited = box_of(path.pose);
    const PersonBox found = box_of(candidate);
    awaited.least += moved;
    awaited.most += moved;
    const double size = std::max(awaited.diagonal(), found.diagonal());
    if (!(size > 0)) return kForbidden;
    double sum = 0;
    int common = 0, either = 0;
    for (std::size_t joint = 0; joint < candidate.x_px.size(); ++joint) {
      const bool there = candidate.confidence[joint] > 0, known = path.pose.confidence[joint] > 0;
      either += there || known ? 1 : 0;
      if (!there || !known) continue;
      const Point before(path.pose.x_px[joint], path.pose.y_px[joint]);
      sum += (Point(candidate.x_px[joint], candidate.y_px[joint]) - before - moved).norm();
      ++common;
    }
    const double distance =
        (common >= kFewJoints ? sum / common : (found.centre() - awaited.centre()).norm()) / size;
    if (!(distance <= std::min(kReach + kReachGrowth * (gap - 1), kFarthestReach)))
      return kForbidden;
    return distance + kOverlapWeight * (1 - overlap(awaited, found)) +
           kJointWeight * (1 - static_cast<double>(common) / either) +
           (path.seen.size() < kFewFrames ? kYouth : 0.0);
  }

  const Frames& frames_;
  int patience_;
  std::vector<Path> paths_;
};

/// Whether the file's own numbers distinguish people.
bool numbered(const Frames& frames) {
  bool any = false;
  std::size_t most = 0;
  std::set<long long> all;
  for (const auto& people : frames) {
    std::set<long long> here;
    most = std::max(most, people.size());
    for (const SeenPerson& person : people) {
      if (!person.id || *person.id < 0 || !here.insert(*person.id).second) return false;
      all.insert(*person.id);
      any = true;
    }
  }
  // One number for all may stand for "no number" in the tool: harmless where there is one person.
  return any && all.size() >= most;
}

std::vector<Followed> by_number(const Frames& frames) {
  std::map<long long, Followed> people;
  for (std::size_t frame = 0; frame < frames.size(); ++frame)
    for (std::size_t person = 0; person < frames[frame].size(); ++person)
      people[*frames[frame][person].id].push_back(
          {static_cast<int>(frame), static_cast<int>(person)});
  std::vector<Followed> result;
  result.reserve(people.size());
  for (auto& [id, followed] : people) result.push_back(std::move(followed));
  return result;
}

double size_of(const Followed& followed, const Frames& frames) {
  double sum = 0;
  for (const auto& [frame, person] : followed) sum += box_of(frames[frame][person]).area();
  return sum;
}

}  // namespace

std::vector<Followed> follow_people(const Frames& frames, int patience) {
  std::vector<Followed> people =
      numbered(frames) ? by_number(frames) : Follower(frames, patience).run();
  std::vector<double> sizes;
  sizes.reserve(people.size());
  for (const Followed& followed : people) sizes.push_back(size_of(followed, frames));
  std::vector<std::size_t> order(people.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return sizes[i]; });
  std::vector<Followed> sorted;
  sorted.reserve(order.size());
  for (const std::size_t i : order) sorted.push_back(std::move(people[i]));
  return sorted;
}

}  // namespace mcdbn
