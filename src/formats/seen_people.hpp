#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"
#include "mcdbn/camera/keypoint.hpp"
#include "mcdbn/formats/track_file.hpp"

namespace mcdbn {

class JsonPlace;

/// More joints of a person, and more people in a frame, are refused: no detector answers so many
/// (MediaPipe's holistic model has 553 joints), and what is kept of a film grows with them.
inline constexpr std::size_t kMostJoints = 600, kMostPeople = 500;
/// Frames by number may be so many times those that are there; beyond, the numbers are no time.
inline constexpr long long kSparse = 10;

/// One person in one frame, each [joints]. A joint that was not seen: NaN and confidence 0.
struct SeenPerson {
  std::vector<double> x_px, y_px, confidence;
  std::optional<long long> id;  ///< the file's own number of the person
  bool has_depths = false;      ///< joints have a third coordinate, beside a confidence
};

/// Calls visit(x, y, confidence) for each joint that was seen of each person of each frame.
/// @param frames people of each frame, which visit may change if they are not const
template <typename Frames, typename Visit>
void for_each_seen_joint(Frames& frames, const Visit& visit) {
  for (auto& people : frames)
    for (auto& person : people)
      for (std::size_t joint = 0; joint < person.x_px.size(); ++joint)
        if (person.confidence[joint] > 0)
          visit(person.x_px[joint], person.y_px[joint], person.confidence[joint]);
}

/// The content of a track file, before the people are followed over the frames.
struct SeenPeople {
  std::vector<std::string> joint_names;
  std::vector<Keypoint> keypoints;  ///< as in Track2d
  /// Where several joint sets have the count of joints, they, the usual one first, whose names
  /// joint_names are: likely_joint_set.hpp chooses.
  std::vector<std::string> possible_sets;
  /// By the file's own numbers of frames.
  std::map<long long, std::vector<SeenPerson>> frames;
  std::map<std::string, long long> track_ids;  ///< by name, where the file names its tracks
  /// Of frames, by their numbers, where the file gives times; they rise.
  std::map<long long, double> times_s;
  std::optional<double> fps;
  std::optional<ImageSize> image_size;
  bool image_size_is_given = true;  ///< else image_size is the format's default
  bool in_pixels = false;           ///< else coordinates that are all small are shares of the image
  /// Joints have a third coordinate where others have a confidence: a guess of their depth, or
  /// points in space.
  bool has_depths_only = false;
  bool axes_are_unnamed = false;  ///< as in TrackReading
  std::vector<std::string> notices;

  /// The id of a track that the file names; they count from 0.
  long long id_of_track(std::string_view name);
  /// What the file calls the person of that id: a name, or the number.
  std::string name_of_track(long long id) const;
  /// The image's size: that of the options, else the file's, else the camera's, else the format's
  /// default.
  std::optional<ImageSize> size_of_image(const TrackReadOptions& options) const;
  /// Whether that is the format's default.
  bool takes_default_size(const TrackReadOptions& options) const;
};

/// @throws InputError if a person has more than kMostJoints
void require_joints(std::size_t joints, const std::string& file);

/// Joints of one of joint_sets().
SeenPeople people_of_set(std::string_view set);

/// x, y, confidence of each joint, one behind the other. Missing: confidence 0, x = y = 0, NaN.
/// @param stride numbers a joint: 2 (all confidences 1) or 3 and more (the third one is taken)
SeenPerson person_of(const std::vector<double>& numbers, std::size_t joints, std::size_t stride);

/// Sets x, y and confidence to missing where one of them is.
void mark_missing(SeenPerson& person);

/// A folder's files as frames, by the numbers in their names. Those without one are left out with
/// a notice; where none has one the frames are in the order of the names.
/// @param people_of the content of a file  @throws InputError
SeenPeople people_of_folder(const TrackSource& source,
                            std::vector<SeenPerson> (*people_of)(const JsonPlace& content));

/// The joints of a track that a format writes, as rows: x, y, confidence of each joint, 0 0 0 where
/// it is missing.
std::vector<double> numbers_of(const Track2d& track, int frame);

/// Whether the frame shows any joint.
bool shows_anyone(const Track2d& track, int frame);

/// The frames that a list of people has entries of: those that show anyone, and of the others as
/// many as it takes to read all of them back: the first and the last one, the second where the
/// numbers would have a step in common, and every tenth where nearly all would be left out.
std::vector<int> frames_to_list(const Track2d& track);

/// The joint set that the track's columns are, of those that the format has.
/// @throws InputError naming the format's sets
const std::string& set_to_write(const Track2d& track, const std::vector<std::string>& sets,
                                const std::string& format);

}  // namespace mcdbn
