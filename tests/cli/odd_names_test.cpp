// Names that no file has, files that are none, names that are no words, streams that are closed.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "base/text_file.hpp"
#include "mcdbn/formats/bvh.hpp"
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

TEST_CASE("a pipe is no file to read: nobody waits for somebody to write into it") {
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
  CHECK(entries_of(folder / "") == std::set<std::string>{"clip.bvh"});
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
