#include "mcdbn/corpus/training_clip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text_file.hpp"
#include "base/user_cache.hpp"
#include "mcdbn/formats/motion_file.hpp"

namespace fs = std::filesystem;

namespace mcdbn {
namespace {

bool same_clip(const TrainingClip& one, const TrainingClip& other) {
  const auto by_former = [](const TrainingClip& now, const TrainingClip& recorded) {
    return !now.former_fingerprint.empty() && now.former_fingerprint == recorded.fingerprint;
  };
  return one.fingerprint == other.fingerprint || by_former(one, other) || by_former(other, one);
}

}  // namespace

TrainingClip identify_clip(const fs::path& path) {
  return identify_clip(path, read_text_file(path));
}

TrainingClip identify_clip(const fs::path& path, const std::string& bytes) {
  const auto fingerprint = [](const std::string& of) { return fmt::format("{:016x}", fnv1a(of)); };
  std::string name = fs::absolute(path).lexically_normal().string();
  const fs::path skeleton = skeleton_file_of(path);
  if (skeleton.empty()) return {std::move(name), fingerprint(bytes)};
  // A zero, which is in no text, between both.
  return {std::move(name), fingerprint(bytes + '\0' + read_text_file(skeleton)),
          fingerprint(bytes)};
}

bool is_among(const std::vector<TrainingClip>& clips, const TrainingClip& clip) {
  return std::ranges::any_of(clips,
                             [&](const TrainingClip& other) { return same_clip(other, clip); });
}

}  // namespace mcdbn
