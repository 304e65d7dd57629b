#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/shown.hpp"
#include "clip_options.hpp"
#include "commands.hpp"
#include "default_model.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/track_stretches.hpp"
#include "mcdbn/camera/track_summary.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/motion_file.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/machines/machine_file.hpp"
#include "mcdbn/motion/skeleton_roles.hpp"
#include "mcdbn/motion_model/model_file.hpp"
#include "setting_flags.hpp"
#include "track_options.hpp"

namespace mcdbn::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char letter) { return std::tolower(letter); });
  return extension;
}

json describe_clip(const fs::path& path) {
  const Motion motion = load_clip_with_notices(path, {.fps = 0.0, .keep_first_frame = true});
  const SkeletonRoles known = skeleton_roles(motion.skeleton);
  json joints = json::array(), roles = json::object(), missing = json::array();
  for (const Joint& joint : motion.skeleton.joints) {
    const auto role = known.role_of(static_cast<int>(joints.size()));
    roles.emplace(joint.name, role ? json(name_of(*role)) : json());  // the first of a name counts
    joints.push_back(joint.name);
  }
  for (const JointRole role : known.missing()) missing.push_back(name_of(role));
  return {{"kind", extension_of(path) == ".bvh" ? "BVH clip" : "ASF/AMC clip"},
          {"joints", joints},
          {"roles", roles},
          {"roles_without_joint", missing},
          {"channels", motion.skeleton.channel_count()},
          {"frames", motion.frames()},
          {"fps", motion.fps()},
          {"duration_s", motion.frames() * motion.frame_time_s},
          {"height_units", motion.skeleton.rest_height()}};
}

/// NaN, which JSON has not, as null.
json finite(double value) {
  return std::isfinite(value) ? json(value) : json();
}

/// @param numbers of the frames, the file's own
json describe_person(const Track2d& track, const std::vector<long long>& numbers) {
  const TrackSummary summary = summarize(track);
  json unseen = json::array();
  for (int joint = 0; joint < track.joint_count(); ++joint)
    if (summary.joint_seen_share[joint] == 0) unseen.push_back(track.joint_names[joint]);
  json person{{"seen_frames", summary.seen_frames},
              {"longest_gap_frames", summary.longest_gap_frames},
              {"missing_joint_frames", summary.missing_joints},
              {"joints_never_seen", unseen},
              {"height_px", summary.height_px},
              {"jitter_px", finite(summary.jitter_px)}};
  if (summary.seen_frames > 0) {
    person["first_frame"] = numbers[summary.first_frame];
    person["last_frame"] = numbers[summary.last_frame];
  }
  json jumps = json::array();
  for (const FrameRange& stretch : find_stretches(track).stretches)
    if (stretch.first > 0) jumps.push_back(numbers[stretch.first]);
  person["jumps_to_frames"] = jumps;
  return person;
}

json describe_track(const fs::path& path, TrackReadOptions options) {
  if (options.person == TrackReadOptions{}.person) options.person = "all";
  const TrackReading reading = read_tracks(path, options);
  const Track2d& track = reading.people.front();
  json joints = json::array(), roles = json::object(), people = json::array();
  for (const std::string& name : track.joint_names) joints.push_back(name);
  for (const Keypoint& keypoint : track.keypoints)
    roles[keypoint.name] = keypoint.role ? json(name_of(*keypoint.role)) : json();
  for (const Track2d& person : reading.people)
    people.push_back(describe_person(person, reading.frame_numbers));
  json notices = json::array();
  for (const std::string& notice : reading.notices) notices.push_back(with_flags(notice));
  return {{"kind", "2D track"},
          {"format", reading.format},
          {"joint_set", reading.joint_set.empty() ? json() : json(reading.joint_set)},
          {"joints", joints},
          {"roles", roles},
          {"frames", track.frames()},
          {"fps", track.fps},
          {"duration_s", track.frames() / track.fps},
          {"width_px", track.width_px},
          {"height_px", track.height_px},
          {"missing_joint_frames", (track.x_px.array() != track.x_px.array()).count()},
          {"people_seen", reading.people_seen},
          {"people", people},
          {"notices", notices}};
}

