#include "mcdbn/formats/joint_map.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <toml++/toml.h>

#include <vector>

#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

std::string role_names() {
  std::vector<std::string_view> names;
  for (const JointRole role : joint_roles()) names.push_back(name_of(role));
  return fmt::format("{}", fmt::join(names, ", "));
}

[[noreturn]] void fail(const std::filesystem::path& path, const toml::source_region& source,
                       const std::string& what) {
  throw InputError(fmt::format("{}:{}: {}", path.string(), source.begin.line, what));
}

toml::table parsed(const std::filesystem::path& path) {
  try {
    return toml::parse(read_text_file(path), path.string());
  } catch (const toml::parse_error& error) {
    fail(path, error.source(), "not TOML; give lines such as left_hip = \"LeftUpLeg\"");
  }
}

}  // namespace

JointMap read_joint_map(const std::filesystem::path& path) {
  JointMap map;
  for (const auto& [key, node] : parsed(path)) {
    const auto role = joint_role_of(key.str());
    if (!role)
      fail(path, key.source(),
           fmt::format("no role is called {}; there are: {}", key.str(), role_names()));
    const auto* name = node.as_string();
    if (name == nullptr || name->get().empty())
      fail(path, node.source(), fmt::format("{}: give the name of a joint, in quotes", key.str()));
    map[*role] = name->get();
  }
  if (map.empty())
    throw InputError(
        fmt::format("{}:1: no roles; give lines such as left_hip = \"LeftUpLeg\"", path.string()));
  return map;
}

}  // namespace mcdbn
