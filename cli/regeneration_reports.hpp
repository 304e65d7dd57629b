#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "mcdbn/motion_model/clip_regeneration.hpp"

namespace mcdbn::cli {

void report_written(const std::filesystem::path& path, int frames, double fps);

/// Warns where a track of consecutive frames begins within the film, as a list of results does
/// whose first frames show nobody: what is drawn over the film has to begin there, too.
/// @param file of the track, for messages  @param numbers of its frames, the file's own
void report_first_frame(const std::filesystem::path& file, const std::vector<long long>& numbers);

/// Warns where the body lies across the image or is upside down: the film may be stored turned.
/// @param name of the track, for messages  @param track with keypoints
/// @param axes_are_unnamed as in TrackReading: if so, y may come before x
void report_turned(const std::string& name, const Track2d& track, bool axes_are_unnamed);

/// Warns what is assumed of a camera without calibration.
/// @param found_from what showed its pitch or roll; empty: neither was estimated from the clip
void report_assumed(const Camera& camera, const std::string& found_from);

/// Warns what was missing in the track and what was wrong with it.
/// @param name of the track, for messages  @param numbers of its frames, the file's own
void report_findings(const std::string& name, const Track2d& track,
                     const std::vector<long long>& numbers, const TrackFindings& findings);

/// Warns where feet slide as they do before a camera that moves.
/// @param name of the track, for messages  @param track with keypoints
void report_sliding_feet(const std::string& name, const Track2d& track, const Motion& motion);

/// The usual deviation of a joint but the root along an axis, and the least sure joints'.
void report_uncertainty(const Motion& motion, const MatrixD& deviations);

}  // namespace mcdbn::cli
