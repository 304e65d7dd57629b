#include "mcdbn/corpus/training_clips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/made_ahead.hpp"
#include "base/named_errors.hpp"
#include "base/utf8.hpp"
#include "corpus/clip_cache.hpp"
#include "corpus/clip_notices.hpp"
#include "corpus/joint_map_use.hpp"
#include "corpus/people.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/humanoid_rig.hpp"
#include "mcdbn/motion/retarget_error.hpp"

namespace mcdbn {
namespace {

/// In words, the first clip whose skeleton lacks a joint of the first one's.
class OddOne {
 public:
  void add(const std::string& path, const Skeleton& skeleton) {
    if (!first_) {
      first_ = skeleton;
      first_path_ = path;
    }
    for (const Joint& joint : first_->joints)
      if (!text_ && skeleton.find(joint.name) < 0)
        text_ = fmt::format("{} lacks the joint {} of {}", path, joint.name, first_path_);
  }
  const std::optional<std::string>& text() const { return text_; }

 private:
  std::optional<Skeleton> first_;
  std::string first_path_;
  std::optional<std::string> text_;
};

/// Errors of a corpus on the humanoid, in words.
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

/// Checks, before anything is trained, that the names which a model records are UTF-8.
void check_names(const LoadedClip& clip) {
  for (const Joint& joint : clip.motion.skeleton.joints)
    require_utf8(joint.name, fmt::format("{}: the joint name {}", clip.clip.path, joint.name));
}

/// A clip that is being read, and the notices about it.
struct Brought {
  LoadedClip clip;
  ClipNotices notices;
  Skeleton was = {};  ///< before it was brought onto the humanoid
  std::optional<RetargetError> error = {};
};

Brought read_clip(const ListedClip& listed, const CorpusSettings& settings) {
  Brought read;
  read.clip = load_clip_as_is(listed.file, settings.keep_first_frame, read.notices);
  read.clip.clip.person = listed.person;
  read.clip.clip.action = listed.action;
  check_names(read.clip);
  return read;
}

Brought onto_humanoid(Brought brought, const CorpusSettings& settings) {
  brought.was = brought.clip.motion.skeleton;
  if (is_humanoid(brought.was)) return brought;
  with_name(brought.clip.clip.path, [&] {
    const HumanoidRig rig = rig_of_person(brought.clip.motion, settings.joint_map);
    brought.error = retarget_error(rig, brought.clip.motion);
    brought.clip.motion = rig.to_humanoid(brought.clip.motion);
  });
  return brought;
}

/// Clips that are made by several threads, each by itself, and taken in order.
template <typename Make, typename Take>
void for_each_clip(std::size_t count, const Make& make, const Take& take) {
  MadeAhead<Brought> made(make, 0, count, usual_threads(), 2 * usual_threads());
  for (std::size_t i = 0; i < count; ++i) take(made.next());
}

/// Distinguishes people by the skeletons' own bones: on the humanoid those of one person may differ
/// slightly.
class HumanoidClips {
 public:
  LoadedClip taken(Brought brought) {
    std::string& person = brought.clip.clip.person;
    if (person.empty()) person = fmt::format("person {}", people_.number_of(brought.was));
    if (brought.error) losses_.add(brought.clip.clip.path, *brought.error);
    return std::move(brought.clip);
  }
  std::string text() const { return losses_.text(); }

