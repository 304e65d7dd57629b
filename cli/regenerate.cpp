#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "fit_option.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "sample_path.hpp"
#include "sampling_options.hpp"

namespace mcdbn::cli {
namespace {

struct RegenerateOptions {
  std::filesystem::path model, input, output, camera, skeleton;
  SamplingOptions sampling;
  std::string fit = kFitTrack;
};

void run_regenerate(const CommandContext& context, const RegenerateOptions& options) {
  Device device = Device::open({context.platform, context.device});
  const Model model = load_model(device, options.model);
  ClipPlacement placement;
  if (!options.camera.empty()) placement.camera = read_camera(options.camera);
  if (!options.skeleton.empty()) placement.skeleton = read_bvh(options.skeleton).skeleton;
  placement.fit = track_fit(options.fit);
  const RegenerationOptions regeneration =
      options.sampling.regeneration(model.network, context.seed);
  TrackFeatures::FillCount filled;
  const Track2d track = read_track(options.input);
  const auto motions = regenerate_clip(model, track, placement, regeneration, &filled);
  if (filled.interpolated + filled.missing > 0)
    spdlog::info("{}: {} missing joints interpolated over short gaps, {} inferred from the others",
                 options.input.string(), filled.interpolated, filled.missing);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const auto path = sample_path(options.output, i, motions.size());
    write_bvh(path, motions[i]);
    spdlog::info("{}: {} frames at {:.4g} fps", path.string(), motions[i].frames(),
                 motions[i].fps());
  }
}

}  // namespace

void add_regenerate_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<RegenerateOptions>();
  CLI::App* command =
      app.add_subcommand("regenerate", "Regenerates 3D motion, as BVH, from a 2D track");
  command->add_option("--model", options->model, "Trained model")->required()->type_name("FILE");
  command->add_option("--input", options->input, "2D track, CSV")->required()->type_name("FILE");
  command->add_option("-o,--output", options->output, "BVH file to write")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--camera", options->camera,
                   "OpenCV YAML or XML camera that saw the track (default: the model's view, clip "
                   "at the origin)")
      ->type_name("FILE");
  command
      ->add_option("--skeleton", options->skeleton,
                   "BVH whose skeleton to use, of the same joint names")
      ->type_name("FILE");
  add_sampling_options(*command, options->sampling,
                       "Variations; several are written as out_01.bvh … (default: 1)");
  add_fit_option(*command, options->fit, "default: track");
  add_seed_option(*command, context);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl regenerate --model run/model.safetensors --input track.csv -o out.bvh\n"
      "  mcdbn-cl regenerate --model run/model.safetensors --input track.csv -o out.bvh --samples "
      "5");
  command->callback([&context, options] {
    context.run = [&context, options] { run_regenerate(context, *options); };
  });
}

}  // namespace mcdbn::cli
