#include "corpus/pose_pool.hpp"

#include <algorithm>
#include <utility>

#include "base/interruption.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/resample.hpp"
#include "motion/rig_axes.hpp"

namespace mcdbn {
namespace {

const Eigen::Vector3d kMirror(-1, 1, 1);

/// The rotation seen in a mirror.
Eigen::Matrix3d mirrored(const Eigen::Matrix3d& rotation) {
  return kMirror.asDiagonal() * rotation * kMirror.asDiagonal();
}

/// Frame t of a clip that is played to its end and back, again and again.
int there_and_back(int t, int frames) {
  if (frames == 1) return 0;
  const int period = 2 * (frames - 1), at = t % period;
  return at < frames ? at : period - at;
}

}  // namespace

PosePool::PosePool(ClipStore clips, double fps, const PeopleChoice& people)
    : clips_(std::move(clips)), fps_(fps) {
  for (const ClipRecord& record : clips_.records())
    if (!is_humanoid(record.skeleton))
      throw ConfigError(
          "limbs that are exchanged or turned are the canonical humanoid's; train on that");
  constexpr double kMostFrames = 20'000;
  const ClipGroups groups(clips_);
  double frames = 0;
  for (std::size_t i = 0; i < clips_.count(); ++i) {
    if (!people.holds(groups.people()[i])) continue;
    taken_.push_back(i);
    frames += clips_.record(i).frames;
  }
  std::array<std::vector<Eigen::Matrix3d>, kJointRoleCount> seen;
  for (const std::size_t i : taken_) {
    check_interruption();
    const double share = std::min(1.0, kMostFrames / frames);
    Motion clip = clips_.motion(i);
    clip.channels =
        clip.channels(spread_frames(clip, std::max(1, static_cast<int>(share * clip.frames()))),
                      Eigen::all)
            .eval();
    const HumanoidPoses poses(clip);
    for (const JointRole role : joint_roles())
      for (int t = 0; t < poses.frames(); ++t) {
        const Eigen::Matrix3d& local = poses.local(t, role);
        seen[static_cast<std::size_t>(role)].push_back(local);
        seen[static_cast<std::size_t>(other_side(role))].push_back(mirrored(local));
      }
  }
  for (std::size_t role = 0; role < seen.size(); ++role)
    limits_[role] = JointLimits::of(seen[role]);
}

HumanoidPoses PosePool::piece(std::size_t clip, double from, int frames) const {
  const ClipRecord& whole = clips_.record(taken_[clip]);
  const double fps = 1 / whole.frame_time_s;
  // Only what is needed is resampled; its low-pass looks at what is around.
  constexpr double kAround_s = 0.5;
  const double step = fps / fps_, around = kAround_s * fps;
  const double first = from * std::max(0.0, whole.frames - 1 - frames * step);
  const int begin = std::max(0, static_cast<int>(first - around));
  const int end = std::min(whole.frames, static_cast<int>(first + frames * step + around) + 2);
  Motion part = resample(clips_.piece(taken_[clip], begin, end - begin), fps_);
  const int skipped = static_cast<int>((first - begin) / step);
  const int left = part.frames() - skipped;
  std::vector<int> rows;
  rows.reserve(static_cast<std::size_t>(frames));
  for (int t = 0; t < frames; ++t) rows.push_back(skipped + there_and_back(t, left));
  part.channels = part.channels(rows, Eigen::all).eval();
  return HumanoidPoses(part);
}

std::shared_ptr<const PosePool> pose_pool_for(const ClipStore& clips,
                                              const CorpusSettings& settings,
                                              const PeopleChoice& people) {
  if (!settings.augment.new_poses()) return {};
  return std::make_shared<PosePool>(clips, settings.fps, people);
}

}  // namespace mcdbn
