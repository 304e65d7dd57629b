// Every option of synthesize and project, and what it changes: compared with the library's own.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include "base/scratch_folder.hpp"
#include "base/text_file.hpp"
#include "camera/detector_track.hpp"
#include "camera/random_camera.hpp"
#include "camera/track_noise.hpp"
#include "mcdbn/camera/camera.hpp"
#include "mcdbn/camera/joint_sets.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/corpus/clip.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "mcdbn/synthesis/synthesize.hpp"
#include "option_table.hpp"
#include "run_cli.hpp"

using namespace mcdbn::test;
using mcdbn::SynthesisAction;
using mcdbn::SynthesisOptions;
namespace fs = std::filesystem;

namespace {

/// The files of a folder by name.
std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
    files[entry.path().filename().string()] = mcdbn::read_text_file(entry.path());
  return files;
}

std::map<std::string, std::string> synthesized(const std::string& options) {
  const ScratchFolder folder;
  const CliResult result =
      run_cli(fmt::format("synthesize -o '{}' {}", (folder / "clips").string(), options));
  CAPTURE(result.standard_error);
  CHECK(result.exit_code == 0);
  CHECK(result.standard_output.empty());
  return files_of(folder / "clips");
}

struct Clip {
  const char* name;
  int subject, clip;
};

/// The library's clips under these names, with `options` for all.
void check_clips(const std::map<std::string, std::string>& files, const std::vector<Clip>& clips,
                 SynthesisOptions options) {
  CHECK(files.size() == clips.size());
  for (const Clip& clip : clips) {
    CAPTURE(clip.name);
    options.subject = clip.subject;
    options.clip = clip.clip;
    REQUIRE(files.count(clip.name) == 1);
    CHECK(files.at(clip.name) == bvh_text(synthesize(options)));
  }
}

SynthesisOptions short_clip() {
  SynthesisOptions options;
  options.action = SynthesisAction::jump;
  options.seconds = 0.5;
  return options;
}

struct ProjectCall {
  mcdbn::ClipOptions clip = {};
  mcdbn::CameraPlacement placement = {};
  std::optional<mcdbn::Camera> camera = {};
  double noise_px = 0;
  std::uint64_t seed = 1;
  std::optional<mcdbn::DetectorCameras> random = {};
};

/// The track that the library makes of it, as the program would write it.
std::string track_text(const fs::path& file, const ProjectCall& call) {
  const ScratchFolder folder;
  const mcdbn::Motion motion = mcdbn::load_clip(file, call.clip);
  const mcdbn::Camera camera = call.random   ? random_camera(motion, *call.random, call.seed)
                               : call.camera ? *call.camera
                                             : place_camera(motion, call.placement);
  mcdbn::Track2d track = project_motion(motion, camera);
  add_pixel_noise(track, call.noise_px, call.seed);
  write_track_csv(folder / "track.csv", track);
  return mcdbn::read_text_file(folder / "track.csv");
}

}  // namespace

