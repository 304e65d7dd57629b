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
/// Of numbers, another pair fits as well if its cost is greater by less than this.
constexpr double kClearly = 0.2;

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

double overlap(const PersonBox& a, const PersonBox& b) {
  const Point extent =
      (a.most.cwiseMin(b.most) - a.least.cwiseMax(b.least)).cwiseMax(Point::Zero());
  const double both = extent.prod(), either = a.area() + b.area() - both;
  return either > 0 ? both / either : 0.0;
}

class Follower {
 public:
  Follower(const Frames& frames, int patience)
      : frames_(frames), patience_(patience), numbered_(numbered(frames)) {
    if (!numbered_) return;
    for (std::size_t frame = 0; frame < frames.size(); ++frame)
      for (const SeenPerson& person : frames[frame])
        last_frame_of_[*person.id] = static_cast<int>(frame);
  }

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
    const std::vector<int> unknown = extend_by_number(frame);
    if (unknown.empty()) return;
    const std::vector<std::size_t> awaited = awaited_in(frame);
    MatrixD costs(static_cast<Eigen::Index>(awaited.size()),
                  static_cast<Eigen::Index>(unknown.size()));
    for (Eigen::Index i = 0; i < costs.rows(); ++i) {
      check_interruption();
      for (Eigen::Index k = 0; k < costs.cols(); ++k)
        costs(i, k) = cost(paths_[awaited[i]], frames_[frame][unknown[k]], frame);
    }
    const std::vector<int> unknown_of = cheapest_assignment(costs);
    std::vector<bool> found(unknown.size(), false);
    for (std::size_t i = 0; i < awaited.size(); ++i) {
      const int k = unknown_of[i];
      if (k < 0 || !fits(costs, static_cast<Eigen::Index>(i), k)) continue;
      extend(paths_[awaited[i]], frame, unknown[k]);
      found[k] = true;
      set_path(frame, unknown[k], awaited[i]);
    }
    for (std::size_t k = 0; k < unknown.size(); ++k) {
      if (found[k]) continue;
      set_path(frame, unknown[k], paths_.size());
      paths_.push_back({{{frame, unknown[k]}}, frame, frames_[frame][unknown[k]]});
    }
  }

  /// @return those of the frame whom no number makes known
  std::vector<int> extend_by_number(int frame) {
    std::vector<int> unknown;
    for (int person = 0; person < std::ssize(frames_[frame]); ++person) {
      const auto path = numbered_ ? path_of_.find(number_of(frame, person)) : path_of_.end();
      if (path == path_of_.end())
        unknown.push_back(person);
      else
        extend(paths_[path->second], frame, person);
    }
    return unknown;
  }

  /// Paths that may go on in a frame: of numbers, those whose number is seen no more.
  std::vector<std::size_t> awaited_in(int frame) const {
    std::vector<std::size_t> awaited;
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      const auto [last_frame, person] = paths_[i].seen.back();
      if (frame - last_frame > patience_) continue;
      if (numbered_ && last_frame_of_.at(number_of(last_frame, person)) >= frame) continue;
      awaited.push_back(i);
    }
    return awaited;
  }

  /// Whether a pair is near enough to be one person. A tracker may have had a reason for a new
  /// number: then neither of the two may fit another one as well.
  bool fits(const MatrixD& costs, Eigen::Index path, Eigen::Index person) const {
    const double cost = costs(path, person);
    if (cost >= kForbidden) return false;
    const double as_well = cost + kClearly;
    return !numbered_ || ((costs.row(path).array() < as_well).count() == 1 &&
                          (costs.col(person).array() < as_well).count() == 1);
  }

  void set_path(int frame, int person, std::size_t path) {
    if (numbered_) path_of_[number_of(frame, person)] = path;
  }

  long long number_of(int frame, int person) const { return *frames_[frame][person].id; }

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
  bool numbered_;
  std::map<long long, int> last_frame_of_;    ///< by the file's number
  std::map<long long, std::size_t> path_of_;  ///< by the file's number, of those seen so far
  std::vector<Path> paths_;
};

double size_of(const Followed& followed, const Frames& frames) {
  double sum = 0;
  for (const auto& [frame, person] : followed) sum += box_of(frames[frame][person]).area();
  return sum;
}

}  // namespace

std::vector<Followed> follow_people(const Frames& frames, int patience) {
  std::vector<Followed> people = Follower(frames, patience).run();
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

std::vector<NumberChange> number_changes(const Frames& frames,
                                         const std::vector<Followed>& people) {
  std::vector<NumberChange> changes;
  if (!numbered(frames)) return changes;
  for (const Followed& followed : people)
    for (std::size_t i = 1; i < followed.size(); ++i) {
      const auto [frame_before, person_before] = followed[i - 1];
      const auto [frame, person] = followed[i];
      const long long before = *frames[frame_before][person_before].id;
      const long long after = *frames[frame][person].id;
      if (before != after) changes.push_back({before, after, frame});
    }
  return changes;
}

}  // namespace mcdbn
