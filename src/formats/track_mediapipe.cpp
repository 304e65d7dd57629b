// MediaPipe's 33 landmarks (BlazePose), and others in the same layouts (MoveNet): there is no file
// of MediaPipe's own, so those that people write are read: CSV by columns or by rows, JSON.
// Facts: MediaPipe's docs, "Pose landmark detection"; tfjs-models' pose-detection/src/constants.ts.
#include <fmt/format.h>

#include "base/text_file.hpp"
#include "formats/joint_naming.hpp"
#include "formats/landmarks.hpp"
#include "formats/track_formats.hpp"

namespace mcdbn {
namespace {

const char* const kName = "mediapipe";
const std::vector<std::string> kSets{"MEDIAPIPE_33", "COCO_17"};

bool recognises(const TrackSource& source) {
  if (source.is_folder()) return false;
  if (source.first_letter() == '{' || source.first_letter() == '[') {
    const auto content = source.json_if_any();
    return content && are_landmarks(*content);
  }
  return are_landmark_rows(source.text()) || are_landmark_columns(source.text());
}

SeenPeople read(const TrackSource& source) {
  if (source.first_letter() == '{' || source.first_letter() == '[')
    return read_landmarks(source.json(), source.name());
  if (are_landmark_rows(source.text())) return read_landmark_rows(source.text(), source.name());
  return read_landmark_columns(source.text(), source.name());
}

/// By columns, as shares of the image; a frame without a person has visibility 0.
void write(const std::filesystem::path& path, const Track2d& track) {
  set_to_write(track, kSets, kName);
  std::string text = "frame";
  for (int joint = 0; joint < track.joint_count(); ++joint)
    text += fmt::format(",L{0}_x,L{0}_y,L{0}_visibility", joint);
  text += '\n';
  for (int frame = 0; frame < track.frames(); ++frame) {
    text += fmt::format("{}", frame);
    for (int joint = 0; joint < track.joint_count(); ++joint)
      text += track.confidence(frame, joint) > 0
                  ? fmt::format(",{},{},{}", track.x_px(frame, joint) / track.width_px,
                                track.y_px(frame, joint) / track.height_px,
                                track.confidence(frame, joint))
                  : std::string(",0,0,0");
    text += '\n';
  }
  write_text_file(path, text);
}

}  // namespace

TrackFormat track_mediapipe_format() {
  return {kName, "MediaPipe's landmarks, MoveNet's in the same layouts: CSV or JSON",
          kSets, recognises,
          read,  write};
}

}  // namespace mcdbn
