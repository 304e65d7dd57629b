#include "mcdbn/formats/joint_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "base/shown.hpp"
#include "formats/toml_texts.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

constexpr const char* kExample = "give lines such as left_hip = \"LeftUpLeg\"";

std::string role_names() {
  std::vector<std::string_view> names;
  for (const JointRole role : joint_roles()) names.push_back(name_of(role));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

JointMap read_joint_map(const std::filesystem::path& path) {
  JointMap map;
  for (const auto& [key, node] : read_toml(path, kExample)) {
    const auto role = joint_role_of(key.str());
    if (!role)
      fail_at(path, key.source(),
              fmt::format("no role is called {}; there are: {}", shown(key.str()), role_names()));
    map[*role] = text_of(path, key.str(), node, "the name of a joint");
  }
  if (map.empty()) throw InputError(fmt::format("{}:1: no roles; {}", path.string(), kExample));
  return map;
}

}  // namespace mcdbn
