#include "corpus/corpus_survey.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/interruption.hpp"
#include "base/numbers.hpp"
#include "base/upper_median.hpp"
#include "corpus/joint_map_use.hpp"
#include "corpus/people.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/motion_file.hpp"
#include "motion/body_size.hpp"
#include "motion/resample.hpp"

namespace mcdbn {
namespace {

using enum JointRole;
using Kind = ClipProblem::Kind;

// What is taken for odd. Lengths are those of a body 1.7 m tall.
constexpr double kLeastRate_fps = 20, kLeastLength_s = 1;
/// A joint that is in one frame away from where it is before and after it, faster than any limb is
/// (a kicked foot lands at some 300 m/s²).
constexpr double kSpike_m = 0.03, kSpike_m_s2 = 1000;
constexpr double kJump_m_s = 25;  // a thrown ball's hand comes near it
constexpr double kBelowGround_m = 0.08;
constexpr double kLying_deg = 60;  // of the trunk from +y, on average

/// Frames as people count them, from 1; the first few.
std::string frames_text(const std::vector<Eigen::Index>& frames) {
  constexpr std::size_t kMost = 5;
  std::vector<Eigen::Index> first;
  for (std::size_t i = 0; i < std::min(kMost, frames.size()); ++i) first.push_back(frames[i] + 1);
  return fmt::format("{} frame{}: {}{}", frames.size(), frames.size() == 1 ? "" : "s",
                     fmt::join(first, ", "), frames.size() > kMost ? ", …" : "");
}

/// Where the joints with roles are, in metres. @return [frames x 3·joints]
MatrixD places_m(const Motion& motion, const SkeletonRoles& roles) {
  const MatrixD all = joint_positions(motion) / file_units_per_metre(motion.skeleton);
  std::vector<int> columns;
  for (const JointRole role : joint_roles())
    for (int axis = 0; axis < 3 && roles.has(role); ++axis)
      columns.push_back(3 * roles.joint(role) + axis);
  return all(Eigen::all, columns);
}

double most_by_joint(const RowVectorD& places) {
  double most = 0;
  for (Eigen::Index k = 0; k < places.size(); k += 3)
    most = std::max(most, places.segment<3>(k).norm());
  return most;
}

void add_spikes_and_jumps(const MatrixD& places, double fps, std::vector<ClipProblem>& problems) {
  std::vector<Eigen::Index> spikes, jumps;
  const auto is_spike = [&](Eigen::Index t) {
    if (t < 1 || t + 1 >= places.rows()) return false;
    const double off_m =
        most_by_joint(places.row(t) - 0.5 * (places.row(t - 1) + places.row(t + 1)));
    return off_m > kSpike_m && 2 * off_m * fps * fps > kSpike_m_s2;
  };
  // The frames beside a spike are off the line, too, by half of it.
  for (Eigen::Index t = 1; t < places.rows(); ++t) {
    const double step_m = most_by_joint(places.row(t) - places.row(t - 1));
    const bool returns = t + 1 < places.rows() &&
                         most_by_joint(places.row(t + 1) - places.row(t - 1)) < 0.5 * step_m;
    if (returns && is_spike(t))
      spikes.push_back(t);
    else if (step_m * fps > kJump_m_s && (spikes.empty() || spikes.back() != t - 1))
      jumps.push_back(t);
  }
  if (!spikes.empty())
    problems.push_back({Kind::spikes, "a joint leaps away and back in " + frames_text(spikes)});
  if (!jumps.empty())
    problems.push_back(
        {Kind::jumps, fmt::format("faster than {:g} m/s to {}", kJump_m_s, frames_text(jumps))});
}

/// The ground is where the lowest foot is at its lowest in a usual second.
void add_ground(const Motion& motion, const SkeletonRoles& roles,
                std::vector<ClipProblem>& problems) {
  const MatrixD all = joint_positions(motion) / file_units_per_metre(motion.skeleton);
  const auto second = std::max<Eigen::Index>(1, std::lround(motion.fps()));
  double lowest_m = 0;
  for (const JointRole role : {left_toe, right_toe, left_ankle, right_ankle}) {
    if (!roles.has(role)) continue;
    const Eigen::VectorXd heights = all.col(3 * roles.joint(role) + 1);
    std::vector<double> lows;
    for (Eigen::Index t = 0; t < heights.size(); t += second)
      lows.push_back(heights.segment(t, std::min(second, heights.size() - t)).minCoeff());
    lowest_m = std::min(lowest_m, heights.minCoeff() - upper_median(std::move(lows)));
  }
  if (lowest_m < -kBelowGround_m)
    problems.push_back(
        {Kind::ground,
         fmt::format("a foot goes {:.0f} cm under where it usually stands", -100 * lowest_m)});
}

void add_up(const Motion& motion, const SkeletonRoles& roles, std::vector<ClipProblem>& problems) {
  const MatrixD all = joint_positions(motion);
  const int top = roles.joint(roles.has(head) ? head : neck), bottom = roles.joint(pelvis);
  Eigen::RowVector3d sum(0, 0, 0);
  for (Eigen::Index t = 0; t < all.rows(); ++t)
    sum += (all.row(t).segment<3>(3 * top) - all.row(t).segment<3>(3 * bottom)).normalized();
  const double deg = std::atan2(std::hypot(sum.x(), sum.z()), sum.y()) / kRadiansPerDegree;
  if (deg > kLying_deg)
    problems.push_back(
        {Kind::up, fmt::format("the trunk is {:.0f} degrees from +y: the person lies, or another "
                               "axis is up",
                               deg)});
}

/// Numbers skeletons by the names of their joints.
class SkeletonCount {
 public:
  std::size_t number_of(const Skeleton& skeleton) {
    std::vector<std::string> names;
    for (const Joint& joint : skeleton.joints) names.push_back(joint.name);
    const auto found = std::ranges::find(known_, names);
    const auto number = static_cast<std::size_t>(found - known_.begin()) + 1;
    if (found == known_.end()) known_.push_back(std::move(names));
    return number;
  }

