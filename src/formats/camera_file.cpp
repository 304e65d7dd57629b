#include "mcdbn/formats/camera_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>

#include "base/text_file.hpp"
#include "formats/camera_formats.hpp"
#include "formats/camera_parts.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {
namespace {

CameraSource source_of(const std::filesystem::path& path) {
  std::error_code error;
  constexpr std::uintmax_t kLargest_bytes = 4'000'000;
  if (std::filesystem::is_regular_file(path, error) &&
      std::filesystem::file_size(path, error) > kLargest_bytes)
    throw InputError(fmt::format("{}: larger than any camera file (4 MB)", path.string()));
  CameraSource source{path, read_text_file(path)};
  check_camera_source(source);
  return source;
}

const CameraFormat* format_of(const CameraSource& source) {
  const auto found = std::ranges::find_if(
      camera_formats(), [&](const CameraFormat& format) { return format.recognises(source); });
  return found == camera_formats().end() ? nullptr : &*found;
}

std::vector<std::string> names_of(const CameraRig& rig) {
  std::vector<std::string> names;
  for (const NamedCamera& camera : rig.cameras) names.push_back(camera.name);
  return names;
}

/// The file of FILE or FILE:NAME, and the name.
std::pair<std::filesystem::path, std::optional<std::string>> file_and_name(
    const std::filesystem::path& path) {
  const std::string text = path.string();
  const auto colon = text.rfind(':');
  if (std::filesystem::exists(path) || colon == text.npos ||
      !std::filesystem::exists(text.substr(0, colon)))
    return {path, std::nullopt};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace

const std::vector<CameraFormat>& camera_formats() {
  static const std::vector<CameraFormat> formats{
      easymocap_camera_format(), qualisys_camera_format(),  mhad_camera_format(),
      voxelpose_camera_format(), caliscope_camera_format(), pose2sim_camera_format(),
      anipose_camera_format(),   opencv_camera_format()};
  return formats;
}

const CameraFormat* camera_format_of(const std::filesystem::path& path) {
  try {
    return format_of(source_of(path));
  } catch (const InputError&) {
    return nullptr;
  }
}

CameraRig read_cameras(const std::filesystem::path& path) {
  const CameraSource source = source_of(path);
  const CameraFormat* found = format_of(source);
  if (found == nullptr) {
    std::vector<std::string_view> known;
    for (const CameraFormat& format : camera_formats()) known.push_back(format.name);
    throw InputError(
        fmt::format("{}:1: not a camera file of a known format ({}); OpenCV's is "
                    "YAML, XML or JSON with camera_matrix",
                    path.string(), fmt::join(known, ", ")));
  }
  CameraRig rig = found->read(source);
  if (rig.cameras.empty()) throw InputError(fmt::format("{}:1: holds no camera", path.string()));
  for (std::vector<std::string>* lines : {&rig.assumed, &rig.stated})
    for (std::string& line : *lines) line = fmt::format("{} ({})", line, found->name);
  return rig;
}

Camera read_camera(const std::filesystem::path& path, std::vector<std::string>* assumed,
                   std::vector<std::string>* stated) {
  const auto [file, name] = file_and_name(path);
  CameraRig rig = read_cameras(file);
  if (!name && rig.cameras.size() > 1)
    throw InputError(fmt::format("{}: holds several cameras; choose one as {}:{} (there are: {})",
                                 file.string(), file.string(), rig.cameras.front().name,
                                 fmt::join(names_of(rig), ", ")));
  const auto found =
      name ? std::ranges::find(rig.cameras, *name, &NamedCamera::name) : rig.cameras.begin();
  if (found == rig.cameras.end())
    throw InputError(fmt::format("{}: has no camera {}; there are: {}", file.string(), *name,
                                 fmt::join(names_of(rig), ", ")));
  const auto collect = [&](const std::vector<std::string>& lines, std::vector<std::string>* to) {
    if (!to) return;
    for (const std::string& line : lines) to->push_back(fmt::format("{}: {}", path.string(), line));
  };
  collect(rig.assumed, assumed);
  collect(rig.stated, stated);
  return found->camera;
}

}  // namespace mcdbn
