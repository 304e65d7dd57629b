// Every option of render, and what it changes: compared with the library's own picture or film.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <opencv2/videoio.hpp>

#include "base/capture_bound.hpp"
#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/drawing/render.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "option_table.hpp"
#include "run_cli.hpp"

namespace render_options_test {

using namespace mcdbn::test;
namespace fs = std::filesystem;

namespace {

struct Call {
  mcdbn::ClipOptions clip = {.fps = 0};
  mcdbn::RenderOptions render = {};
};

std::string sheet_by_library(const std::vector<fs::path>& clips, const Call& call) {
  const ScratchFolder folder;
  std::vector<mcdbn::RenderClip> all;
  for (const fs::path& clip : clips)
    all.push_back({mcdbn::load_clip(clip, call.clip), clip.filename().string()});
  render(all, folder / "sheet.png", call.render);
  return mcdbn::read_text_file(folder / "sheet.png");
}

/// Frames a second of a film.
double rate_of(const fs::path& film) {
  const cv::VideoCapture capture(film.string());
  return capture.get(cv::CAP_PROP_FPS);
}

}  // namespace

TEST_CASE("render: every option changes what its help describes") {
  const ScratchFolder folder;
  std::string moved = small_bvh(200, true);
  for (std::size_t at = 0; (at = moved.find("0 90 ", at)) != std::string::npos; at += 5)
    moved.replace(at, 5, "0 70 ");
  const std::vector<fs::path> clips = {folder.write("one.bvh", small_bvh(240, true)),
                                       folder.write("two.bvh", moved)};
  const auto call_of = [&](const std::string& options, const fs::path& output) {
    return fmt::format("render '{}' '{}' -o '{}' {}", clips[0].string(), clips[1].string(),
                       output.string(), options);
  };
  const auto drawn = [&](const std::string& options) {
    const fs::path output = folder / "sheet.png";
    fs::remove(output);
    const CliResult result = run_cli(call_of(options, output));
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    return mcdbn::read_text_file(output);
  };
  const std::string plain = drawn("");
  CHECK(plain == sheet_by_library(clips, {}));
  const auto row = [&](const char* option, const std::string& arguments,
                       const std::function<void(Call&)>& change) {
    return OptionRow{option, [=, &drawn] {
                       Call call;
                       change(call);
                       const std::string sheet = drawn(arguments);
                       CHECK(sheet == sheet_by_library(clips, call));
                       CHECK(sheet != plain);
                     }};
  };
  const fs::path camera_file = folder / "camera.yaml";
  write_camera(camera_file,
               place_camera(mcdbn::load_clip(clips[0]), {.azimuth_deg = 80,
                                                         .distance = 300,
                                                         .width_px = 640,  // the film's
                                                         .height_px = 720}));
  const fs::path film = folder / "film.mp4";
  mcdbn::RenderOptions turning;
  turning.orbit = true;
  render({{mcdbn::load_clip(clips[0]), "one"}}, film, turning);
  check_options(
      "render",
      {row("--over", fmt::format("--over '{}' --camera '{}'", film.string(), camera_file.string()),
           [&](auto& call) {
             call.render.over = film;
             call.render.camera = mcdbn::read_camera(camera_file);
           }),
       row("--over-from",
           fmt::format("--over '{}' --over-from 3 --camera '{}'", film.string(),
                       camera_file.string()),
           [&](auto& call) {
             call.render.over = film;
             call.render.over_from = 3;
             call.render.camera = mcdbn::read_camera(camera_file);
           }),
       row("--overlay", "--overlay", [](auto& call) { call.render.overlay = true; }),
       row("--orbit", "--orbit", [](auto& call) { call.render.orbit = true; }),
       row("--orbit-speed", "--orbit --orbit-speed 55",
           [](auto& call) {
             call.render.orbit = true;
             call.render.orbit_deg_per_s = 55;
           }),
       row("--still-camera", "--still-camera", [](auto& call) { call.render.follow_root = false; }),
       row("--columns", "--columns 3", [](auto& call) { call.render.sheet_columns = 3; }),
       row("--fps", "--fps 11", [](auto& call) { call.clip.fps = 11; }),
       row("--keep-first-frame", "--keep-first-frame",
           [](auto& call) { call.clip.keep_first_frame = true; }),
       row("--camera", fmt::format("--camera '{}'", camera_file.string()),
           [&](auto& call) { call.render.camera = mcdbn::read_camera(camera_file); }),
       row("--camera-azimuth", "--camera-azimuth -40",
           [](auto& call) { call.render.placement.azimuth_deg = -40; }),
       row("--camera-elevation", "--camera-elevation 50",
           [](auto& call) { call.render.placement.elevation_deg = 50; }),
       row("--camera-distance", "--camera-distance 999",
           [](auto& call) { call.render.placement.distance = 999; }),
       row("--camera-fov", "--camera-fov 80",
           [](auto& call) { call.render.placement.field_of_view_deg = 80; }),
       row("--image-size", "--image-size 160 200",
           [](auto& call) {
             call.render.placement.width_px = 160;
             call.render.placement.height_px = 200;
           }),
       {"clips",
        [&] {
          const fs::path sheet = folder / "one.png";
          CHECK(run_cli(fmt::format("render '{}' -o '{}'", clips[1].string(), sheet.string()))
                    .exit_code == 0);
          CHECK(mcdbn::read_text_file(sheet) == sheet_by_library({clips[1]}, {}));
          CHECK(run_cli(fmt::format("render absent.bvh -o '{}'", sheet.string())).exit_code == 3);
        }},
       {"--output", [&] { CHECK(drawn("").starts_with("\x89PNG")); }},
       {"--video-fps",
        [&] {
          const fs::path film = folder / "film.mp4";
          const std::string small = "--image-size 64 64 ";
          // The first clip's rate, at most 60 Hz: these have 120.
          CHECK(run_cli(call_of(small, film)).exit_code == 0);
          CHECK(rate_of(film) == doctest::Approx(60));
          std::string slower = small_bvh(30);
          const std::string frame_time = "0.0083333";
          slower.replace(slower.find(frame_time), frame_time.size(), "0.02");
          CHECK(run_cli(fmt::format("render '{}' -o '{}' {}",
                                    folder.write("slower.bvh", slower).string(), film.string(),
                                    small))
                    .exit_code == 0);
          CHECK(rate_of(film) == doctest::Approx(50));
          CHECK(run_cli(call_of(small + "--video-fps 12", film)).exit_code == 0);
          CHECK(rate_of(film) == doctest::Approx(12));
        }},
       {"--quiet", [&] {
          const std::string call = call_of("", folder / "sheet.png");
          CHECK(run_cli(call).standard_error.find("sheet.png: 2 clips") != std::string::npos);
          CHECK(run_cli(call + " --quiet").standard_error.find("2 clips") == std::string::npos);
        }}});
}

TEST_CASE("render --over: a file that is no film is refused in one line of our own") {
  const ScratchFolder folder;
  const fs::path clip = folder / "clips/walk_s01_01.bvh", camera = folder / "camera.yaml";
  const fs::path text = folder.write("text.mp4", "no film");
  REQUIRE(run_cli(fmt::format("synthesize --action walk --clips 1 --subjects 1 --seconds 1 -o '{}'",
                              clip.parent_path().string()))
              .exit_code == 0);
  write_camera(camera, place_camera(mcdbn::load_clip(clip), {.azimuth_deg = 80, .distance = 300}));
  const CliResult result =
      run_cli(fmt::format("render '{}' --over '{}' --camera '{}' --quiet -o '{}'", clip.string(),
                          text.string(), camera.string(), (folder / "over.mp4").string()));
  CHECK(result.exit_code == 3);
  CHECK(result.standard_error.find(
            fmt::format("mcdbn-cl: error: {}: is not a film", text.string())) != std::string::npos);
  CHECK(result.standard_error.find("OpenCV") == std::string::npos);
  CHECK(result.standard_error.find("moov") == std::string::npos);
}

TEST_CASE("render --over: what it needs is named, and a camera that is scaled is reported") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(40)), film = folder / "film.mp4",
                 camera = folder / "camera.yaml";
  REQUIRE(
      run_cli(fmt::format("render '{}' -o '{}' --image-size 96 96", clip.string(), film.string()))
          .exit_code == 0);
  const std::string call = fmt::format("render '{}' --over '{}' --quiet -o '{}'", clip.string(),
                                       film.string(), (folder / "over.png").string());
  const CliResult refused = run_cli(call);
  CHECK(refused.exit_code == 2);
  for (const char* word : {"--camera", "regenerate's --write-camera"})
    CHECK(refused.standard_error.find(word) != std::string::npos);
  write_camera(camera, place_camera(mcdbn::load_clip(clip),
                                    {.distance = 300, .width_px = 192, .height_px = 192}));
  const CliResult drawn = run_cli(fmt::format("{} --camera '{}'", call, camera.string()));
  CHECK(drawn.exit_code == 0);
  CHECK(drawn.standard_error.find(fmt::format(
            "mcdbn-cl: warning: {}: its images are 96 x 96 px, those of the camera 192 x 192 px",
            film.string())) != std::string::npos);
  // The clip has 120 frames a second, a film of it 60.
  CHECK(drawn.standard_error.find("regenerate it with --fps 60\n") != std::string::npos);
}

