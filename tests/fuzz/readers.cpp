#include "fuzz/readers.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "base/parsed_json.hpp"
#include "base/safetensors.hpp"
#include "base/shown.hpp"
#include "base/text_file.hpp"
#include "comparison/sweep.hpp"
#include "formats/asf_amc.hpp"
#include "learning/checkpoint_file.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/base/matrix_file.hpp"
#include "mcdbn/corpus/clip_list.hpp"
#include "mcdbn/formats/bvh.hpp"
#include "mcdbn/formats/camera_file.hpp"
#include "mcdbn/formats/joint_map.hpp"
#include "mcdbn/formats/track_file.hpp"
#include "mcdbn/formats/track_lines.hpp"
#include "mcdbn/motion/frame_rate.hpp"
#include "mcdbn/motion_model/settings_record.hpp"
#include "motion_model/modalities_json.hpp"
#include "motion_model/run_record.hpp"

namespace mcdbn::test {
namespace {

namespace fs = std::filesystem;

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

/// It can be written, and reads as the same again.
void check_motion(const Motion& motion) {
  const Motion again = parse_bvh(bvh_text(motion), "again.bvh");
  require(again.channels.rows() == motion.channels.rows() &&
              again.channels.cols() == motion.channels.cols() &&
              again.skeleton.joint_count() == motion.skeleton.joint_count(),
          "a motion that reads otherwise once it is written");
  require(motion.channels.allFinite(), "a channel that is no number");
}

void read_bvh_file(const fs::path& path) {
  check_motion(read_bvh(path));
}

/// One file holds both, the skeleton before the line `:MOTION`.
void read_asf_amc(const fs::path& path) {
  const std::string text = read_text_file(path);
  const auto at = std::min(text.find(":MOTION\n"), text.size());
  check_motion(parse_asf_amc(text.substr(0, at), path.string(), std::string_view(text).substr(at),
                             path.string(), nullptr));
}

void read_all_tracks(const fs::path& path, const std::string& format) {
  for (const Track2d& track : read_tracks(path, {.format = format, .person = "all"}).people) {
    require(track.frames() > 0, "a track without frames");
    require(kFrameRate_hz.contains(track.fps), "a frame rate that is none");
    require(
        Camera::kImage_px.contains(track.width_px) && Camera::kImage_px.contains(track.height_px),
        "an image size that is none");
    require((track.x_px.array().isNaN() == (track.confidence.array() == 0)).all(),
            "a joint that is seen nowhere");
  }
}

/// Line by line, up to the first that is broken.
void read_track_lines(const fs::path& path) {
  TrackLines lines(path.string(), {.image_size = ImageSize{1280, 720}});
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    const std::optional<TrackFrame> frame = lines.read(line);
    if (!frame) continue;
    require(frame->joints() == (lines.knows_joints() ? lines.like().joint_count() : 0),
            "a frame of other joints");
    require((frame->x_px.array().isNaN() == (frame->confidence.array() == 0)).all(),
            "a joint that is seen nowhere");
  }
}

void read_all_cameras(const fs::path& path) {
  for (const NamedCamera& named : read_cameras(path).cameras) {
    const Camera& camera = named.camera;
    require(
        Camera::kImage_px.contains(camera.width_px) && Camera::kImage_px.contains(camera.height_px),
        "an image size that is none");
    require(camera.camera_from_world.allFinite() && camera.translation.allFinite(),
            "a pose that is none");
  }
}

void read_settings(const fs::path& path) {
  TrainingConfig config;
  assign_settings(config, read_settings_file(path));
  config.validate();
}

void read_model_modalities(const fs::path& path) {
  const auto parsed = parsed_json(read_text_file(path));
  const Modalities modalities = modalities_from({parsed, path.string()});
  require(modalities.pose_features.skeleton().find(modalities.track_features.root_name()) >= 0,
          "a root that no skeleton has");
}

/// It can be written, and reads as the same again.
void read_all_of_checkpoint(const fs::path& path) {
  const CheckpointContent content = read_checkpoint(path);
  const fs::path again = path.string() + ".again";
  write_checkpoint(again, content);
  const CheckpointContent same = read_checkpoint(again);
  require(same.finished_stages.size() == content.finished_stages.size() &&
              same.running_stage == content.running_stage &&
              same.done_minibatches == content.done_minibatches &&
              same.running_state.numbers == content.running_state.numbers &&
              same.running_state.matrices.size() == content.running_state.matrices.size() &&
              same.extra_state.numbers == content.extra_state.numbers,
          "a checkpoint that reads otherwise once it is written");
}

std::vector<Reader> all_readers() {
  std::vector<Reader> all = {
      {"bvh", ".bvh", read_bvh_file},
      {"asf-amc", ".amc", read_asf_amc},
      {"camera", "", read_all_cameras},
      {"settings", ".toml", read_settings},
      {"sweep", ".toml", [](const fs::path& path) { read_sweep_file(path); }},
      {"joint-map", ".toml", [](const fs::path& path) { read_joint_map(path); }},
      {"clip-list", ".toml", [](const fs::path& path) { read_clip_list(path); }},
      {"matrix-npy", ".npy", [](const fs::path& path) { read_matrix(path); }},
      {"matrix-csv", ".csv", [](const fs::path& path) { read_matrix(path); }},
      {"safetensors", ".safetensors", [](const fs::path& path) { read_safetensors(path); }},
      {"model", ".json", read_model_modalities},
      {"checkpoint", ".safetensors", read_all_of_checkpoint},
      {"run", ".json", [](const fs::path& path) { read_run_record(path); }},
      {"track", "", [](const fs::path& path) { read_all_tracks(path, {}); }},
      {"track-lines", "", read_track_lines},
  };
  for (const TrackFormat& format : track_formats())
    all.push_back({"track-" + format.name, "",
                   [name = format.name](const fs::path& path) { read_all_tracks(path, name); }});
  return all;
}

/// One for all inputs of the process, as millions are read.
fs::path own_folder() {
  std::string pattern = (fs::temp_directory_path() / "fuzz-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no folder for inputs");
  return pattern;
}

/// @param bytes that were read: words of theirs may be repeated, such as a file's name
void check_message(const std::string& message, const fs::path& path, std::string_view bytes) {
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) throw std::logic_error(what + ": " + printable(message));
  };
  require(message.find(path.stem().string()) != std::string::npos, "a message without the file");
  require(std::ranges::none_of(message,
                               [](char c) { return std::iscntrl(static_cast<unsigned char>(c)); }),
          "a message with control bytes");
  constexpr std::size_t kLongest = 1000;
  require(message.size() < kLongest, "a message with kilobytes of input in it");
  // Input stands in quotes.
  const std::string own = std::regex_replace(message, std::regex("'.*'"), "''");
  for (const char* raw : {"exception", "assert", "OpenCV(", "std::"})
    require(own.find(raw) == std::string::npos || bytes.find(raw) != std::string_view::npos,
            "a message that is a library's own");
}

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = all_readers();
  return all;
}

std::string refusal(const Reader& reader, std::string_view bytes) {
  static const fs::path folder = own_folder();
  const fs::path path = folder / ("input" + reader.ending);
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  std::string message;
  try {
    reader.read(path);
  } catch (const InputError& error) {
    message = error.what();
  } catch (const ConfigError& error) {
    require(reader.ending == ".toml", "a ConfigError of what is no setting");
    message = error.what();
  }
  if (!message.empty()) check_message(message, path, bytes);
  return message;
}

}  // namespace mcdbn::test
