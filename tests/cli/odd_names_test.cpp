// Names that no file has, files that are none, names that are no words, streams that are closed.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

/// It is refused in one line that names the file, in words of our own.
void check_refused(const std::string& arguments, const std::string& file) {
  CAPTURE(arguments);
  const CliResult result = run_cli(arguments);
  CAPTURE(result.standard_error);
  CHECK((result.exit_code == 3 || result.exit_code == 2));
  CHECK(count_lines(result.standard_error) == 1);
  CHECK(result.standard_error.starts_with("mcdbn-cl: error: "));
  CHECK(result.standard_error.find(file) != std::string::npos);
  CHECK(result.standard_error.find("filesystem") == std::string::npos);
}

/// Commands that read `file`.
std::vector<std::string> readers_of(const std::string& file, const std::string& clip,
                                    const std::string& out) {
  return {fmt::format("info '{}'", file),
          fmt::format("project '{}' -o '{}'", file, out),
          fmt::format("project '{}' -o '{}' --camera '{}'", clip, out, file),
          fmt::format("render '{}' -o '{}.png'", file, out),
          fmt::format("render '{}' -o '{}.mp4' --over '{}' --camera '{}'", clip, out, file, file),
          fmt::format("train '{}' -o '{}'", file, out),
          fmt::format("train '{}' -o '{}' --config '{}'", clip, out, file),
          fmt::format("train '{}' -o '{}' --sweep '{}'", clip, out, file),
          fmt::format("train --resume '{}'", file)};
}

}  // namespace

TEST_CASE("a name that is too long, or goes in a circle, is refused by its name") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string clip = folder.write("clip.bvh", small_bvh(4)).string(),
                    out = (folder / "out").string();
  fs::create_symlink("circle", folder / "circle");
  for (const std::string& file :
       {(folder / std::string(300, 'a')).string(), (folder / "circle").string()})
    for (const std::string& arguments : readers_of(file, clip, out)) check_refused(arguments, file);
  const std::string name = std::string(300, 'a');
  check_refused(fmt::format("project '{}' -o '{}'", clip, (folder / name).string()), name);
  check_refused(fmt::format("train '{}' -o '{}'", clip, (folder / name).string()), name);
  CHECK(entries_of(folder / "") == std::set<std::string>{"clip.bvh", "circle"});
}

TEST_CASE("a pipe is no file to read: no command waits for a writer") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string clip = folder.write("clip.bvh", small_bvh(4)).string(),
                    out = (folder / "out").string();
  for (const char* name : {"pipe", "pipe.bvh", "pipe.csv", "pipe.toml", "pipe.safetensors"}) {
    const std::string file = (folder / name).string();
    REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
    for (const std::string& arguments : readers_of(file, clip, out)) check_refused(arguments, file);
  }
  CHECK(!fs::exists(out));
}

TEST_CASE("outputs that are none, or two in one place, are refused before the work") {
  const ScratchFolder folder;
  const std::string clip = folder.write("clip.bvh", small_bvh(4)).string(),
                    same = (folder / "same.xml").string(), project = "project '" + clip + "' -o ";
  check_refused(project + "''", "without a name");
  check_refused(project + "-", "./-");
  check_refused(project + fmt::format("'{0}' --write-camera '{0}'", same), same);
  // A file takes no folder's place, and then its other output is not written either.
  fs::create_directory(folder / "empty");
  const std::string empty = (folder / "empty").string(), other = (folder / "t.csv").string();
  check_refused(fmt::format("render '{}' -o '{}'", clip, empty), empty);
  check_refused(fmt::format("{}'{}' --write-camera '{}'", project, other, empty), empty);
  check_refused(fmt::format("{}'{}'", project, empty), empty);
  CHECK(entries_of(folder / "") == std::set<std::string>{"clip.bvh", "empty"});
}

TEST_CASE("a link that leads nowhere is no folder's end: it is written through, or stays") {
  const ScratchFolder folder;
  fs::create_symlink("made", folder / "link");
  const std::string link = (folder / "link").string();
  check_refused(fmt::format("synthesize --action walk --seconds 1 -o '{}/below'", link), link);
  CHECK(fs::is_symlink(folder / "link"));
  CHECK(run_cli(fmt::format("synthesize --action walk --clips 1 --seconds 1 --quiet -o '{}'", link))
            .exit_code == 0);
  CHECK(entries_of(folder / "made") == std::set<std::string>{"walk_s01_01.bvh"});
}

