#pragma once

#include <ceres/ordered_groups.h>
#include <ceres/problem.h>

#include <Eigen/SparseCore>
#include <memory>
#include <utility>
#include <vector>

#include "fitting/clip_posterior.hpp"
#include "fitting/prior_errors.hpp"
#include "fitting/quadratic_energy.hpp"
#include "fitting/terms/joint_place.hpp"

namespace mcdbn {

/// The unknowns of a problem: the orientations and lengths that move a joint which is seen in its
/// frames, one that the track has, whether or not these frames see it, or also those that only the
/// prior determines.
enum class Unknowns { seen, tracked, all };

/// The posterior of some frames of a clip as a problem for Ceres. Unknown are, by frame, a turn of
/// the orientations and a shift of the root; and the lengths.
class WindowProblem {
 public:
  /// @param from where to start, of the whole clip
  WindowProblem(const PosteriorClip& clip, const RayNoise& noise, const TrackFitSettings& settings,
                const PosteriorPoint& from, Eigen::Index first, Eigen::Index frames,
                Unknowns unknowns = Unknowns::seen);

  static constexpr int kMostIterations = 25;

  /// @param shared_too else what all frames share, body, ground and camera, stays as it is
  /// @param small_gain a step that lowers the energy by less than this share is the last one
  void solve(bool shared_too, double small_gain, int most_iterations = kMostIterations);

  /// As solve(), for some orientations alone: all else stays as it is.
  /// @param turns indices; those that the problem does not have are left out
  void solve_turns(const std::vector<int>& turns, double small_gain, int most_iterations);

  /// Begins anew. @param from as the constructor's, of the same clip
  void start_from(const PosteriorPoint& from);
  /// −log of how likely the point is where the problem is, but for a constant.
  double energy();

  /// Derivatives of the residuals, as their losses weigh them, at the point where the problem is.
  /// @return [residuals x frames·(3·orientations + 3) + lengths]: frame by frame its turns and its
  ///         shift, then the lengths; 0 in the column of what nothing depends on
  Eigen::SparseMatrix<double> derivatives();

  /// The first frames, and those before them, as a prior of those after them, near the problem's
  /// current point, with body, ground and camera as they are there. The problem has to have tracked
  /// or all unknowns, and kReach frames more.
  MarginalPrior without_first(Eigen::Index frames);

  /// The problem's current point, of its frames. An orientation that moves no seen joint turns as
  /// its parent predicts.
  const PosteriorPoint& solution() const { return x_; }

 private:
  void find_used(Unknowns unknowns);
  void add_rays();
  void add_turns();
  void add_root();
  void add_feet();
  void add_ground();
  void add_camera();
  bool hides_legs() const;
  double proportion_deviation(std::size_t length, bool legs_hidden) const;
  void add_lengths(Unknowns unknowns);
  void add_past();
  void add(Eigen::Index first, ceres::CostFunction* cost, ceres::LossFunction* loss,
           const std::vector<double*>& blocks);
  void turn_unused();
  void minimize(double small_gain, int most_iterations);
  std::shared_ptr<ceres::ParameterBlockOrdering> frame_by_frame();

  const std::vector<SeenJoint>& seen(Eigen::Index t) const;
  double* turn_at(Eigen::Index t, int turn) { return x_.turns.row(t).data() + 3 * turn; }
  /// The unknowns that all frames share, as far as the problem has them.
  std::vector<UnknownBlock> shared_blocks();
  /// Unknowns of one frame: the turns that the problem has, and the root.
  Eigen::Index numbers_of_frame() const;
  std::vector<UnknownBlock> blocks_of_frames(Eigen::Index first, Eigen::Index count);
  double* shift_at(Eigen::Index t) { return x_.shift.row(t).data(); }
  bool is_used(std::size_t joint) const;
  JointPlace place(Eigen::Index t, std::size_t joint) const;
  std::vector<double*> moving_blocks(Eigen::Index t, std::size_t joint);
  std::vector<double*> length_blocks(std::size_t joint);

  const PosteriorClip& clip_;
  const TrackFitSettings& settings_;
  RayNoise noise_;
  PriorErrors prior_;
  Eigen::Index first_;
  int turns_;
  std::vector<bool> used_;
  PosteriorPoint x_;
  ceres::Problem problem_;
  /// The residual terms, each with the first frame that it depends on.
  std::vector<std::pair<ceres::ResidualBlockId, Eigen::Index>> terms_;
};

}  // namespace mcdbn
