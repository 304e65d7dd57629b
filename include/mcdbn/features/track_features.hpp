#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"
#include "mcdbn/camera/track.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The 2D modality: joint pixels relative to the root joint divided by the body's size in the
/// image, then the root's position in the image (as fractions of its height, from its centre) and
/// the logarithm of that size over the image's height. See docs/concepts.md.
///
/// The size of a frame is the RMS distance of its joints from the root; where joints are missing,
/// the others stand in by their usual share of it. Its logarithm is smoothed over `kSizeWindow_s`
/// to both sides by local lines, which takes the gait out of it, yet follows a walk towards the
/// camera.
class TrackFeatures {
 public:
  /// The joints to use, by name; joints that coincide with their parent should be left out. The
  /// root joint is always used, whether listed or not. @throws InputError if a name comes twice
  explicit TrackFeatures(std::vector<std::string> joint_names, std::string root_name);
  /// The joints of a skeleton that are worth tracking: every joint at or below `root` that is not
  /// at its parent's position.
  static TrackFeatures for_skeleton(const Skeleton& skeleton, int root);

  int dimension() const;
  /// Without the root.
  const std::vector<std::string>& joint_names() const { return joint_names_; }
  const std::string& root_name() const { return root_name_; }
  std::vector<std::string> feature_names() const;

  struct FillCount {
    int interpolated = 0;             ///< joint-frames
    int missing = 0;                  ///< joint-frames, of joints that some frame shows
    int outside = 0;                  ///< joint-frames that a track shows, but not the level view
    std::vector<std::string> unseen;  ///< joints, the root aside, that no frame shows
  };
  /// Joined by name. Gaps of at most `kLongestGap_s` are interpolated (held at the track's ends);
  /// what is longer stays NaN, and so do all of a frame without its root joint and a joint that is
  /// in no column.
  /// @param filled if given, what was interpolated and what stays missing
  /// @param usual_squares as usual_squares() gives them, for the size of a body of which joints are
  ///        never seen; empty: they then make up nothing of it
  /// @return [frames x dimension]
  /// @throws InputError if the root, or all but one other joint of the model, are in no column
  MatrixD encode(const Track2d& track, FillCount* filled = nullptr,
                 const RowVectorD& usual_squares = {}) const;
  /// The mean square of each joint's distance from the root, in squared sizes.
  /// @param mean, deviation of the features over many clips; of another length: nothing is known
  /// @return [joint_names()], or nothing
  RowVectorD usual_squares(const RowVectorD& mean, const RowVectorD& deviation) const;
  /// Back to pixels on an image of that size: the root first, then joint_names(), confidence 1. The
  /// root's place and the body's size are features too, so nothing else has to be known; of
  /// encode() it is the inverse wherever nothing was missing.
  /// @param features [frames x dimension]  @throws ShapeError
  Track2d decode(const MatrixD& features, double fps, int width_px, int height_px) const;
  static constexpr double kLongestGap_s = 0.2;
  static constexpr double kSizeWindow_s = 1.0;  ///< to either side

  nlohmann::json to_json() const;
  /// @param where it stands, for errors  @throws InputError
  static TrackFeatures from_json(const nlohmann::json& json, const std::string& where);

 private:
  std::vector<std::string> joint_names_;
  std::string root_name_;
};

}  // namespace mcdbn
