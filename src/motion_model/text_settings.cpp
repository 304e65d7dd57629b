#include "motion_model/text_settings.hpp"

#include <fmt/format.h>

#include <string_view>

#include "base/shown.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/motion/joint_role.hpp"

namespace mcdbn {
namespace {

constexpr std::string_view kSkeleton = "skeleton", kJointMap = "joint-map.";
constexpr const char *kOwn = "own", *kCanonical = "canonical";

[[noreturn]] void reject(const GivenSetting& given, const char* kind) {
  throw ConfigError(
      fmt::format("{} must be {}, not {}", printable_line(given.who), kind, given.value.dump()));
}

SkeletonUse skeleton_use_of(const GivenSetting& given) {
  if (given.value == kOwn) return SkeletonUse::own;
  if (given.value == kCanonical) return SkeletonUse::humanoid;
  reject(given, R"("own" or "canonical")");
}

}  // namespace

std::vector<std::pair<std::string, std::string>> text_settings(const TrainingConfig& config) {
  std::vector<std::pair<std::string, std::string>> texts;
  if (config.skeleton != SkeletonUse::shared)
    texts.emplace_back(kSkeleton, config.skeleton == SkeletonUse::own ? kOwn : kCanonical);
  for (const auto& [role, joint] : config.joint_map)
    texts.emplace_back(fmt::format("{}{}", kJointMap, name_of(role)), joint);
  return texts;
}

bool assign_text_setting(TrainingConfig& config, const GivenSetting& given) {
  if (given.name == kSkeleton) {
    config.skeleton = skeleton_use_of(given);
    return true;
  }
  if (!given.name.starts_with(kJointMap)) return false;
  const auto role = joint_role_of(given.name.substr(kJointMap.size()));
  if (!role) throw ConfigError(fmt::format("{} is no role of a joint", printable_line(given.who)));
  if (!given.value.is_string() || given.value.get<std::string>().empty())
    reject(given, "the name of a joint");
  config.joint_map[*role] = given.value.get<std::string>();
  return true;
}

}  // namespace mcdbn
