#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mcdbn/motion/camera.hpp"
#include "mcdbn/motion/keypoints.hpp"
#include "mcdbn/motion/skeleton.hpp"

namespace mcdbn {

/// The 3D modality: for every joint whose rotation varies over the training clips its orientation
/// in the camera's frame, 6D (first two columns of camera_from_joint), then root height and root
/// velocity in the camera's frame, in metres on a 1.7 m body (and per second). DESIGN section 3.
/// Joints that never turn against their parent carry no feature and are restored exactly.
class PoseFeatures {
 public:
  /// Learns which joints move, and the constant channels of all others, from training clips that
  /// share joint names. @throws InputError if a clip lacks a joint that the first one has
  static PoseFeatures fit(const std::vector<const Motion*>& clips);

  int dimension() const;
  const Skeleton& skeleton() const { return skeleton_; }  ///< of the first training clip
  std::vector<std::string> feature_names() const;

  /// @param clip any skeleton with the same joint names, at the model's rate
  /// @return [frames x dimension]
  MatrixD encode(const Motion& clip, const Eigen::Matrix3d& camera_from_world) const;

  /// Back to channels on `skeleton` (the model's own or any with the same joint names), angles
  /// continuous. 6D blocks are made orthonormal by Gram-Schmidt; joints without features take
  /// their parent's motion times their constant local rotation.
  /// @param features [frames x dimension]  @param root_position [frames x 3] world, file units
  Motion decode(const MatrixD& features, const Eigen::Matrix3d& camera_from_world,
                const Skeleton& skeleton, double fps, const MatrixD& root_position) const;

  /// Root height and velocity as the features say them. @return [frames x 4]: height_m, v_x, v_y,
  /// v_z (camera's frame, m/s on a 1.7 m body)
  MatrixD root_features(const MatrixD& features) const;

  nlohmann::json to_json() const;
  static PoseFeatures from_json(const nlohmann::json& json);

 private:
  Skeleton skeleton_;
  int root_ = 0;                        ///< the moving root (see moving_root)
  std::vector<int> joints_;             ///< indices of the joints with features
  RowVectorD constant_channels_;        ///< [1 x channels], what joints without features take
};

/// File units of `skeleton` in one metre of a body 1.7 m tall.
double file_units_per_metre(const Skeleton& skeleton);

/// The 2D modality: joint pixels relative to the root joint divided by the body's size in the
/// image, then the root's place in the image (as fractions of its height, from its centre) and the
/// logarithm of that size. DESIGN section 3.
class TrackFeatures {
 public:
  /// The joints to use, by name; joints that coincide with their parent should be left out.
  explicit TrackFeatures(std::vector<std::string> joint_names, std::string root_name);
  /// The joints of a skeleton that are worth tracking: every joint that is not at its parent's place.
  static TrackFeatures for_skeleton(const Skeleton& skeleton, int root);

  int dimension() const;
  const std::vector<std::string>& joint_names() const { return joint_names_; }
  const std::string& root_name() const { return root_name_; }

  /// Joined by name. Gaps of at most `kLongestGap_s` are interpolated; what is longer stays NaN.
  /// @param filled if given, how many joint-frames were interpolated and how many stay missing
  /// @return [frames x dimension]  @throws InputError if a joint of the model is in no column
  struct FillCount {
    int interpolated = 0;
    int missing = 0;
  };
  MatrixD encode(const Track2d& track, FillCount* filled = nullptr) const;
  static constexpr double kLongestGap_s = 0.2;

  nlohmann::json to_json() const;
  static TrackFeatures from_json(const nlohmann::json& json);

 private:
  std::vector<std::string> joint_names_;
  std::string root_name_;
};

/// z-scores columns; columns that never change are dropped and come back exactly.
class Standardizer {
 public:
  static Standardizer fit(const std::vector<const MatrixD*>& blocks);

  int input_dimension() const { return static_cast<int>(mean_.size()); }
  int output_dimension() const { return static_cast<int>(kept_.size()); }
  /// [rows x input] → [rows x output]; NaN stays NaN.
  MatrixF apply(const MatrixD& values) const;
  /// [rows x output] → [rows x input]
  MatrixD invert(const MatrixF& standardized) const;
  const RowVectorD& mean() const { return mean_; }
  const RowVectorD& deviation() const { return deviation_; }

  nlohmann::json to_json() const;
  static Standardizer from_json(const nlohmann::json& json);

 private:
  RowVectorD mean_, deviation_;  ///< [1 x input]
  std::vector<int> kept_;        ///< columns that vary
};

}  // namespace mcdbn
