#pragma once

#include "formats/seen_people.hpp"
#include "formats/track_source.hpp"
#include "mcdbn/formats/track_file.hpp"

namespace mcdbn {

// One for each format, defined in its own source file and listed in track_file.cpp.
TrackFormat track_csv_format();
TrackFormat track_openpose_format();
TrackFormat track_coco_format();
TrackFormat track_alphapose_format();
TrackFormat track_mmpose_format();
TrackFormat track_mediapipe_format();
TrackFormat track_deeplabcut_format();
TrackFormat track_sleap_format();
TrackFormat track_npy_format();

}  // namespace mcdbn
