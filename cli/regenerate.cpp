#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "base/named_errors.hpp"
#include "camera/shown_body.hpp"
#include "camera_options.hpp"
#include "clip_options.hpp"
#include "commands.hpp"
#include "comparison/fitted_baseline.hpp"
#include "default_model.hpp"
#include "fit_option.hpp"
#include "follow.hpp"
#include "formats/csv_text.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/joint_map.hpp"
#include "mcdbn/formats/motion_file.hpp"
#include "mcdbn/formats/track_csv.hpp"
#include "mcdbn/formats/uncertainty_csv.hpp"
#include "mcdbn/motion/humanoid_rig.hpp"
#include "mcdbn/motion_model/clip_regeneration.hpp"
#include "motion_model/keypoint_columns.hpp"
#include "regenerate_options.hpp"
#include "regeneration_reports.hpp"
#include "sample_path.hpp"
#include "sampling_options.hpp"
#include "track_options.hpp"

namespace mcdbn::cli {
namespace {

/// By the model, or by a simpler method if there is one. Errors of the track begin with its name.
std::vector<Motion> regenerate_named(const std::string& name, const Model& model,
                                     const Baseline* simpler, const Track2d& track,
                                     const ClipPlacement& placement,
                                     const RegenerationOptions& regeneration,
                                     TrackFindings& findings) {
  return with_name(name, [&] {
    if (simpler == nullptr)
      return regenerate_clip(model, track, placement, regeneration, &findings);
    const auto single = [&](const MatrixF& features) { return simpler->predict(features); };
    return regenerate_clip(
        model.modalities, track, placement, single,
        [&](const MatrixF& features) { return std::vector<PosePrior>{single(features)}; },
        &findings);
  });
}

/// The track's name, with the person's number if there are several.
std::string person_name(const std::filesystem::path& input, std::size_t person,
                        std::size_t people) {
  return people == 1 ? input.string() : fmt::format("{}: person {}", input.string(), person + 1);
}

/// Where a person's motion goes: out_person1.bvh … if there are several.
std::filesystem::path person_path(const std::filesystem::path& output, std::size_t person,
                                  std::size_t people) {
  if (people == 1) return output;
  std::filesystem::path path = output;
  return path.replace_filename(fmt::format("{}_person{}{}", output.stem().string(), person + 1,
                                           output.extension().string()));
}

/// Checks the joint map, that the model's motion can be put on a skeleton of other joints, and that
/// the uncertainty's CSV can name the joints; warns of motion that is lost.
/// @throws InputError naming the file that is at fault
void check_body(const Modalities& modalities, const RegenerateOptions& options,
                const ClipPlacement& placement) {
  const Skeleton& own = modalities.pose_features.skeleton();
  const Skeleton& wanted = placement.skeleton ? *placement.skeleton : own;
  const SkeletonRoles roles = with_name(
      options.joint_map.string(), [&] { return skeleton_roles(wanted, placement.joint_map); });
  if (!options.uncertainty.empty())
    with_name(options.uncertainty.string(), [&] {
      for (const Joint& joint : wanted.joints) require_csv_name(joint.name);
    });
  if (!is_other_skeleton(modalities, wanted)) return;
  const std::vector<JointRole> lost = with_name(options.skeleton.string(), [&] {
    return lost_roles(HumanoidRig({wanted, 1.0, placement.skeleton_channels}, roles).roles());
  });
  if (lost.empty()) return;
  std::vector<std::string_view> names;
  names.reserve(lost.size());
  for (const JointRole role : lost) names.push_back(name_of(role));
  spdlog::warn(
      "{}: no joint has the roles {}; their motion is lost. Name them with --joint-map; "
      "`mcdbn-cl info` shows the known roles",
      options.skeleton.string(), fmt::join(names, ", "));
}

ClipPlacement placement_of(const Modalities& modalities, const RegenerateOptions& options,
                           const std::optional<Camera>& camera, std::uint64_t seed) {
  ClipPlacement placement;
  placement.camera = camera;
  placement.view = options.seen_by.view;
  if (!options.skeleton.empty()) {
    std::vector<std::string> warnings;
    Motion clip = read_motion(options.skeleton, &warnings);
    for (const std::string& warning : warnings) spdlog::warn("{}", warning);
    placement.skeleton = std::move(clip.skeleton);
    placement.skeleton_channels = std::move(clip.channels);
  }
  placement.fit = track_fit(options.fit);
  // The uncertainty of the network alone is always estimated: that costs less than a fit.
  const bool single = options.sampling.samples.value_or(1) == 1;
  if (!options.uncertainty.empty() || (single && !placement.fit))
    placement.uncertainty_draws = {kUncertaintyDraws, seed};
  if (!options.joint_map.empty()) placement.joint_map = read_joint_map(options.joint_map);
  check_body(modalities, options, placement);
  return placement;
}

/// What shows how the camera stands; empty where that is not estimated.
/// @param track with keypoints
std::string shows_angles(const Modalities& modalities, const ClipPlacement& placement,
                         const Track2d& track) {
  const AssumedView& given = placement.view;
  if (!placement.fit || !finds_view(modalities, placement) || (given.pitch_deg && given.roll_deg))
    return {};
  return shows_feet(track) ? "feet on level ground" : "the posture: no foot is seen";
}

/// Warns what is assumed of a camera without calibration, and where the film may be stored turned.
/// @param track with keypoints  @param axes_are_unnamed as in TrackReading
void report_unknown_camera(const std::string& name, const Track2d& track, bool axes_are_unnamed,
                           const Modalities& modalities, const ClipPlacement& placement,
                           const Camera& assumed) {
  if (!placement.view.roll_deg) report_turned(name, track, axes_are_unnamed);
  report_assumed(assumed, shows_angles(modalities, placement, track));
}

/// Writes one of the track's people: each variation's motion, and what else was asked for.
void write_person(const RegenerateOptions& options, std::size_t person, std::size_t people,
                  const std::vector<Motion>& motions, const TrackFindings& findings) {
  if (!options.write_camera.empty())
    write_camera(person_path(options.write_camera, person, people), findings.camera);
  const auto output = person_path(options.output, person, people);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const auto path = sample_path(output, i, motions.size());
    write_bvh(path, motions[i]);
    report_written(path, motions[i].frames(), motions[i].fps());
  }
  report_uncertainty(motions.front(), findings.uncertainty);
  if (!options.uncertainty.empty())
    write_uncertainty_csv(person_path(options.uncertainty, person, people), motions.front(),
                          findings.uncertainty);
}

void regenerate_poses(const Model& model, const RegenerateOptions& options,
                      const std::optional<Camera>& camera,
                      const RegenerationOptions& regeneration) {
  ClipPlacement placement = placement_of(model.modalities, options, camera, regeneration.seed);
  TrackReadOptions reading = options.track;
  if (camera) reading.camera_image = {camera->width_px, camera->height_px};
  const TrackReading read = read_tracks_with_notices(options.input, reading);
  report_first_frame(options.input, read.frame_numbers);
  const std::vector<Track2d>& people = read.people;
  if (camera) placement.camera = camera_of_track(*camera, people.front(), options.input.string());
  const std::unique_ptr<Baseline> simpler =
      options.method == kModel
          ? nullptr
          : fitted_baseline(options.method, model, training_data_of(options.method, model));
  bool anybody = false;
  for (std::size_t person = 0; person < people.size(); ++person) {
    TrackFindings findings;
    const std::string name = person_name(options.input, person, people.size());
    std::vector<Motion> motions;
    try {
      motions = regenerate_named(name, model, simpler.get(), people[person], placement,
                                 regeneration, findings);
    } catch (const InputError& error) {
      if (people.size() == 1) throw;
      spdlog::warn("{}; this person is left out", error.what());
      continue;
    }
    anybody = true;
    Track2d track = people[person];
    track.keypoints = keypoints_of_columns(track);
    report_findings(name, track, read.frame_numbers, findings);
    report_sliding_feet(name, track, motions.front());
    if (!placement.camera) {
      report_unknown_camera(name, track, read.axes_are_unnamed, model.modalities, placement,
                            findings.camera);
      placement.camera = findings.camera;  // all others stand in the first one's world
    }
    write_person(options, person, people.size(), motions, findings);
  }
  if (!anybody)
    throw InputError(
        fmt::format("{}: nobody shows enough to be regenerated", options.input.string()));
}

void follow(const Model& model, const RegenerateOptions& options,
            const std::optional<Camera>& camera, std::uint64_t seed) {
  TrackReadOptions reading = options.track;
  if (camera) reading.camera_image = {camera->width_px, camera->height_px};
  if (model.network.sampling.sampled)
    spdlog::info("frames are the model's mean answer: it draws samples for whole tracks only");
  follow_track(model, options.input.empty() ? "-" : options.input, options.output, reading,
               placement_of(model.modalities, options, camera, seed), options.following);
}

void regenerate_tracks(const Model& model, const RegenerateOptions& options,
                       const std::optional<Camera>& camera,
                       const RegenerationOptions& regeneration) {
  with_name(options.output.string(), [&] {
    require_csv_name(model.modalities.root_name());
    for (const std::string& name : model.modalities.track_features.joint_names())
      require_csv_name(name);
  });
  const Motion clip = load_clip_with_notices(
      options.input, {.fps = model.modalities.fps, .keep_first_frame = options.keep_first_frame});
  const auto tracks = regenerate_track(model, clip, regeneration, camera);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const auto path = sample_path(options.output, i, tracks.size());
    write_track_csv(path, tracks[i]);
    report_written(path, tracks[i].frames(), tracks[i].fps);
  }
}

