#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "run_cli.hpp"

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

CliResult project(const fs::path& clip, const fs::path& track, const std::string& options = "") {
  return run_cli(fmt::format("project '{}' -o '{}' {}", clip.string(), track.string(), options));
}

int files_in(const fs::path& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

}  // namespace

TEST_CASE("project prepares a clip as training does and keeps the body in view") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(120, true));
  const fs::path output = folder / "track.csv";

  const CliResult result = project(clip, output);
  CAPTURE(result.standard_error);
  REQUIRE(result.exit_code == 0);
  CHECK(result.standard_output.empty());
  CHECK(result.standard_error.find("calibration pose") != std::string::npos);

  const mcdbn::Track2d track = mcdbn::read_track_csv(output);
  CHECK(track.joint_names == std::vector<std::string>{"Hips", "Chest"});
  CHECK(track.fps == doctest::Approx(30.0));
  CHECK(track.frames() == 30);
  CHECK((track.x_px.array() >= 0 && track.x_px.array() < track.width_px).all());
  CHECK((track.y_px.array() >= 0 && track.y_px.array() < track.height_px).all());
  CHECK((track.confidence.array() == 1.0).all());

  REQUIRE(project(clip, output, "--fps 0 --keep-first-frame --quiet").standard_error.empty());
  const mcdbn::Track2d raw = mcdbn::read_track_csv(output);
  CHECK(raw.frames() == 121);
  CHECK(raw.fps == doctest::Approx(120.0).epsilon(1e-3));
}

TEST_CASE("project: the written camera gives the same track again") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(40));
  const fs::path camera = folder / "camera.yaml";
  REQUIRE(project(clip, folder / "placed.csv",
                  fmt::format("--camera-azimuth -60 --write-camera '{}'", camera.string()))
              .exit_code == 0);
  REQUIRE(
      project(clip, folder / "read.csv", fmt::format("--camera '{}'", camera.string())).exit_code ==
      0);
  const mcdbn::Track2d placed = mcdbn::read_track_csv(folder / "placed.csv");
  const mcdbn::Track2d read = mcdbn::read_track_csv(folder / "read.csv");
  REQUIRE(placed.frames() == read.frames());
  CHECK((placed.x_px - read.x_px).cwiseAbs().maxCoeff() <= 1e-2);
  CHECK((placed.y_px - read.y_px).cwiseAbs().maxCoeff() <= 1e-2);
}

TEST_CASE("project: noise has the deviation asked for and follows the seed") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(800));
  REQUIRE(project(clip, folder / "clean.csv", "--fps 0").exit_code == 0);
  REQUIRE(project(clip, folder / "noisy.csv", "--fps 0 --noise-px 5 --seed 3").exit_code == 0);
  REQUIRE(project(clip, folder / "again.csv", "--fps 0 --noise-px 5 --seed 3").exit_code == 0);
  const mcdbn::Track2d clean = mcdbn::read_track_csv(folder / "clean.csv");
  const mcdbn::Track2d noisy = mcdbn::read_track_csv(folder / "noisy.csv");
  const mcdbn::Track2d again = mcdbn::read_track_csv(folder / "again.csv");
  CHECK(noisy.x_px == again.x_px);
  const mcdbn::MatrixD noise_px = noisy.x_px - clean.x_px;
  const double deviation_px = std::sqrt(noise_px.array().square().mean());
  // The deviation of 1600 draws has a standard error of 5 / sqrt(2 · 1600) = 0.09; four of them.
  CHECK(std::abs(deviation_px - 5.0) <= 0.36);
}

TEST_CASE("a bad clip is exit code 3, one line with file and line, and no output") {
  const ScratchFolder folder;
  std::string text = small_bvh(4);
  text.replace(text.rfind("40"), 2, "x0");
  const fs::path clip = folder.write("bad.bvh", text);
  const int bad_line = count_lines(text);

  const CliResult result = project(clip, folder / "track.csv");
  CHECK(result.exit_code == 3);
  CHECK(result.standard_output.empty());
  CAPTURE(result.standard_error);
  CHECK(count_lines(result.standard_error) == 1);
  CHECK(result.standard_error.find(fmt::format("{}:{}: ", clip.string(), bad_line)) !=
        std::string::npos);
  CHECK(files_in(folder / ".") == 1);

  CHECK(project(folder / "absent.bvh", folder / "track.csv").exit_code == 3);
  CHECK(run_cli("info '" + clip.string() + "'").exit_code == 3);
  CHECK(files_in(folder / ".") == 1);
}

TEST_CASE("an output that cannot be written leaves nothing behind") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(8));
  const CliResult result = project(clip, folder / "no/such/folder/track.csv");
  CHECK(result.exit_code == 3);
  CHECK(count_lines(result.standard_error) == 1);
  CHECK(files_in(folder / ".") == 1);
}

TEST_CASE("info describes clips and tracks") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(120, true));
  const auto described =
      nlohmann::json::parse(run_cli("info --json '" + clip.string() + "'").standard_output);
  CHECK(described.at("joints") == nlohmann::json{"Hips", "Chest"});
  CHECK(described.at("frames") == 121);
  CHECK(described.at("channels") == 9);
  CHECK(described.at("fps").get<double>() == doctest::Approx(120.0).epsilon(1e-3));
  CHECK(described.at("height_units").get<double>() == doctest::Approx(100.0));
  CHECK(described.at("roles") == nlohmann::json{{"Hips", "pelvis"}, {"Chest", nullptr}});
  CHECK(described.at("roles_without_joint").size() == 22);
  CHECK(described.at("roles_without_joint").at(0) == "spine");
  const std::string shown = run_cli("info '" + clip.string() + "'").standard_output;
  CHECK(shown.find("  Hips                pelvis\n  Chest\n") != std::string::npos);
  CHECK(shown.find("roles_without_joint   22\n  spine\n") != std::string::npos);

  const fs::path output = folder / "track.csv";
  REQUIRE(project(clip, output).exit_code == 0);
  const auto track =
      nlohmann::json::parse(run_cli("info --json '" + output.string() + "'").standard_output);
  CHECK(track.at("frames") == 30);
  CHECK(track.at("missing_joint_frames") == 0);

  CHECK(run_cli("info '" + folder.write("notes.txt", "hello").string() + "'").exit_code == 3);
}

TEST_CASE("render draws a contact sheet") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(40));
  const fs::path picture = folder / "sheet.png";
  REQUIRE(run_cli(fmt::format("render '{}' -o '{}'", clip.string(), picture.string())).exit_code ==
          0);
  CHECK(mcdbn::read_text_file(picture).starts_with("\x89PNG"));
  CHECK(run_cli(fmt::format("render '{}' -o '{}'", clip.string(), (folder / "a.xyz").string()))
            .exit_code == 2);
  CHECK(!fs::exists(folder / "a.xyz"));
}