TEST_CASE("synthesize: every option changes what its help describes") {
  const std::string base = "--action jump --clips 1 --subjects 1 --seconds 0.5";
  const std::vector<Clip> one = {{"jump_s01_01.bvh", 1, 1}};
  check_clips(synthesized(base), one, short_clip());
  const auto row = [&](const char* option, const char* arguments,
                       const std::function<void(SynthesisOptions&)>& change) {
    return OptionRow{option, [=] {
                       SynthesisOptions options = short_clip();
                       change(options);
                       const auto files = synthesized(base + " " + arguments);
                       check_clips(files, one, options);
                       CHECK(files.at(one[0].name) != bvh_text(synthesize(short_clip())));
                     }};
  };
  check_options(
      "synthesize",
      {row("--seed", "--seed 8", [](auto& options) { options.seed = 8; }),
       row("--fps", "--fps 24", [](auto& options) { options.fps = 24; }),
       {"--seconds",
        [] {
          SynthesisOptions options = short_clip();
          options.seconds = 0.9;
          check_clips(synthesized("--action jump --clips 1 --seconds 0.9"),
                      {{"jump_s01_01.bvh", 1, 1}}, options);
        }},
       {"--action",
        [] {
          for (const SynthesisAction action : mcdbn::synthesis_actions()) {
            SynthesisOptions options = short_clip();
            options.action = action;
            const std::string name(synthesis_action_name(action));
            const std::string file = name + "_s01_01.bvh";
            check_clips(synthesized("--clips 1 --seconds 0.5 --action " + name),
                        {{file.c_str(), 1, 1}}, options);
          }
        }},
       {"--clips",
        [] {
          CHECK(synthesized("--action jump --seconds 0.5").size() == 10);
          CHECK(synthesized("--action jump --seconds 0.5 --clips 3").size() == 3);
        }},
       {"--subjects",
        [] {
          check_clips(synthesized("--action jump --seconds 0.5 --clips 5 --subjects 2"),
                      {{"jump_s01_01.bvh", 1, 1},
                       {"jump_s02_01.bvh", 2, 1},
                       {"jump_s01_02.bvh", 1, 2},
                       {"jump_s02_02.bvh", 2, 2},
                       {"jump_s01_03.bvh", 1, 3}},
                      short_clip());
          CHECK(synthesized("--action jump --seconds 0.5 --clips 6").count("jump_s05_01.bvh") == 1);
        }},
       {"--output",
        [] {
          const ScratchFolder folder;
          const std::string call = "synthesize --action jump --clips 1 --seconds 0.5 -o ";
          CHECK(run_cli(call + (folder / "a/b").string()).exit_code == 0);
          CHECK(fs::exists(folder / "a/b/jump_s01_01.bvh"));
        }},
       {"--quiet", [&] {
          const ScratchFolder folder;
          // Fewer clips than the usual five subjects.
          const std::string call = "synthesize --action jump --clips 2 --seconds 0.5 -o '" +
                                   (folder / "x").string() + "'";
          CHECK(run_cli(call).standard_error.find(
                    "2 clips of jump by 2 subjects, 0.5 s each at 30 fps") != std::string::npos);
          CHECK(run_cli(call + " --quiet").standard_error.find(": info: ") == std::string::npos);
        }}});
}

