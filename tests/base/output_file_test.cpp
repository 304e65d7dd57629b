#include "base/output_file.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/base/errors.hpp"

using namespace mcdbn;
namespace fs = std::filesystem;

TEST_CASE("a file is written through links, also to what is not there yet") {
  const test::ScratchFolder folder;
  fs::create_directory(folder / "sub");
  const fs::path file = folder.write("sub/file.txt", "old");
  fs::create_symlink("sub/file.txt", folder / "link.txt");
  fs::create_symlink(folder / "link.txt", folder / "link of a link.txt");
  fs::create_symlink("new.txt", folder / "sub/ahead.txt");
  write_text_file(folder / "link of a link.txt", "new");
  CHECK(read_text_file(file) == "new");
  CHECK(fs::is_symlink(folder / "link of a link.txt"));
  CHECK(fs::is_symlink(folder / "link.txt"));
  write_text_file(folder / "sub/ahead.txt", "ahead");
  CHECK(read_text_file(folder / "sub/new.txt") == "ahead");
  CHECK(fs::is_symlink(folder / "sub/ahead.txt"));
  CHECK(test::entries_of(folder / "sub") ==
        std::set<std::string>{"file.txt", "new.txt", "ahead.txt"});
}

TEST_CASE("what is no regular file is not replaced") {
  const test::ScratchFolder folder;
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  fs::create_symlink("pipe", folder / "link");
  const auto check_refused = [](const fs::path& path, const std::string& kind) {
    CAPTURE(path);
    const std::string words =
        path.string() + ": is " + kind + ", which is not replaced; name a file";
    CHECK_THROWS_WITH_AS(write_text_file(path, "x"), words.c_str(), InputError);
    CHECK_THROWS_WITH_AS(check_output(path), words.c_str(), InputError);
  };
  check_refused(folder / "pipe", "a pipe");
  check_refused(folder / "link", "a pipe");
  check_refused("/dev/null", "a device");
  CHECK(fs::is_fifo(folder / "pipe"));
  CHECK(fs::is_character_file("/dev/null"));
  fs::create_symlink("loop", folder / "loop");
  CHECK_THROWS_AS(write_text_file(folder / "loop/x", "x"), InputError);
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"pipe", "link", "loop"});
}

TEST_CASE("an open file is not replaced by the name that /dev and /proc have for it") {
  const test::ScratchFolder folder;
  const fs::path file = folder.write("file.txt", "earlier");
  const int number = ::open(file.c_str(), O_WRONLY | O_APPEND);
  REQUIRE(number >= 0);
  const std::string name = std::to_string(number);
  fs::create_symlink("/dev/fd/" + name, folder / "link");
  for (const fs::path& path :
       {fs::path("/dev/fd/" + name), fs::path("/proc/self/fd/" + name),
        fs::path("/proc/self/task/" + std::to_string(::getpid()) + "/fd/" + name),
        folder / "link"}) {
    CAPTURE(path);
    const std::string words =
        path.string() + ": is an open file, which is not replaced; name a file";
    CHECK_THROWS_WITH_AS(check_output(path), words.c_str(), InputError);
    CHECK_THROWS_WITH_AS(write_text_file(path, "x"), words.c_str(), InputError);
  }
  ::close(number);
  CHECK(read_text_file(file) == "earlier");
  CHECK_NOTHROW(write_text_file(file, "by its own name"));
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"file.txt", "link"});
}

