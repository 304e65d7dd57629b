#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mcdbn/base/matrices.hpp"
#include "mcdbn/device/device.hpp"

namespace mcdbn {

/// A simpler method that infers 3D from 2D, to compare the model with. All of them see the same
/// standardized features as the model: [frames x dimension], one matrix a clip. A NaN in a track (a
/// joint that was not seen) is taken as 0, the training mean.
class Baseline {
 public:
  virtual ~Baseline() = default;
  virtual std::string name() const = 0;  ///< as in reports: mean_pose, nearest_neighbour, …

  /// @param tracks, poses the 2D and 3D modality of each training clip, [frames x d2], [frames x
  /// d3]
  /// @throws ShapeError if they do not pair up or hold no frame at all
  virtual void fit(const std::vector<MatrixF>& tracks, const std::vector<MatrixF>& poses) = 0;

  /// @param track [frames x d2]  @return [frames x d3]
  /// @throws ShapeError if nothing was fitted, or d2 is another than in training
  virtual MatrixF predict(const MatrixF& track) const = 0;

  /// Whether it learns from the augmented views that fine-tuning saw, where there are any; else
  /// from the clips themselves.
  virtual bool learns_from_views() const { return false; }
};

/// All that there are: first those of every report, then related systems of the paper (its [13],
/// [15] and [26]), which take minutes.
const std::vector<std::string>& all_baselines();
/// mean_pose, hold_last_frame, nearest_neighbour, ridge_window, mlp_window.
std::vector<std::string> usual_baselines();

/// What a user asks for: names, or `usual`, `all`, `none`; each once, in the order of
/// all_baselines().
/// @throws ConfigError that lists what there is
std::vector<std::string> baselines_of(const std::vector<std::string>& words);

/// Not fitted yet.
/// @param name of all_baselines()
/// @param from_views it is to learn from augmented views, of which there are many
/// @throws ConfigError
std::unique_ptr<Baseline> make_baseline(const std::string& name, Device& device, bool from_views);

}  // namespace mcdbn
