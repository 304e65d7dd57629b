#include "mcdbn/motion/joint_role.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

using namespace mcdbn;

TEST_CASE("joint roles: every name is its role's alone, and has its side") {
  std::set<std::string_view> names;
  for (const JointRole role : joint_roles()) {
    const std::string_view name = name_of(role);
    CAPTURE(std::string(name));
    CHECK(names.insert(name).second);
    CHECK(joint_role_of(name) == role);

    const std::string_view other = name_of(other_side(role));
    if (name.starts_with("left_"))
      CHECK(std::string(other) == "right_" + std::string(name.substr(5)));
    else if (!name.starts_with("right_"))
      CHECK(other == name);
    CHECK(other_side(other_side(role)) == role);
  }
  CHECK(names.size() == 23);
  CHECK_FALSE(joint_role_of("tail"));
}