TEST_CASE("the reason why a file cannot be written is reported") {
  const test::ScratchFolder folder;
  const auto message = [&](const auto& write) -> std::string {
    try {
      write();
      return {};
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const fs::path missing = folder / "missing/a.txt";
  CHECK(message([&] { write_text_file(missing, "x"); }) ==
        missing.string() + ": cannot be written: No such file or directory");
  CHECK(message([&] { check_output(missing); }) == missing.string() +
                                                       ": cannot be written: there is no folder " +
                                                       (folder / "missing").string());
  CHECK(message([&] { check_output(folder / "a.txt"); }).empty());
  CHECK(message([&] { check_output("a.txt"); }).empty());
}

TEST_CASE("outputs of a batch come all or none") {
  const test::ScratchFolder folder;
  folder.write("a.txt", "old");
  const auto write_all = [&] {
    write_text_file(folder / "a.txt", "new");
    make_folder(folder / "made/inside");
    write_text_file(folder / "made/inside/b.txt", "new");
    OutputFile several(folder / "several");
    fs::create_directory(several.temporary());
    {
      const OutputsAtOnce at_once;
      write_text_file(several.temporary() / "c.txt", "new");
    }
    several.put_in_place();
  };
  {
    const OutputBatch batch;
    write_all();
    CHECK(read_text_file(folder / "a.txt") == "old");
    CHECK(!fs::exists(folder / "made/inside/b.txt"));
  }
  CHECK(read_text_file(folder / "a.txt") == "old");
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"a.txt"});
  {
    OutputBatch batch;
    write_all();
    {
      const OutputsAtOnce at_once;
      write_text_file(folder / "now.txt", "at once");
    }
    CHECK(read_text_file(folder / "now.txt") == "at once");
    batch.put_in_place();
  }
  CHECK(read_text_file(folder / "a.txt") == "new");
  CHECK(read_text_file(folder / "made/inside/b.txt") == "new");
  CHECK(read_text_file(folder / "several/c.txt") == "new");
  CHECK(test::entries_of(folder / "") ==
        std::set<std::string>{"a.txt", "made", "several", "now.txt"});
  write_text_file(folder / "a.txt", "without a batch");
  CHECK(read_text_file(folder / "a.txt") == "without a batch");
}

TEST_CASE("a folder is made where a link leads, and a link is never taken away") {
  const test::ScratchFolder folder;
  fs::create_symlink("made/inside", folder / "link");
  fs::create_symlink("nowhere", folder / "other");
  folder.write("file", "x");
  {
    const OutputBatch batch;
    make_folder(folder / "link/");
    CHECK(fs::is_directory(folder / "made/inside"));
    CHECK_THROWS_AS(make_folder(folder / "other/inside"), InputError);
    CHECK_THROWS_AS(make_folder(folder / "file"), InputError);
  }
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"link", "other", "file"});
}

TEST_CASE("a batch does not replace what is read, whatever it is called") {
  const test::ScratchFolder folder;
  const fs::path input = folder.write("input.txt", "read");
  fs::create_hard_link(input, folder / "other name.txt");
  fs::create_symlink("input.txt", folder / "link.txt");
  fs::create_directory(folder / "frames");
  const OutputBatch batch({input, folder / "absent", folder / "frames"});
  for (const char* name : {"input.txt", "other name.txt", "link.txt", "frames"}) {
    CAPTURE(name);
    CHECK_THROWS_AS(check_output(folder / name), InputError);
    CHECK_THROWS_AS(write_text_file(folder / name, "x"), InputError);
  }
  CHECK_NOTHROW(check_output(folder / "output.txt"));
  CHECK_NOTHROW(check_output(folder / "absent"));
}

TEST_CASE("a batch does not replace what was read while it lives, from a folder or a list") {
  const test::ScratchFolder folder;
  fs::create_directory(folder / "frames");
  const fs::path frame = folder.write("frames/1.json", "read"),
                 other = folder.write("frames/2.json", "not read");
  fs::create_symlink("frames/1.json", folder / "link.json");
  {
    OutputBatch batch({folder / "frames"});
    CHECK_NOTHROW(check_output(frame));
    CHECK(read_text_file(frame) == "read");
    for (const fs::path& path : {frame, folder / "link.json"}) {
      CAPTURE(path);
      CHECK_THROWS_AS(write_text_file(path, "x"), InputError);
      CHECK_THROWS_AS(check_replaceable(path), InputError);
    }
    CHECK_NOTHROW(write_text_file(other, "new"));
    {
      const OutputsAtOnce its_own;  // a log that goes on
      CHECK_NOTHROW(write_text_file(frame, "new"));
    }
    batch.put_in_place();
  }
  CHECK(read_text_file(other) == "new");
  const OutputBatch next;  // independent of the one before
  CHECK_NOTHROW(check_output(frame));
}

