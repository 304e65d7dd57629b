#pragma once

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>

#include "base/text_file.hpp"
#include "tiny_pipeline.hpp"

namespace mcdbn::test {

/// A track, and the camera that saw it, for regenerate --follow.
struct FollowScene {
  ScratchFolder folder;
  std::filesystem::path track = folder / "track.csv", camera = folder / "camera.yaml";

  FollowScene() {
    REQUIRE(run_cli(fmt::format("project '{}' -o '{}' --write-camera '{}' --noise-px 1",
                                clip().string(), track.string(), camera.string()))
                .exit_code == 0);
  }
  std::string call(const std::string& options) const {
    return fmt::format("regenerate --follow --model '{}' --camera '{}' {}",
                       TinyPipeline::instance().model().string(), camera.string(), options);
  }
  /// With the track at its standard input.
  CliResult follow(const std::string& options, const std::filesystem::path& input) const {
    return run_program("/bin/bash", fmt::format("-c \"cat '{}' | '{}' {}\"", input.string(),
                                                MCDBN_CLI, call(options)));
  }
  /// With a named pipe as its input, which these lines of bash write to as file 3; $program is the
  /// process. Ends as the program does.
  CliResult follow_pipe(const std::filesystem::path& output, const std::string& steps) const {
    const std::filesystem::path script = folder.write(
        "follow.sh",
        fmt::format("mkfifo '{0}/pipe'\n'{1}' {2} --input '{0}/pipe' -o '{3}' &\nprogram=$!\n"
                    "exec 3>'{0}/pipe'\n{4}wait $program\nexit $?\n",
                    (folder / ".").string(), MCDBN_CLI, call(""), output.string(), steps));
    return run_program("/bin/bash", fmt::format("'{}'", script.string()));
  }
  /// A detector's frames, a line of JSON each.
  std::string detected_lines() const {
    const std::filesystem::path detected = folder / "detected";
    REQUIRE(run_cli(fmt::format("project '{}' --like openpose --format openpose -o '{}'",
                                clip().string(), detected.string()))
                .exit_code == 0);
    const std::set<std::filesystem::path> files(std::filesystem::directory_iterator(detected), {});
    std::string lines;
    for (const std::filesystem::path& file : files) lines += mcdbn::read_text_file(file) + "\n";
    return lines;
  }

 private:
  static std::filesystem::path clip() {
    return TinyPipeline::instance().motion() / "walk_s02_01.bvh";
  }
};

}  // namespace mcdbn::test
