#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "clip_options.hpp"
#include "commands.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/machines/machine_file.hpp"
#include "mcdbn/motion_model/model_file.hpp"

namespace mcdbn::cli {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json describe_clip(const fs::path& path) {
  const Motion motion = load_clip_with_notices(path, {.fps = 0.0, .keep_first_frame = true});
  json joints = json::array();
  for (const Joint& joint : motion.skeleton.joints) joints.push_back(joint.name);
  return {{"kind", "BVH clip"},
          {"joints", joints},
          {"channels", motion.skeleton.channel_count()},
          {"frames", motion.frames()},
          {"fps", motion.fps()},
          {"duration_s", motion.frames() * motion.frame_time_s},
          {"height_units", motion.skeleton.rest_height()}};
}

json describe_track(const fs::path& path) {
  const Track2d track = read_track(path);
  return {{"kind", "2D track"},
          {"joints", track.joint_names},
          {"frames", track.frames()},
          {"fps", track.fps},
          {"duration_s", track.frames() / track.fps},
          {"width_px", track.width_px},
          {"height_px", track.height_px},
          {"missing_joint_frames", (track.x_px.array() != track.x_px.array()).count()}};
}

json describe(const fs::path& path) {
  if (!fs::exists(path)) throw InputError(fmt::format("{}: no such file", path.string()));
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char letter) { return std::tolower(letter); });
  if (extension == ".bvh") return describe_clip(path);
  if (extension == ".safetensors") {
    if (is_machine_file(path)) return describe_machine(path);
    json description = describe_model(path);
    description["kind"] = "trained model";
    return description;
  }
  if (fs::is_regular_file(path) && track_format_of(path) != nullptr) return describe_track(path);
  throw InputError(fmt::format("{}: unknown kind of file; give a .bvh, a .csv or a .safetensors",
                               path.string()));
}

void print_for_people(const json& description) {
  for (const auto& [key, value] : description.items()) {
    if (key == "joints" || key == "training_clips") {
      std::cout << fmt::format("{:<22}{}\n", key, value.size());
      for (const auto& name : value) std::cout << "  " << name.get<std::string>() << '\n';
    } else if (value.is_number_float()) {
      std::cout << fmt::format("{:<22}{:.6g}\n", key, value.get<double>());
    } else {
      std::cout << fmt::format("{:<22}{}\n", key,
                               value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
}

}  // namespace

void add_info_command(CLI::App& app, CommandContext& context) {
  auto path = std::make_shared<fs::path>();
  CLI::App* command =
      app.add_subcommand("info", "Describes a BVH clip, a 2D track, a trained model or a machine");
  command->add_option("file", *path, "BVH, track CSV, model or machine")
      ->required()
      ->type_name("FILE");
  add_json_option(*command, context);
  command->footer("Example:\n  mcdbn-cl info walk.bvh");
  command->callback([&context, path] {
    context.run = [&context, path] {
      const json description = describe(*path);
      if (context.json) {
        print_json(description);
      } else {
        print_for_people(description);
      }
    };
  });
}

}  // namespace mcdbn::cli
