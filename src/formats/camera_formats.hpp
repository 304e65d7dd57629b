#pragma once

#include "mcdbn/formats/camera_file.hpp"

namespace mcdbn {

// One for each format, defined in its own source file and listed in camera_file.cpp.
CameraFormat opencv_camera_format();
CameraFormat easymocap_camera_format();
CameraFormat qualisys_camera_format();
CameraFormat mhad_camera_format();
CameraFormat voxelpose_camera_format();
CameraFormat caliscope_camera_format();
CameraFormat pose2sim_camera_format();
CameraFormat anipose_camera_format();

}  // namespace mcdbn