 private:
  std::vector<std::vector<std::string>> known_;
};

/// Counts over several clips.
struct Seen {
  SkeletonCount skeletons;
  PeopleCount people;
  JointMapUse map_use;
};

void describe(Motion motion, const JointMap& joint_map, Seen& seen, SurveyedClip& result) {
  result.frames = motion.frames();
  result.fps = motion.fps();
  result.skeleton = seen.skeletons.number_of(motion.skeleton);
  seen.map_use.add(motion.skeleton);
  if (result.clip.person.empty())
    result.clip.person = fmt::format("body {}", seen.people.number_of(motion.skeleton) + 1);
  if (result.seconds() < kLeastLength_s)
    result.problems.push_back({Kind::length, fmt::format("{:.2g} s long", result.seconds())});
  if (result.fps < kLeastRate_fps)
    result.problems.push_back({Kind::rate, fmt::format("{:.3g} frames a second", result.fps)});
  if (has_leading_calibration_pose(motion)) {
    // By fmt, as GCC 12 takes a plain text that long for a copy beyond its end (-Warray-bounds).
    result.problems.push_back(
        {Kind::first_frame,
         fmt::format("begins with a calibration pose, which {} leaves out", "training")});
    motion = without_first_frame(motion);
  }
  try {
    const HumanoidRig rig = rig_of_person(motion, joint_map);
    result.error = retarget_error(rig, motion);
    for (ClipProblem& problem : motion_problems(motion, rig.roles()))
      result.problems.push_back(std::move(problem));
  } catch (const InputError& error) {
    result.problems.push_back({Kind::no_person, error.what()});
  }
}

}  // namespace

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::unreadable:
      return "unreadable";
    case Kind::no_person:
      return "no_person";
    case Kind::first_frame:
      return "first_frame";
    case Kind::rate:
      return "rate";
    case Kind::length:
      return "length";
    case Kind::spikes:
      return "spikes";
    case Kind::jumps:
      return "jumps";
    case Kind::ground:
      return "ground";
    case Kind::up:
      return "up";
  }
  return "";
}

std::vector<ClipProblem> motion_problems(const Motion& motion, const SkeletonRoles& roles) {
  std::vector<ClipProblem> problems;
  add_spikes_and_jumps(places_m(motion, roles), motion.fps(), problems);
  add_ground(motion, roles, problems);
  add_up(motion, roles, problems);
  return problems;
}

std::vector<SurveyedClip> survey(const std::vector<ListedClip>& clips, const JointMap& joint_map,
                                 std::vector<std::string>* notices) {
  std::vector<SurveyedClip> surveyed;
  Seen seen{.skeletons = {}, .people = {}, .map_use = JointMapUse(joint_map)};
  for (const ListedClip& clip : clips) {
    check_interruption();
    SurveyedClip result{clip, 0, 0, 0, {}, {}};
    if (result.clip.person.empty()) result.clip.person = person_of(clip.file);
    if (result.clip.action.empty()) result.clip.action = action_of(clip.file);
    try {
      Motion motion = read_motion(clip.file);
      if (motion.frames() == 0) throw InputError("has no frame");
      describe(std::move(motion), joint_map, seen, result);
    } catch (const InputError& error) {
      result.problems.push_back({Kind::unreadable, error.what()});
    }
    surveyed.push_back(std::move(result));
  }
  if (notices)
    for (std::string& unused : seen.map_use.notices()) notices->push_back(std::move(unused));
  return surveyed;
}

}  // namespace mcdbn