TEST_CASE("render: options that would be ignored are refused") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(4));
  const std::string call =
      fmt::format("render '{}' -o '{}' ", clip.string(), (folder / "out.mp4").string());
  for (const char* options :
       {"--over f.mp4 --camera c.yml --overlay", "--over f.mp4 --camera c.yml --video-fps 5",
        "--over-from 3", "--camera c.yml --orbit", "--camera c.yml --still-camera",
        "--orbit-speed 20"}) {
    CAPTURE(options);
    CHECK(run_cli(call + options).exit_code == 2);
  }
  // Of the other kind of output.
  for (const auto& [output, option, other] :
       {std::array{"out.png", "--video-fps", ".mp4"}, {"out.mp4", "--columns", ".png"}}) {
    CAPTURE_BOUND(option);
    const fs::path file = folder / output;
    const CliResult result =
        run_cli(fmt::format("render '{}' -o '{}' {} 10", clip.string(), file.string(), option));
    CHECK(result.exit_code == 2);
    CHECK(result.standard_error.find(fmt::format("{} is for --output FILE{}", option, other)) !=
          std::string::npos);
    CHECK_FALSE(fs::exists(file));
  }
}

TEST_CASE("render: without the program that draws, the message names it") {
  const ScratchFolder folder;
  fs::create_directory(folder / "bin");
  const fs::path alone = folder / "bin" / "mcdbn-cl", clip = folder.write("one.bvh", small_bvh(9));
  fs::copy_file(MCDBN_CLI, alone);
  const CliResult result = run_program(
      alone, fmt::format("render '{}' -o '{}'", clip.string(), (folder / "sheet.png").string()));
  CHECK(result.exit_code == 1);
  CHECK(
      result.standard_error ==
      fmt::format(
          "mcdbn-cl: error: the drawing program cannot be started, {}: No such file or directory\n",
          (folder / "libexec" / "mcdbn-cl" / "render").string()));
}

}  // namespace render_options_test
