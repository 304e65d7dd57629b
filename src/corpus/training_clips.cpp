#include "mcdbn/corpus/training_clips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/interruption.hpp"
#include "base/utf8.hpp"
#include "corpus/people.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/humanoid_rig.hpp"

namespace mcdbn {
namespace {

/// In words, the first clip whose skeleton lacks a joint of the first one's.
std::optional<std::string> odd_one(const std::vector<LoadedClip>& clips) {
  const Skeleton& first = clips.front().motion.skeleton;
  for (const LoadedClip& clip : clips)
    for (const Joint& joint : first.joints)
      if (clip.motion.skeleton.find(joint.name) < 0)
        return fmt::format("{} lacks the joint {} of {}", clip.clip.path, joint.name,
                           clips.front().clip.path);
  return {};
}

/// What of a corpus is lost on the humanoid, in words.
class Losses {
 public:
  void add(const std::string& file, const RetargetError& error) {
    sum_deg_ += error.mean_deg();
    sum_mm_ += error.mean_mm();
    ++clips_;
    if (error.worst_placed().worst_mm <= worst_mm_) return;
    worst_mm_ = error.worst_placed().worst_mm;
    worst_ = fmt::format("{} of {}", error.worst_placed().name, file);
  }

  std::string text() const {
    const double count = std::max(1, clips_);
    return fmt::format(
        "{} clips brought onto the canonical humanoid; there and back they are {:.2f} degrees and "
        "{:.1f} mm off on average{}",
        clips_, sum_deg_ / count, sum_mm_ / count,
        worst_.empty() ? "" : fmt::format(", {:.0f} mm at most ({})", worst_mm_, worst_));
  }

 private:
  double sum_deg_ = 0, sum_mm_ = 0, worst_mm_ = 0;
  int clips_ = 0;
  std::string worst_;
};

void bring_onto_humanoid(std::vector<LoadedClip>& clips, std::vector<std::string>* notices) {
  PeopleCount people;
  Losses losses;
  for (LoadedClip& clip : clips) {
    check_interruption();
    // By the skeleton's own bones; on the humanoid those of one person may differ by a hair.
    if (clip.person.empty())
      clip.person = fmt::format("person {}", people.number_of(clip.motion.skeleton));
    if (is_humanoid(clip.motion.skeleton)) continue;
    try {
      const HumanoidRig rig = rig_of_person(clip.motion);
      if (notices) losses.add(clip.clip.path, retarget_error(rig, clip.motion));
      clip.motion = rig.to_humanoid(clip.motion);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", clip.clip.path, error.what()));
    }
  }
  if (notices) notices->push_back(losses.text());
}

}  // namespace

namespace {

/// What a model records is text, and known to be before anything is trained.
void check_names(const LoadedClip& clip) {
  for (const Joint& joint : clip.motion.skeleton.joints)
    require_utf8(joint.name, fmt::format("{}: the joint name {}", clip.clip.path, joint.name));
}

}  // namespace

std::vector<LoadedClip> load_training_clips(const std::vector<ListedClip>& files,
                                            const CorpusSettings& settings,
                                            std::vector<std::string>* notices) {
  if (settings.skeleton == SkeletonUse::own && settings.augment.new_poses())
    throw ConfigError(
        "`augment.limbs-exchanged`, `augment.limbs-turned`, `augment.arms-anywhere`, "
        "`augment.leaning` and `augment.turning-round` are of the canonical humanoid; leave the "
        "skeletons' own out");
  std::vector<std::filesystem::path> paths;
  paths.reserve(files.size());
  for (const ListedClip& listed : files) paths.push_back(listed.file);
  std::vector<LoadedClip> clips = load_clips(paths, settings.keep_first_frame, notices);
  for (std::size_t i = 0; i < clips.size(); ++i) {
    clips[i].person = files[i].person;
    clips[i].action = files[i].action;
    check_names(clips[i]);
  }
  const auto odd = odd_one(clips);
  if (settings.skeleton == SkeletonUse::own && odd)
    throw InputError(*odd + "; or train on the canonical humanoid");
  if (odd && notices)
    notices->push_back(fmt::format("skeletons differ, so the humanoid's is learnt: {}", *odd));
  if (odd || settings.skeleton == SkeletonUse::humanoid || settings.augment.new_poses())
    bring_onto_humanoid(clips, notices);
  return clips;
}

Motion for_skeleton(Motion clip, const Skeleton& model) {
  if (!is_humanoid(model) || is_humanoid(clip.skeleton)) return clip;
  return rig_of_person(clip).to_humanoid(clip);
}

}  // namespace mcdbn
