#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

#include "base/counted.hpp"
#include "camera/detector_track.hpp"
#include "camera/track_noise.hpp"
#include "camera_options.hpp"
#include "clip_options.hpp"
#include "commands.hpp"
#include "detector_options.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "output_ending.hpp"
#include "setting_flags.hpp"
#include "track_options.hpp"

namespace mcdbn::cli {
namespace {

struct ProjectOptions {
  std::filesystem::path clip, output, camera_output;
  std::string format = "csv";
  CameraOptions camera;
  ClipOptions preparation;
  std::string like;
  bool random_camera = false;
  DetectorCameras cameras;
  double noise_px = 0.0;
};

Track2d seen_track(const Motion& motion, const Camera& camera, const std::string& like,
                   std::uint64_t seed) {
  if (like.empty()) return project_motion(motion, camera);
  const DetectorViews detector = detector_like(like);
  return detector_track(motion, skeleton_roles(motion.skeleton), detector.keypoints, camera,
                        detector.noise, seed);
}

void run_project(const CommandContext& context, const ProjectOptions& options) {
  check_camera_output(options.camera_output);
  const Motion motion = load_clip_with_notices(options.clip, options.preparation);
  const Camera camera = options.random_camera ? random_camera(motion, options.cameras, context.seed)
                                              : options.camera.camera_for(motion);
  Track2d track = seen_track(motion, camera, options.like, context.seed);
  add_pixel_noise(track, options.noise_px, context.seed);
  track_format(options.format).write(options.output, track);
  if (!options.camera_output.empty())
    write_camera(options.camera_output, with_unit(camera, motion.skeleton));
  spdlog::info("{}: {} of {} at {:.4g} fps", options.output.string(),
               counted(track.frames(), "frame"), counted(track.joint_count(), "joint"), track.fps);
}

}  // namespace

void add_project_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<ProjectOptions>();
  CLI::App* command =
      app.add_subcommand("project", "Projects a BVH clip through a camera to a 2D joint track");
  command->add_option("clip", options->clip, "BVH file")->required()->type_name("FILE");
  mark_output(
      command->add_option("-o,--output", options->output, "Track to write, a file or a folder"),
      context, OutputKind::file_or_folder)
      ->required()
      ->type_name("FILE");
  add_format_option(
      *command, options->format,
      "Format of the track to write; detectors' formats hold only a detector's joints (--like)")
      ->capture_default_str();
  mark_output(command->add_option("--write-camera", options->camera_output,
                                  "Also write the camera that was used, as OpenCV YAML"),
              context)
      ->type_name("FILE");
  command
      ->add_option("--like", options->like,
                   "Joints, noise and drop-outs of a detector (" + detector_names() +
                       "), or of a track file that one wrote, drawn by --seed (default: the clip's "
                       "own joints, exactly)")
      ->type_name("NAME|FILE");
  CLI::Option* random = command->add_flag("--random-camera", options->random_camera,
                                          "A camera drawn at random around the person, by --seed");
  add_setting_flag(*command, "--noise-px",
                   {"noise-px", TrackDamage::kNoise_px, "px",
                    "Standard deviation of Gaussian noise on every joint's x and y"},
                   options->noise_px);
  add_clip_options(*command, options->preparation);
  add_camera_options(*command, options->camera);
  for (CLI::Option* option : command->get_options())
    if (option->get_group() == "Camera") random->excludes(option);
  for (CLI::Option* option : add_detector_camera_flags(*command, options->cameras))
    option->needs(random);
  add_seed_option(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl project walk.bvh --camera-azimuth 30 --camera-elevation 10 -o "
      "track.csv\n"
      "  mcdbn-cl project walk.bvh --like openpose --random-camera --write-camera camera.yaml -o "
      "track.csv");
  run_with(*command, context, options, run_project);
}

}  // namespace mcdbn::cli