TEST_CASE("what a folder, a list or FILE:NAME leads to is read, and so not replaced") {
  const ScratchFolder folder;
  const std::string clips = (folder / "clips").string(), track = (folder / "t.csv").string(),
                    camera = (folder / "c.yaml").string();
  REQUIRE(run_cli(fmt::format("synthesize --action walk --clips 1 --seconds 1 -o '{}'", clips))
              .exit_code == 0);
  const std::string clip = clips + "/walk_s01_01.bvh", text = mcdbn::read_text_file(clip);
  check_refused(fmt::format("corpus '{}' -o '{}'", clips, clip), clip);
  const std::string list = (folder / "list.toml").string();
  REQUIRE(run_cli(fmt::format("corpus '{}' -o '{}' --quiet", clips, list)).exit_code == 0);
  check_refused(fmt::format("corpus '{}' -o '{}'", list, clip), clip);
  CHECK(mcdbn::read_text_file(clip) == text);
  REQUIRE(
      run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}' --quiet", clip, track, camera))
          .exit_code == 0);
  check_refused(fmt::format("project '{0}' -o '{1}' --camera '{1}:one'", clip, camera), camera);
  CHECK(run_cli(fmt::format("info '{}'", camera)).exit_code == 0);
}

TEST_CASE("a clip whose name is no text stands in no list that TOML could not hold") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const std::string clip =
      folder
          .write("clip \xFF.bvh",
                 mcdbn::read_text_file(TinyPipeline::instance().motion() / "walk_s02_01.bvh"))
          .string();
  const std::string list = (folder / "list.toml").string();
  check_refused(fmt::format("corpus '{}' -o '{}'", clip, list), "is not UTF-8 text");
  CHECK(!fs::exists(list));
}

TEST_CASE("a clip that is called <script> is text in the report and everywhere else") {
  if (!have_device()) return;
  const ScratchFolder folder;
  const TinyPipeline& pipeline = TinyPipeline::instance();
  const std::string name = "<script>alert(1)<!-- <img src=x onerror=alert(2)> & \"'.bvh";
  fs::copy_file(pipeline.motion() / "walk_s02_01.bvh", folder / name);
  const CliResult result = run_cli(fmt::format(
      "evaluate --model '{}' --test '{}' --report '{}' --quiet", pipeline.model().string(),
      folder.operator/("").string(), (folder / "report").string()));
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  const std::string page = mcdbn::read_text_file(folder / "report/report.html");
  // It is there, as data: '<' opens nothing.
  CHECK(page.find("\\u003cscript>alert(1)\\u003c!-- \\u003cimg src=x") != std::string::npos);
  for (const char* markup : {"<script>alert", "<!-- <img", "<img src=x"})
    CHECK(page.find(markup) == std::string::npos);
}

TEST_CASE("streams that are closed are taken for no file that the program opens") {
  const ScratchFolder folder;
  const fs::path script = folder.write(
      "closed.sh",
      fmt::format("'{}' synthesize --action walk --clips 100000 -o '{}' <&- >&- 2>&- &\n"
                  "until [ -e '{}' ] || ! kill -0 $! 2>/dev/null; do sleep 0.02; done\n"
                  "for stream in 0 1 2; do readlink /proc/$!/fd/$stream; done\n"
                  "kill $!; wait $!\n",
                  MCDBN_CLI, (folder / "clips").string(), (folder / "clips").string()));
  CHECK(run_program("/bin/sh", fmt::format("'{}'", script.string())).standard_output ==
        "/dev/null\n/dev/null\n/dev/null\n");
  const CliResult closed =
      run_program("/bin/sh", fmt::format("-c \"'{}' devices >&-\"", MCDBN_CLI));
  CHECK(closed.exit_code == 1);
  CHECK(closed.standard_error.find("standard output: cannot be written") != std::string::npos);
}