TEST_CASE("an output that no file can be is refused before the work") {
  const test::ScratchFolder folder;
  for (const fs::path& path : {fs::path(), fs::path("-"), folder / std::string(300, 'a')}) {
    CAPTURE(path);
    CHECK_THROWS_AS(check_output(path), InputError);
  }
  CHECK_NOTHROW(check_output(folder / "-"));
}

TEST_CASE("an output in a folder that may not be written to is refused before the work") {
  const test::ScratchFolder folder;
  fs::create_directory(folder / "of another");
  fs::permissions(folder / "", fs::perms::owner_all | fs::perms::others_exec);
  fs::permissions(folder / "of another", fs::perms::owner_read | fs::perms::owner_exec |
                                             fs::perms::others_read | fs::perms::others_exec);
  const pid_t child = ::fork();
  if (child == 0) {
    // root may write everywhere
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) ::_exit(2);
    try {
      check_output(folder / "of another/a.txt");
    } catch (const InputError&) {
      ::_exit(0);
    }
    ::_exit(1);
  }
  int status = -1;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("a file takes the place of no folder, a folder that of an empty one; or none of them") {
  const test::ScratchFolder folder;
  fs::create_directory(folder / "empty");
  CHECK_THROWS_AS(check_output(folder / "empty"), InputError);
  CHECK_NOTHROW(check_output(folder / "empty", OutputKind::file_or_folder));
  {
    OutputBatch batch;
    write_text_file(folder / "a.txt", "new");
    CHECK_THROWS_AS(write_text_file(folder / "empty", "x"), InputError);
  }
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"empty"});
  OutputBatch batch;
  OutputFile frames(folder / "empty");
  fs::create_directory(frames.temporary());
  std::ofstream(frames.temporary() / "1.json") << "{}";
  frames.put_in_place();
  batch.put_in_place();
  CHECK(test::entries_of(folder / "empty") == std::set<std::string>{"1.json"});
}

TEST_CASE("two outputs of a command in one place are refused, whatever they are called") {
  const test::ScratchFolder folder;
  fs::create_symlink("a.txt", folder / "link");
  fs::create_directory(folder / "sub");
  for (const char* other : {"a.txt", "./a.txt", "sub/../a.txt", "link"}) {
    CAPTURE(other);
    OutputBatch batch;
    check_output(folder / "a.txt");
    check_output(folder / "b.txt");
    CHECK_THROWS_AS(check_output(folder / other), InputError);
    write_text_file(folder / "a.txt", "1");
    CHECK_THROWS_AS(write_text_file(folder / other, "2"), InputError);
  }
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"link", "sub"});
}

TEST_CASE("an output may be named as a folder that is not there, by a slash at its end") {
  const test::ScratchFolder folder;
  const fs::path frames = folder / "frames/";
  {
    OutputBatch batch;
    CHECK_NOTHROW(check_output(frames, OutputKind::file_or_folder));
    CHECK_THROWS_WITH_AS(check_output(folder / "frames", OutputKind::file_or_folder),
                         doctest::Contains("written twice"), InputError);
    CHECK_THROWS_WITH_AS(check_output(folder / "none/frames/", OutputKind::file_or_folder),
                         doctest::Contains("there is no folder"), InputError);
    OutputFile output(frames);
    fs::create_directory(output.temporary());
    output.put_in_place();
    batch.put_in_place();
  }
  CHECK(fs::is_directory(folder / "frames"));
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"frames"});
}

TEST_CASE("a file is not named by a slash at its end, and no folder takes its place") {
  const test::ScratchFolder folder;
  for (const char* name : {"new.csv/", "old.csv/"}) {
    CAPTURE(name);
    folder.write("old.csv", "old");
    CHECK_THROWS_WITH_AS(check_output(folder / name), doctest::Contains("names a folder"),
                         InputError);
    CHECK_THROWS_WITH_AS(write_text_file(folder / name, "new"), doctest::Contains("names a folder"),
                         InputError);
  }
  CHECK_THROWS_WITH_AS(check_output(folder / "old.csv/", OutputKind::file_or_folder),
                       doctest::Contains("is no folder"), InputError);
  CHECK(read_text_file(folder / "old.csv") == "old");
  CHECK(test::entries_of(folder / "") == std::set<std::string>{"old.csv"});
}
