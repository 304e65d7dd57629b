#include "mcdbn/formats/joint_map.hpp"

#include <doctest/doctest.h>

#include <string>

#include "base/scratch_folder.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;

namespace {

JointMap map_of(const std::string& text) {
  const test::ScratchFolder scratch;
  return read_joint_map(scratch.write("map.toml", text));
}

std::string error_of(const std::string& text) {
  try {
    map_of(text);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("map.toml"));
  }
  return "none";
}

}  // namespace

TEST_CASE("joint map: a role and a name on each line") {
  const JointMap map =
      map_of("# by hand\nleft_hip = \"thigh (L)\"\r\n\nhead = 'Kopf'\npelvis=\"\\u00fcber\"");
  CHECK(map == JointMap{{JointRole::left_hip, "thigh (L)"},
                        {JointRole::head, "Kopf"},
                        {JointRole::pelvis,
                         "\xc3\xbc"
                         "ber"}});
}

TEST_CASE("joint map: what is wrong is reported with its line") {
  CHECK(error_of("head = \"a\"\nleft_heap = \"b\"")
            .starts_with("map.toml:2: no role is called "
                         "'left_heap'; there are: pelvis, "));
  CHECK(error_of("\n\nhead = 3") == "map.toml:3: head: give the name of a joint, in quotes");
  CHECK(error_of("head = \"\"") == "map.toml:1: head: give the name of a joint, in quotes");
  CHECK(error_of("head = [\"a\"]") == "map.toml:1: head: give the name of a joint, in quotes");
  CHECK(error_of("[head]\nname = \"a\"") ==
        "map.toml:1: head: give the name of a joint, in quotes");
  for (const char* text :
       {"head = \"a\"\nneck = b", "head = \"a\"\nhead = \"b\"", "head = \"a\"\n{"})
    CHECK(error_of(text) == "map.toml:2: not TOML; give lines such as left_hip = \"LeftUpLeg\"");
  CHECK(error_of("# nothing\n").starts_with("map.toml:1: no roles; "));
  CHECK_THROWS_AS(read_joint_map("no/such/map.toml"), InputError);
}