 private:
  PeopleCount people_;
  Losses losses_;
};

/// Where clips go one after another, in order.
struct ClipSink {
  std::function<void(LoadedClip)> add;
  /// @param are_final whether they are the clips that a later program may take as they are
  std::function<ClipStore(bool are_final)> finish;
};
using MakeSink = std::function<ClipSink()>;

ClipSink into_memory() {
  const auto clips = std::make_shared<std::vector<LoadedClip>>();
  return {[clips](LoadedClip clip) { clips->push_back(std::move(clip)); },
          [clips](bool) { return ClipStore(std::move(*clips)); }};
}

ClipSink into_file(const std::filesystem::path& path, const std::string& key) {
  const auto writer = std::make_shared<ClipCacheWriter>(path, key);
  return {[writer](const LoadedClip& clip) { writer->add(clip); },
          [writer](bool are_final) {
            return are_final ? writer->finish() : writer->finish_without_place();
          }};
}

LoadedClip clip_of(const ClipStore& clips, std::size_t i) {
  const ClipRecord& record = clips.record(i);
  return {record.clip, clips.motion(i)};
}

/// Reads clips and brings them where they are to be, onto the humanoid too if they are to be there.
ClipStore read_clips(const std::vector<ListedClip>& files, const CorpusSettings& settings,
                     std::vector<std::string>* notices, const MakeSink& make_sink) {
  const bool any_humanoid = settings.augment.new_poses() || !settings.joint_map.empty();
  if (settings.skeleton == SkeletonUse::own && any_humanoid)
    throw ConfigError(
        "`augment.limbs-exchanged`, `augment.limbs-turned`, `augment.arms-anywhere`, "
        "`augment.leaning`, `augment.turning-round` and joint maps are of the canonical humanoid; "
        "leave the skeletons' own out");
  const bool humanoid = settings.skeleton == SkeletonUse::humanoid || any_humanoid;
  const auto add_notice = [&](const std::string& text) {
    if (notices) notices->push_back(text);
  };
  HumanoidClips on_humanoid;
  OddOne odd;
  JointMapUse map_use(settings.joint_map);
  ClipNotices of_files;
  const auto into = [&](ClipSink& sink, Brought brought, bool brings) {
    sink.add(brings ? on_humanoid.taken(std::move(brought)) : std::move(brought.clip));
  };
  ClipSink sink = make_sink();
  for_each_clip(
      files.size(),
      [&](std::size_t i) {
        Brought read = read_clip(files[i], settings);
        return humanoid ? onto_humanoid(std::move(read), settings) : read;
      },
      [&](Brought brought) {
        of_files.add(brought.notices);
        const Skeleton& own = humanoid ? brought.was : brought.clip.motion.skeleton;
        odd.add(brought.clip.clip.path, own);
        map_use.add(own);
        into(sink, std::move(brought), humanoid);
      });
  if (notices) of_files.append_to(*notices);
  for (const std::string& unused : map_use.notices()) add_notice(unused);
  if (settings.skeleton == SkeletonUse::own && odd.text())
    throw InputError(*odd.text() + "; or train on the canonical humanoid");
  if (odd.text())
    add_notice(fmt::format("skeletons differ, so the humanoid's is learnt: {}", *odd.text()));
  const bool brought_later = !humanoid && odd.text();
  ClipStore clips = sink.finish(!brought_later);
  if (brought_later) {
    ClipSink second = make_sink();
    for_each_clip(
        clips.count(),
        [&](std::size_t i) {
          return onto_humanoid({clip_of(clips, i), {}}, settings);
        },
        [&](Brought brought) { into(second, std::move(brought), true); });
    clips = second.finish(true);
  }
  if (humanoid || odd.text()) add_notice(on_humanoid.text());
  return clips;
}

/// The cache's key: all that it depends on besides the files' contents.
std::string cache_key(const std::vector<ListedClip>& files, const CorpusSettings& settings) {
  nlohmann::json key = {{"version", 3},
                        {"keep_first_frame", settings.keep_first_frame},
                        {"skeleton", static_cast<int>(settings.skeleton)},
                        {"new_poses", settings.augment.new_poses()},
                        {"joint_map", nlohmann::json::object()},
                        {"clips", nlohmann::json::array()}};
  for (const auto& [role, joint] : settings.joint_map)
    key["joint_map"][std::string(name_of(role))] = joint;
  for (const ListedClip& listed : files)
    key["clips"].push_back({std::filesystem::absolute(listed.file).lexically_normal().string(),
                            listed.person, listed.action});
  return key.dump();
}

/// @throws InputError if a file is another than when the clips were read, or is gone
void check_files(const ClipStore& clips, const std::filesystem::path& cache) {
  MadeAhead<TrainingClip> now(
      [&](std::size_t i) { return identify_clip(clips.record(i).clip.path); }, 0, clips.count(),
      usual_threads(), 2 * usual_threads());
  for (const ClipRecord& record : clips.records())
    if (now.next().fingerprint != record.clip.fingerprint)
      throw InputError(fmt::format("{}: {} has changed since", cache.string(), record.clip.path));
}

}  // namespace

std::vector<LoadedClip> load_training_clips(const std::vector<ListedClip>& files,
                                            const CorpusSettings& settings,
                                            std::vector<std::string>* notices) {
  const ClipStore clips = read_clips(files, settings, notices, into_memory);
  std::vector<LoadedClip> loaded;
  for (std::size_t i = 0; i < clips.count(); ++i) loaded.push_back(clip_of(clips, i));
  return loaded;
}

ClipStore cached_training_clips(const std::vector<ListedClip>& files,
                                const CorpusSettings& settings, const std::filesystem::path& cache,
                                std::vector<std::string>* notices) {
  const std::string key = cache_key(files, settings);
  if (std::filesystem::exists(cache)) {
    try {
      ClipStore clips = open_clip_cache(cache, key);
      check_files(clips, cache);
      return clips;
    } catch (const InputError& error) {
      if (notices) notices->push_back(fmt::format("{}; the clips are read again", error.what()));
    }
  }
  return read_clips(files, settings, notices, [&] { return into_file(cache, key); });
}

Motion for_skeleton(Motion clip, const Skeleton& model, const JointMap& joint_map) {
  if (!is_humanoid(model) || is_humanoid(clip.skeleton)) return clip;
  return rig_of_person(clip, joint_map).to_humanoid(clip);
}

}  // namespace mcdbn
