#include "mcdbn/corpus/clip_list.hpp"

#include <doctest/doctest.h>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
namespace fs = std::filesystem;

TEST_CASE("a list of clips: what was written is read, from wherever it is read") {
  const test::ScratchFolder folder;
  make_folder(folder / "clips/a");
  make_folder(folder / "lists");
  const fs::path walk = folder.write("clips/walk.bvh", "x"),
                 odd = folder.write("clips/a/odd \"name\".bvh", "x");
  const fs::path list = folder / "lists/corpus.toml";
  write_clip_list(list, {{walk, "ann", "walk"}, odd});
  CHECK(read_text_file(list).find("../clips/walk.bvh") != std::string::npos);
  CHECK(read_text_file(list).find((folder / "clips").string()) == std::string::npos);
  const auto clips = read_clip_list(list);
  REQUIRE(clips.size() == 2);
  CHECK(fs::equivalent(clips[0].file, walk));
  CHECK(clips[0].person == "ann");
  CHECK(clips[0].action == "walk");
  CHECK(fs::equivalent(clips[1].file, odd));
  CHECK(clips[1].person.empty());
  // Beside folders and files, each clip once.
  const auto all = find_listed_clips({list, folder / "clips", walk});
  REQUIRE(all.size() == 2);
  CHECK(all[0].person == "ann");
  CHECK_THROWS_AS(find_listed_clips({}), InputError);
}

TEST_CASE("a list of clips: what it says of a clip holds wherever else the clip is named") {
  const test::ScratchFolder folder;
  make_folder(folder / "clips");
  const fs::path walk = folder.write("clips/a.bvh", "x"), run = folder.write("clips/b.bvh", "x"),
                 people = folder / "people.toml", actions = folder / "actions.toml";
  write_clip_list(people, {{walk, "ann"}, {run, "bob"}});
  write_clip_list(actions, {{walk, "", "walk"}, {run, "bob", "run"}});
  for (const std::vector<fs::path>& paths :
       std::vector<std::vector<fs::path>>{{folder / "clips", people, actions},
                                          {people, folder / "clips", actions},
                                          {actions, people, folder / "clips"}}) {
    const auto clips = find_listed_clips(paths);
    REQUIRE(clips.size() == 2);
    CHECK(clips[0].person == "ann");
    CHECK(clips[0].action == "walk");
    CHECK(clips[1].person == "bob");
    CHECK(clips[1].action == "run");
  }
  const fs::path other = folder / "other.toml";
  write_clip_list(other, {{walk, "eve"}});
  CHECK_THROWS_WITH_AS(find_listed_clips({people, other}),
                       doctest::Contains("a.bvh: its person is given as 'ann' and as 'eve'"),
                       InputError);
}

TEST_CASE("a list of clips: what is wrong is reported with its line") {
  const test::ScratchFolder folder;
  const fs::path walk = folder.write("walk.bvh", "x");
  const auto refused = [&](const std::string& text, const std::string& what) {
    const fs::path list = folder.write("list.toml", text);
    CHECK_THROWS_WITH_AS(read_clip_list(list), doctest::Contains((list.string() + what).c_str()),
                         InputError);
  };
  refused("[[clip]\n", ":1: not TOML");
  refused("", ":1: no clips");
  refused("clip = 3\n", ":1: no list of clips");
  refused("[[clips]]\nfile = \"walk.bvh\"\n", ":1: no list of clips");
  refused("[[clip]]\nfile = \"walk.bvh\"\nwho = \"ann\"\n", ":3: no key 'who'");
  refused("[[clip]]\nfile = 3\n", ":2: file: give a text");
  refused("[[clip]]\nfile = \"walk.bvh\"\nperson = \"\"\n", ":3: person: give a text");
  refused("[[clip]]\nperson = \"ann\"\n", ":1: a clip without file");
  refused("# one\n[[clip]]\nfile = \"none.bvh\"\n", ":2: ");
}
