#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mcdbn/camera/camera.hpp"

namespace mcdbn {

/// One of the cameras of a file, in a world with +y up.
struct NamedCamera {
  std::string name;
  Camera camera;  ///< its unit_m is set where the format defines the length of its units
};

/// The cameras of a file, what was taken for granted on reading them, and what the file leaves no
/// doubt about: a line each.
struct CameraRig {
  std::vector<NamedCamera> cameras;
  std::vector<std::string> assumed;
  std::vector<std::string> stated = {};
};

/// A whole camera file.
struct CameraSource {
  std::filesystem::path path;
  std::string text;
};

/// A format of camera files.
struct CameraFormat {
  std::string_view name;                    ///< "pose2sim"
  std::string_view about;                   ///< a sentence for help and docs
  bool (*recognises)(const CameraSource&);  ///< by content
  CameraRig (*read)(const CameraSource&);   ///< throws InputError
};

/// All that are read, in the order in which they are tried.
const std::vector<CameraFormat>& camera_formats();

/// The format of a file, recognised by its content; null if it is no camera file that is read.
const CameraFormat* camera_format_of(const std::filesystem::path& path);

/// All cameras of a file. @throws InputError with file and line; also where it is larger than 4 MB
/// or nested deeper than any calibration, which is refused before it is parsed
CameraRig read_cameras(const std::filesystem::path& path);

/// One camera. @param path FILE, or FILE:NAME for one of the cameras of a file
/// @param assumed if given, collects what was taken for granted, a line each
/// @param stated likewise what the file leaves no doubt about
/// @throws InputError likewise; naming the cameras if there are several and none is chosen
Camera read_camera(const std::filesystem::path& path, std::vector<std::string>* assumed = nullptr,
                   std::vector<std::string>* stated = nullptr);

/// Whether write_camera has a format of that ending: .yml, .yaml, .xml or .json, in any case.
bool has_camera_ending(const std::filesystem::path& path);

/// Writes OpenCV's YAML, XML or JSON, by the path's ending. @throws InputError
void write_camera(const std::filesystem::path& path, const Camera& camera);

}  // namespace mcdbn
