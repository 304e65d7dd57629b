// The room drawing: figures, contact sheets and films of motion.
// It uses camera.
// Add here: another way to show motion.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mcdbn/camera/camera.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

struct RenderClip {
  Motion motion;
  std::string label;  ///< shown in the picture
};

struct RenderOptions {
  /// From where to look. width_px and height_px are those of one panel; 0 takes what suits the
  /// output (640 x 720 in a video, 240 x 320 in a contact sheet).
  CameraPlacement placement{.distance = std::nullopt, .width_px = 0, .height_px = 0};
  std::optional<Camera> camera;  ///< look through this one instead; then nothing follows or turns
  /// A film to draw over, through `camera`, the clips from its frame `over_from` on.
  std::filesystem::path over;
  int over_from = 0;
  bool overlay = false;  ///< all clips in one panel instead of side by side
  bool orbit = false;    ///< the camera goes round the figure
  double orbit_deg_per_s = 30.0;
  bool follow_root = true;  ///< the camera goes with the figure, so that it stays large
  double fps = 0.0;         ///< of a video; 0: the first clip's own, at most 60
  int sheet_columns = 8;    ///< frames in a row of a contact sheet
};

/// Clips of any skeletons (+y up) as stick figures over a ground grid: left limbs blue, right ones
/// red, paler with depth. Clips run by time; a shorter one holds its last frame.
/// A `.mp4` shows the clips side by side. A `.png` is a contact sheet of frames at even times: two
/// rows of one clip, or one row a clip (the first, e.g. the truth, on top). Written atomically.
/// Over a film nothing else is drawn, and of a sheet both rows show the film.
/// @param notices if given, collects what was adapted to a film, and whether it has another rate or
/// ends before the clips
/// @throws InputError if there is no frame, the film cannot be read, or the file cannot be written;
///         ConfigError if the ending is another one, an option is out of range, or a film is to be
///         drawn over without a camera
void render(const std::vector<RenderClip>& clips, const std::filesystem::path& path,
            const RenderOptions& options = {}, std::vector<std::string>* notices = nullptr);

}  // namespace mcdbn