void run_regenerate(const CommandContext& context, const RegenerateOptions& options) {
  check_options(options);
  Device device = Device::open({context.platform, context.device});
  const Model model = load_model(device, model_or_default(options.model));
  const std::optional<Camera> camera = options.seen_by.camera();
  const RegenerationOptions regeneration =
      options.sampling.regeneration(model.network, context.seed);
  if (options.following.follow)
    follow(model, options, camera, regeneration.seed);
  else if (options.to == kToTrack)
    regenerate_tracks(model, options, camera, regeneration);
  else
    regenerate_poses(model, options, camera, regeneration);
}

}  // namespace

void add_regenerate_command(CLI::App& app, CommandContext& context) {
  auto options = std::make_shared<RegenerateOptions>();
  CLI::App* command = app.add_subcommand(
      "regenerate", "Regenerates 3D motion, as BVH, from a 2D track; or a track from motion");
  add_model_option(*command, options->model);
  command
      ->add_option("--input", options->input,
                   "2D track, a file or a folder; with --to track a BVH clip")
      ->type_name("FILE");
  mark_output(command->add_option("-o,--output", options->output,
                                  "BVH file to write; with --to track a 2D track, CSV"),
              context)
      ->type_name("FILE");
  command
      ->add_option("--to", options->to,
                   "pose: 3D from 2D; track: 2D from 3D, at the model's rate, in pixels of the "
                   "camera's image")
      ->check(CLI::IsMember({kToPose, kToTrack}))
      ->capture_default_str();
  add_keep_first_frame_option(*command, options->keep_first_frame);
  add_seen_by_options(*command, options->seen_by);
  command
      ->add_option("--skeleton", options->skeleton,
                   "BVH file whose skeleton to use; other joint names are matched by their roles")
      ->type_name("FILE");
  command
      ->add_option("--joint-map", options->joint_map,
                   "TOML with lines such as left_hip = \"LeftUpLeg\": which joint of the skeleton "
                   "plays which role, where its names and shape do not show it; for tracks of "
                   "detectors")
      ->type_name("FILE");
  std::vector<std::string> methods = all_baselines();
  methods.insert(methods.begin(), kModel);
  command
      ->add_option("--method", options->method,
                   "Method to use: the model, or a simpler one that learns from the model's "
                   "training clips, which must still be where they were")
      ->check(CLI::IsMember(methods))
      ->capture_default_str();
  mark_output(
      command->add_option(
          "--write-camera", options->write_camera,
          "Also write the camera that projects the motion onto the track, given or assumed, "
          "as OpenCV YAML: for render --over"),
      context)
      ->type_name("FILE");
  mark_output(command->add_option(
                  "--uncertainty", options->uncertainty,
                  "Also write the motion's uncertainty, as CSV: each joint's standard deviation in "
                  "each frame, along the world's axes, in the BVH file's unit"),
              context)
      ->type_name("FILE");
  add_track_options(*command, options->track);
  add_sampling_options(*command, options->sampling,
                       "Number of variations; several are written as out_01.bvh … (default: 1)");
  add_fit_option(*command, options->fit, "default: track");
  add_follow_options(*command, options->following);
  add_seed_option(*command, context);
  add_device_options(*command, context);
  add_quiet_option(*command, context);
  command->footer(
      "Example:\n  mcdbn-cl regenerate --model run/model.safetensors --input track.csv -o out.bvh\n"
      "  mcdbn-cl regenerate --model run/model.safetensors --input track.csv -o out.bvh --samples "
      "5\n"
      "  mcdbn-cl regenerate --model run/model.safetensors --to track --input walk.bvh -o "
      "track.csv");
  run_with(*command, context, options, run_regenerate);
}

}  // namespace mcdbn::cli
