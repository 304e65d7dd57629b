// How a WindowProblem is solved.

#include <ceres/solver.h>

#include <algorithm>

#include "base/interruption.hpp"
#include "fitting/one_thread_solver.hpp"
#include "fitting/window_problem.hpp"

namespace mcdbn {

void WindowProblem::solve(bool shared_too, double small_gain, int most_iterations) {
  if (!shared_too)
    for (const UnknownBlock& block : shared_blocks())
      if (problem_.HasParameterBlock(block.unknown))
        problem_.SetParameterBlockConstant(block.unknown);
  minimize(small_gain, most_iterations);
  turn_unused();
}

void WindowProblem::solve_turns(const std::vector<int>& turns, double small_gain,
                                int most_iterations) {
  std::vector<double*> free, unknowns, held;
  for (Eigen::Index t = 0; t < x_.turns.rows(); ++t)
    for (const int turn : turns) free.push_back(turn_at(t, turn));
  std::ranges::sort(free);
  problem_.GetParameterBlocks(&unknowns);
  for (double* const unknown : unknowns)
    if (!problem_.IsParameterBlockConstant(unknown) && !std::ranges::binary_search(free, unknown))
      held.push_back(unknown);
  for (double* const unknown : held) problem_.SetParameterBlockConstant(unknown);
  minimize(small_gain, most_iterations);
  for (double* const unknown : held) problem_.SetParameterBlockVariable(unknown);
}

/// Frames have unknowns in common with their neighbours alone, but for what all share, which comes
/// last: so the equations' factor stays narrow.
std::shared_ptr<ceres::ParameterBlockOrdering> WindowProblem::frame_by_frame() {
  auto order = std::make_shared<ceres::ParameterBlockOrdering>();
  std::vector<double*> unknowns;
  problem_.GetParameterBlocks(&unknowns);
  const auto frames = static_cast<int>(x_.turns.rows());
  for (double* const unknown : unknowns) order->AddElementToGroup(unknown, frames);
  const auto put = [&](double* unknown, int frame) {
    if (problem_.HasParameterBlock(unknown)) order->AddElementToGroup(unknown, frame);
  };
  for (int t = 0; t < frames; ++t) {
    for (int turn = 0; turn < turns_; ++turn) put(turn_at(t, turn), t);
    put(shift_at(t), t);
  }
  return order;
}

void WindowProblem::minimize(double small_gain, int most_iterations) {
  check_interruption();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::SUITE_SPARSE;
  options.linear_solver_ordering = frame_by_frame();
  options.max_num_iterations = most_iterations;
  // Half as many steps as Levenberg and Marquardt's.
  options.trust_region_strategy_type = ceres::DOGLEG;
  options.dogleg_type = ceres::SUBSPACE_DOGLEG;
  options.function_tolerance = small_gain;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  const OneThreadSolver one_thread;
  ceres::Solve(options, &problem_, &summary);
  x_.energy = summary.final_cost;
}

void WindowProblem::turn_unused() {
  for (Eigen::Index t = 0; t < x_.turns.rows(); ++t)
    for (int turn = 0; turn < turns_; ++turn) {
      if (used_[static_cast<std::size_t>(turn)]) continue;
      const int parent = clip_.parents[static_cast<std::size_t>(turn)];
      if (parent < 0) continue;
      x_.turns.row(t).segment<3>(3 * turn) =
          prior_
              .expected_turn(first_ + t, turn, x_.turns.row(t).segment<3>(3 * parent).transpose(),
                             x_.lean)
              .transpose();
    }
}

}  // namespace mcdbn