json describe_cameras(const fs::path& path, const CameraFormat& format) {
  const CameraRig rig = read_cameras(path);
  json cameras = json::array();
  for (const auto& [name, camera] : rig.cameras) {
    const Eigen::Vector3d centre = -camera.camera_from_world.transpose() * camera.translation;
    cameras.push_back({{"name", name},
                       {"width_px", camera.width_px},
                       {"height_px", camera.height_px},
                       {"fx_px", camera.fx_px},
                       {"fy_px", camera.fy_px},
                       {"distortions", camera.distortion.size()},
                       {"fisheye", camera.fisheye},
                       {"centre", {centre.x(), centre.y(), centre.z()}},
                       {"unit_m", camera.unit_m ? json(*camera.unit_m) : json()}});
  }
  return {
      {"kind", "cameras"}, {"format", format.name}, {"cameras", cameras}, {"notices", rig.assumed}};
}

json describe(const fs::path& path, const TrackReadOptions& options) {
  if (!fs::exists(path)) throw InputError(fmt::format("{}: no such file", path.string()));
  const std::string extension = extension_of(path);
  if (is_motion_file(path)) return describe_clip(path);
  if (extension == ".safetensors") {
    if (is_machine_file(path)) return describe_machine(path);
    json description = describe_model(path);
    description["kind"] = "trained model";
    return description;
  }
  if (const CameraFormat* format = fs::is_directory(path) ? nullptr : camera_format_of(path))
    return describe_cameras(path, *format);
  return describe_track(path, options);
}

void print_value(const std::string& key, const json& value, const std::string& indent) {
  const std::string text = value.is_number_float() ? fmt::format("{:.6g}", value.get<double>())
                           : value.is_string()     ? printable(value.get<std::string>())
                                                   : json_text(value);
  std::cout << fmt::format("{}{:<21} {}\n", indent, key, text);
}

/// Lists of names line by line; people and cameras each with their values.
void print_for_people(const json& description) {
  const json roles = description.value("roles", json::object());
  for (const auto& [key, value] : description.items()) {
    if (key == "roles") continue;
    if (!value.is_array()) {
      print_value(key, value, "");
      continue;
    }
    std::cout << fmt::format("{:<22}{}\n", key, value.size());
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (!value[i].is_object()) {
        const std::string name =
            value[i].is_string() ? value[i].get<std::string>() : value[i].dump();
        const json role = key == "joints" ? roles.value(name, json()) : json();
        std::cout << (role.is_null()
                          ? fmt::format("  {}\n", printable(name))
                          : fmt::format("  {:<20}{}\n", printable(name), role.get<std::string>()));
        continue;
      }
      std::cout << fmt::format("  {}\n", i + 1);
      for (const auto& [field, content] : value[i].items()) print_value(field, content, "    ");
    }
  }
}

}  // namespace

void add_info_command(CLI::App& app, CommandContext& context) {
  auto path = std::make_shared<fs::path>();
  auto options = std::make_shared<TrackReadOptions>();
  CLI::App* command = app.add_subcommand(
      "info", "Describes a clip, a 2D track, cameras, a trained model or a machine");
  command
      ->add_option("file", *path,
                   "BVH, AMC, track (a file or a folder), calibration, model or machine (default: "
                   "the model that comes with the program)")
      ->type_name("FILE");
  add_track_options(*command, *options);
  add_json_option(*command, context);
  command->footer("Example:\n  mcdbn-cl info walk.bvh\n  mcdbn-cl info openpose_json/");
  command->callback([&context, path, options] {
    context.run = [&context, path, options] {
      const json description = describe(path->empty() ? model_or_default({}) : *path, *options);
      if (context.json) {
        print_json(description);
      } else {
        print_for_people(description);
      }
    };
  });
}

}  // namespace mcdbn::cli
