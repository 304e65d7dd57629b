#pragma once

#include "features/small_figure.hpp"
#include "motion_model/pose_loss.hpp"
#include "reference/fine_tuning_reference.hpp"

namespace mcdbn::test {

/// The loss on 3D in double precision, by the motion layer's own decoding and forward kinematics,
/// and its derivative by central differences.
class PoseJudge {
 public:
  PoseJudge(const SmallFigure& figure, const PoseLossWeights& weights)
      : figure_(figure), weights_(weights) {}

  reference::Judgement operator()(const reference::WindowLayout& layout, const MatrixD& prediction,
                                  const MatrixD& target) const {
    // Judged frames alone, window behind window.
    const Eigen::Index judged = layout.frames - layout.judged_from;
    MatrixD got(layout.count * judged, prediction.cols()), want = got;
    for (Eigen::Index i = 0; i < layout.count; ++i) {
      const Eigen::Index from = i * layout.frames + layout.judged_from;
      got.middleRows(i * judged, judged) = prediction.middleRows(from, judged);
      want.middleRows(i * judged, judged) = target.middleRows(from, judged);
    }
    const Seen truth = seen(want);
    const MatrixD error = derivative(got, truth, judged);
    reference::Judgement result{terms(got, truth, judged).sum(),
                                MatrixD::Zero(prediction.rows(), prediction.cols())};
    for (Eigen::Index i = 0; i < layout.count; ++i)
      result.error.middleRows(i * layout.frames + layout.judged_from, judged) =
          error.middleRows(i * judged, judged);
    return result;
  }

  /// Of the steps of `poses` from frame to frame, how many the foot stands in.
  Eigen::Index planted_steps(const MatrixD& poses) const {
    const Seen truth = seen(poses);
    Eigen::Index count = 0;
    for (Eigen::Index t = 1; t < poses.rows(); ++t) count += is_planted(truth, t);
    return count;
  }

 private:
  struct Seen {
    MatrixD pose, positions_m, foot_m, travel_m;
  };

  Seen seen(const MatrixD& pose) const {
    return {pose, figure_.positions_m(pose), figure_.foot_m(pose),
            figure_.root_velocity_m_s(pose) / figure_.modalities().fps};
  }

  static RowVectorD foot_step_m(const Seen& seen, Eigen::Index t) {
    return seen.foot_m.row(t) - seen.foot_m.row(t - 1) + seen.travel_m.row(t);
  }

  bool is_planted(const Seen& truth, Eigen::Index t) const {
    return foot_step_m(truth, t).norm() * figure_.modalities().fps <= weights_.planted_below_m_s;
  }

  /// What each judged frame adds to the loss.
  Eigen::VectorXd terms(const MatrixD& pose, const Seen& truth, Eigen::Index judged) const {
    const Seen own = seen(pose);
    const auto rows = static_cast<double>(pose.rows()),
               steps = rows - rows / static_cast<double>(judged),
               features = static_cast<double>(pose.cols()),
               coordinates = static_cast<double>(own.positions_m.cols());
    const double position =
                     weights_.positions / std::pow(PoseLoss::kPosition_m, 2) / (rows * coordinates),
                 step =
                     weights_.velocities / std::pow(PoseLoss::kStep_m, 2) / (steps * coordinates),
                 contact = weights_.contacts / std::pow(PoseLoss::kStep_m, 2) / (steps * 3);
    const MatrixD off = own.positions_m - truth.positions_m;
    Eigen::VectorXd result =
        weights_.features / (rows * features) * (pose - truth.pose).rowwise().squaredNorm() +
        position * off.rowwise().squaredNorm();
    for (Eigen::Index t = 0; t < pose.rows(); ++t) {
      if (t % judged == 0) continue;
      result[t] += step * (off.row(t) - off.row(t - 1)).squaredNorm();
      if (is_planted(truth, t))
        result[t] += contact * (foot_step_m(own, t) - foot_step_m(truth, t)).squaredNorm();
    }
    return result;
  }

  /// Central differences, every other frame at once: a frame is felt in its own term and the next.
  MatrixD derivative(const MatrixD& pose, const Seen& truth, Eigen::Index judged) const {
    constexpr double kStep = 1e-5;
    MatrixD result(pose.rows(), pose.cols());
    for (Eigen::Index column = 0; column < pose.cols(); ++column)
      for (const Eigen::Index odd : {0, 1}) {
        const auto moved = [&](double by) {
          MatrixD other = pose;
          for (Eigen::Index t = 0; t < pose.rows(); ++t)
            if (t % judged % 2 == odd) other(t, column) += by;
          return terms(other, truth, judged);
        };
        const Eigen::VectorXd change = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
        for (Eigen::Index t = 0; t < pose.rows(); ++t)
          if (t % judged % 2 == odd)
            result(t, column) = change[t] + ((t + 1) % judged != 0 ? change[t + 1] : 0.0);
      }
    return result;
  }

  const SmallFigure& figure_;
  PoseLossWeights weights_;
};

}  // namespace mcdbn::test