TEST_CASE("project: every option changes what its help describes") {
  const ScratchFolder folder;
  const fs::path clip = folder.write("clip.bvh", small_bvh(60, true));
  const fs::path output = folder / "track.csv";
  const auto projected = [&](const std::string& options) {
    fs::remove(output);
    const CliResult result =
        run_cli(fmt::format("project '{}' -o '{}' {}", clip.string(), output.string(), options));
    CAPTURE(result.standard_error);
    CHECK(result.exit_code == 0);
    return mcdbn::read_text_file(output);
  };
  const std::string plain = projected("");
  CHECK(plain == track_text(clip, {}));
  const auto row = [&](const char* option, const std::string& arguments,
                       const std::function<void(ProjectCall&)>& change) {
    return OptionRow{option, [=, &projected] {
                       ProjectCall call;
                       change(call);
                       const std::string track = projected(arguments);
                       CHECK(track == track_text(clip, call));
                       CHECK(track != plain);
                     }};
  };
  mcdbn::Camera camera = place_camera(mcdbn::load_clip(clip), {});
  camera.width_px = 800;
  camera.fx_px = 700;
  const fs::path camera_file = folder / "camera.yaml";
  write_camera(camera_file, camera);
  // Each setting of the cameras that are drawn, and what it changes.
  const auto drawn_row = [&](const char* option, double mcdbn::DetectorCameras::*setting,
                             double value) {
    const std::string arguments = fmt::format("--random-camera {} {}", option, value);
    return OptionRow{
        option, [=, &projected] {
          ProjectCall call;
          call.random.emplace().*setting = value;
          CHECK(projected(arguments) == track_text(clip, call));
          CHECK(projected(arguments) != projected("--random-camera"));
          const CliResult alone = run_cli(fmt::format("project '{}' -o '{}' {} {}", clip.string(),
                                                      output.string(), option, value));
          CHECK(alone.exit_code == 2);
          CHECK(alone.standard_error.find(std::string(option) + " requires --random-camera") !=
                std::string::npos);
        }};
  };
  using Cameras = mcdbn::DetectorCameras;
  check_options(
      "project",
      {row("--random-camera", "--random-camera", [](auto& call) { call.random.emplace(); }),
       drawn_row("--detector-elevation-from", &Cameras::elevation_from_deg, 10),
       drawn_row("--detector-elevation-to", &Cameras::elevation_to_deg, 60),
       drawn_row("--detector-roll", &Cameras::roll_deg, 1),
       drawn_row("--detector-fov-from", &Cameras::fov_from_deg, 20),
       drawn_row("--detector-fov-to", &Cameras::fov_to_deg, 90),
       drawn_row("--detector-distance-from", &Cameras::distance_from_m, 12),
       drawn_row("--detector-distance-to", &Cameras::distance_to_m, 30),
       {"--like",
        [&] {
          SynthesisOptions options = short_clip();
          const fs::path human = folder / "human.bvh";
          write_bvh(human, synthesize(options));
          const auto call = [&](const std::string& like) {
            return run_cli(fmt::format("project '{}' -o '{}' --seed 4 --quiet --like '{}'",
                                       human.string(), output.string(), like));
          };
          for (const mcdbn::Detector& detector : mcdbn::detectors()) {
            REQUIRE(call(std::string(detector.name)).exit_code == 0);
            const mcdbn::Motion motion = mcdbn::load_clip(human);
            const ScratchFolder other;
            write_track_csv(other / "track.csv",
                            detector_track(motion, skeleton_roles(motion.skeleton),
                                           mcdbn::joint_set(detector.joint_set).keypoints,
                                           place_camera(motion, {}), detector.noise, 4));
            CHECK(mcdbn::read_text_file(output) == mcdbn::read_text_file(other / "track.csv"));
          }
          // A track that a detector wrote: its joints.
          REQUIRE(call("openpose").exit_code == 0);
          const fs::path own = folder / "own.csv";
          fs::copy_file(output, own, fs::copy_options::overwrite_existing);
          REQUIRE(call(own.string()).exit_code == 0);
          CHECK(mcdbn::read_track_csv(output).joint_names ==
                mcdbn::read_track_csv(own).joint_names);
          CHECK(mcdbn::read_text_file(output) != mcdbn::read_text_file(own));
          CHECK(call("nobody").exit_code == 3);
        }},
       row("--noise-px", "--noise-px 3", [](auto& call) { call.noise_px = 3; }),
       row("--seed", "--noise-px 3 --seed 6",
           [](auto& call) {
             call.noise_px = 3;
             call.seed = 6;
           }),
       row("--fps", "--fps 50", [](auto& call) { call.clip.fps = 50; }),
       row("--keep-first-frame", "--keep-first-frame",
           [](auto& call) { call.clip.keep_first_frame = true; }),
       row("--camera", fmt::format("--camera '{}'", camera_file.string()),
           [&](auto& call) { call.camera = mcdbn::read_camera(camera_file); }),
       row("--camera-azimuth", "--camera-azimuth -70",
           [](auto& call) { call.placement.azimuth_deg = -70; }),
       row("--camera-elevation", "--camera-elevation 35",
           [](auto& call) { call.placement.elevation_deg = 35; }),
       row("--camera-distance", "--camera-distance 777",
           [](auto& call) { call.placement.distance = 777; }),
       row("--camera-fov", "--camera-fov 70",
           [](auto& call) { call.placement.field_of_view_deg = 70; }),
       row("--image-size", "--image-size 640 360",
           [](auto& call) {
             call.placement.width_px = 640;
             call.placement.height_px = 360;
           }),
       {"clip", [] { CHECK(run_cli("project absent.bvh -o t.csv").exit_code == 3); }},
       {"--output", [&] { CHECK(!projected("").empty()); }},
       {"--format",
        [&] {
          CHECK(projected("--format csv") == plain);
          CHECK(projected("--format sleap").starts_with("track,frame_idx,instance.score,Hips."));
          const std::string call =
              fmt::format("project '{}' -o '{}' --format ", clip.string(), output.string());
          CHECK(run_cli(call + "openpose").exit_code == 3);  // no room for these joints
          CHECK(run_cli(call + "none").exit_code == 2);
        }},
       {"--write-camera",
        [&] {
          const fs::path written = folder / "written.yaml";
          projected(fmt::format("--camera-azimuth 12 --write-camera '{}'", written.string()));
          const ScratchFolder other;
          mcdbn::CameraPlacement placement;
          placement.azimuth_deg = 12;
          const mcdbn::Motion motion = mcdbn::load_clip(clip);
          write_camera(other / "c.yaml",
                       with_unit(place_camera(motion, placement), motion.skeleton));
          CHECK(mcdbn::read_text_file(written) == mcdbn::read_text_file(other / "c.yaml"));
        }},
       {"--quiet", [&] {
          const std::string call =
              fmt::format("project '{}' -o '{}'", clip.string(), output.string());
          CHECK(run_cli(call).standard_error.find("15 frames of 2 joints at 30 fps") !=
                std::string::npos);
          CHECK(run_cli(call + " --quiet").standard_error.find(": info: ") == std::string::npos);
        }}});
}
