#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/lower_extension.hpp"
#include "base/shown.hpp"
#include "clip_options.hpp"
#include "commands.hpp"
#include "default_model.hpp"
#include "machine_settings.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/matrix_file.hpp"
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
  return {{"kind", lower_extension(path) == ".bvh" ? "BVH clip" : "ASF/AMC clip"},
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

/// Rows and columns, where `fit` could read the file.
std::optional<std::pair<Eigen::Index, Eigen::Index>> matrix_size(const fs::path& path) {
  if (!is_matrix_file(path)) return {};
  try {
    const MatrixF values = read_matrix(path);
    return std::pair{values.rows(), values.cols()};
  } catch (const InputError&) {
    return {};
  }
}

/// What a file may be that is no track; empty if that is not known.
std::string other_use(const fs::path& path) {
  if (path.string().ends_with("metrics.jsonl"))
    return "it is the log of a training, JSON, a line an epoch";
  if (lower_extension(path) != ".npy" && track_format_of(path)) return {};
  if (const auto size = matrix_size(path))
    return fmt::format("it is a matrix of {} x {} numbers, for `mcdbn-cl fit`", size->first,
                       size->second);
  return {};
}

TrackReading tracks_in(const fs::path& path, const TrackReadOptions& options) {
  try {
    return read_tracks(path, options);
  } catch (const InputError& error) {
    const std::string use = options.format.empty() ? other_use(path) : "";
    if (use.empty()) throw;
    throw InputError(fmt::format("{}; {}", error.what(), use));
  }
}

json describe_track(const fs::path& path, const TrackReadOptions& options) {
  const TrackReading reading = tracks_in(path, options);
  const Track2d& track = reading.people.front();
  json joints = json::array(), roles = json::object(), people = json::array();
  for (const std::string& name : track.joint_names) joints.push_back(name);
  for (const Keypoint& keypoint : track.keypoints)
    roles[keypoint.name] = keypoint.role ? json(name_of(*keypoint.role)) : json();
  for (const Track2d& person : reading.people)
    people.push_back(describe_person(person, reading.frame_numbers));
  json notices = json::array();
  for (const std::string& notice : reading.notices) notices.push_back(with_flags(notice));
  if (const auto size = reading.format == "npy" ? matrix_size(path) : std::nullopt)
    notices.push_back(fmt::format(
        "a matrix of {} x {} numbers, read as a frame a row; `mcdbn-cl fit` reads it as data",
        size->first, size->second));
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
  json cameras = json::array(), notices = rig.assumed;
  for (const std::string& line : rig.stated) notices.push_back(line);
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
  return {{"kind", "cameras"}, {"format", format.name}, {"cameras", cameras}, {"notices", notices}};
}

/// @throws InputError for a folder that holds no track, with what to give in its place if that is
/// known
void check_folder(const fs::path& folder) {
  const auto holds = [](auto entries, const auto& test) {
    return std::any_of(begin(entries), end(entries),
                       [&](const fs::directory_entry& entry) { return test(entry.path()); });
  };
  if (holds(fs::directory_iterator(folder),
            [](const fs::path& file) { return lower_extension(file) == ".json"; }))
    return;
  if (const fs::path model = folder / "model.safetensors"; fs::exists(model))
    throw InputError(fmt::format("{}: the folder of a training; its model is {}", folder.string(),
                                 model.string()));
  if (holds(fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied),
            is_motion_file))
    throw InputError(fmt::format("{}: a folder of clips; `mcdbn-cl corpus {}` describes them",
                                 folder.string(), folder.string()));
}

json describe(const fs::path& path, const TrackReadOptions& options) {
  if (!fs::exists(path)) throw InputError(fmt::format("{}: no such file", path.string()));
  const std::string extension = lower_extension(path);
  if (is_motion_file(path)) return describe_clip(path);
  if (extension == ".safetensors") {
    if (is_machine_file(path)) return describe_machine(path);
    json description = describe_model(path);
    description["kind"] = "trained model";
    return description;
  }
  if (fs::is_directory(path))
    check_folder(path);
  else if (const CameraFormat* format = camera_format_of(path))
    return describe_cameras(path, *format);
  else if (extension == ".toml" && options.format.empty())
    throw InputError(
        fmt::format("{}: no calibration; a list of clips is for `mcdbn-cl train`, "
                    "settings are for its option --config",
                    path.string()));
  return describe_track(path, options);
}

/// Each value on a line of its own. @param width of the keys
void print_value(const std::string& key, const json& value, const std::string& indent,
                 std::size_t width) {
  const std::string text = value.is_number_float() ? fmt::format("{:.6g}", value.get<double>())
                           : value.is_string()     ? printable(value.get<std::string>())
                                                   : json_text(value);
  std::cout << fmt::format("{}{:<{}} {}\n", indent, key, width, text);
}

/// Width of the longest key whose value stands beside it.
std::size_t width_of_keys(const json& object) {
  std::size_t width = 21;
  for (const auto& [key, value] : object.items())
    if (!value.is_structured()) width = std::max(width, key.size());
  return width;
}

void print_fields(const json& object, const std::string& indent) {
  const std::size_t width = width_of_keys(object);
  for (const auto& [key, value] : object.items()) print_value(key, value, indent, width);
}

void print_list(const std::string& key, const json& list, const json& roles, std::size_t width) {
  std::cout << fmt::format("{:<{}} {}\n", key, width, list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].is_object()) {
      std::cout << fmt::format("  {}\n", i + 1);
      print_fields(list[i], "    ");
      continue;
    }
    const std::string name = list[i].is_string() ? list[i].get<std::string>() : list[i].dump();
    const json role = key == "joints" ? roles.value(name, json()) : json();
    std::cout << (role.is_null()
                      ? fmt::format("  {}\n", printable(name))
                      : fmt::format("  {:<20}{}\n", printable(name), role.get<std::string>()));
  }
}

/// Lists of names line by line; people, cameras and settings each with their values.
void print_for_people(const json& description) {
  const json roles = description.value("roles", json::object());
  const std::size_t width = width_of_keys(description);
  for (const auto& [key, value] : description.items()) {
    if (key == "roles") continue;
    if (value.is_array()) {
      print_list(key, value, roles, width);
    } else if (value.is_object()) {
      std::cout << key << '\n';
      print_fields(key == "config" ? settings_of(description) : value, "  ");
    } else {
      print_value(key, value, "", width);
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
  options->person = "all";
  add_track_options(*command, *options);
  add_json_option(*command, context);
  add_quiet_option(*command, context);
  command->footer("Example:\n  mcdbn-cl info walk.bvh\n  mcdbn-cl info openpose_json/");
  command->callback([&context, path, options] {
    context.run = [&context, path, options] {
      const json description = describe(model_or_default(*path, "no file"), *options);
      if (context.json) {
        print_json(description);
      } else {
        print_for_people(description);
      }
    };
  });
}

}  // namespace mcdbn::cli
