#include "fitting/frame_fit.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fitting/robust_residuals.hpp"
#include "mcdbn/base/matrices.hpp"

namespace mcdbn {
namespace {

/// At most; kSmallStep ends them before.
constexpr int kRounds = 10, kHalvings = 5;
/// A step of this share of the prior's deviations, RMS, is not worth another round.
constexpr double kSmallStep = 0.02;
/// Nearer than this share of the root's depth a joint cannot be.
constexpr double kNearest = 0.1;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return matrix;
}

/// How the rotation's own turn follows from a change of the vector: the left Jacobian of SO(3).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  const Eigen::Matrix3d cross = cross_matrix(turn);
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * cross;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * cross +
         (angle - std::sin(angle)) / (angle * angle * angle) * cross * cross;
}

/// d ray / d position.
Eigen::Matrix<double, 2, 3> projection(const Eigen::Vector3d& position) {
  Eigen::Matrix<double, 2, 3> result;
  result << 1, 0, -position.x() / position.z(), 0, 1, -position.y() / position.z();
  return result / position.z();
}

/// Turns as matrices, made once for all joints.
class Turns {
 public:
  explicit Turns(const Eigen::VectorXd& correction) {
    for (Eigen::Index k = 0; k + 3 < correction.size(); k += 3) {
      rotation_.push_back(rotation_of(correction.segment<3>(k)));
      jacobian_.push_back(left_jacobian(correction.segment<3>(k)));
    }
    shift_ = correction.tail<3>();
  }

  Eigen::Vector3d position(const std::vector<Lever>& levers, const Eigen::Vector3d& root) const {
    Eigen::Vector3d position = root + shift_;
    for (const Lever& lever : levers) position += rotation_[lever.turn] * lever.bone;
    return position;
  }

  /// Of what is made of a joint's position by `of_position` [rows x 3].
  /// @param rows [rows x parameters] zero on entry
  template <typename Matrix, typename Rows>
  void add_jacobian(const std::vector<Lever>& levers, const Matrix& of_position,
                    Rows&& rows) const {
    for (const Lever& lever : levers) {
      rows.template middleCols<3>(3 * lever.turn) -=
          of_position * cross_matrix(rotation_[lever.turn] * lever.bone) * jacobian_[lever.turn];
    }
    rows.template rightCols<3>() = of_position;
  }

 private:
  std::vector<Eigen::Matrix3d> rotation_, jacobian_;
  Eigen::Vector3d shift_;
};

/// What of its deviation a turn has for itself.
double own_deviation(const FramePrior& prior, std::size_t turn) {
  const double own = prior.parents[turn] < 0 ? 1 : std::sqrt(1 - prior.likeness * prior.likeness);
  return own * prior.turn_deviation_rad[turn];
}

/// What a turn of `parent` by one makes one expect of a turn that hangs from it.
double expected_share(const FramePrior& prior, std::size_t turn, int parent) {
  return prior.likeness * (prior.turn_deviation_rad[turn] /
                           prior.turn_deviation_rad[static_cast<std::size_t>(parent)]);
}

/// A correction, less the one expected, as independent numbers of variance 1.
Eigen::VectorXd whitened(const FramePrior& prior, const Eigen::VectorXd& correction) {
  Eigen::VectorXd result = correction;
  for (std::size_t turn = 0; turn < prior.parents.size(); ++turn) {
    auto own = result.segment<3>(3 * static_cast<Eigen::Index>(turn));
    const int parent = prior.parents[turn];
    if (parent >= 0) own -= expected_share(prior, turn, parent) * correction.segment<3>(3 * parent);
    own /= own_deviation(prior, turn);
  }
  result.tail<3>() /= prior.root_deviation;
  return result;
}

/// The correction that those numbers stand for.
Eigen::VectorXd coloured(const FramePrior& prior, Eigen::VectorXd white) {
  for (std::size_t turn = 0; turn < prior.parents.size(); ++turn) {
    auto own = white.segment<3>(3 * static_cast<Eigen::Index>(turn));
    own *= own_deviation(prior, turn);
    const int parent = prior.parents[turn];
    if (parent >= 0) own += expected_share(prior, turn, parent) * white.segment<3>(3 * parent);
  }
  white.tail<3>() *= prior.root_deviation;
  return white;
}

/// Makes derivatives by the correction derivatives by those numbers.
void whiten(const FramePrior& prior, MatrixD& jacobian) {
  for (std::size_t turn = prior.parents.size(); turn-- > 0;) {
    auto own = jacobian.middleCols<3>(3 * static_cast<Eigen::Index>(turn));
    const int parent = prior.parents[turn];
    if (parent >= 0)
      jacobian.middleCols<3>(3 * parent) += expected_share(prior, turn, parent) * own;
    own *= own_deviation(prior, turn);
  }
  jacobian.rightCols<3>() *= prior.root_deviation;
}

/// The frame's equations around one correction.
class Equations {
 public:
  Equations(const std::vector<Observation>& observations, const FramePrior& prior)
      : observations_(observations), prior_(prior), residuals_(held_row(prior.held.size())) {
    expected_ = prior.expected.size() > 0 ? prior.expected : Eigen::VectorXd::Zero(parameters());
  }

  const Eigen::VectorXd& expected() const { return expected_; }

  Eigen::Index parameters() const {
    return 3 * static_cast<Eigen::Index>(prior_.parents.size()) + 3;
  }

  /// Half of −log of prior and likelihood, up to a constant.
  double cost(const Eigen::VectorXd& correction, double scale) {
    look(Turns(correction));
    double sum = whitened(prior_, correction - expected_).squaredNorm();
    for (std::size_t k = 0; k < observations_.size(); ++k) {
      const double square = miss_squared(k) / scale;
      sum += kCauchy * kCauchy * scale * std::log1p(square / (kCauchy * kCauchy));
    }
    for (std::size_t k = 0; k < prior_.held.size(); ++k) {
      sum += residuals_[held_row(k)] * residuals_[held_row(k)] / prior_.held[k].variance;
    }
    return sum;
  }

  /// By coordinate of the rays, in its own deviation.
  std::vector<double> residuals(const Eigen::VectorXd& correction) {
    look(Turns(correction));
    std::vector<double> residuals;
    for (Eigen::Index row = 0; row < held_row(0); ++row) {
      residuals.push_back(residuals_[row] / std::sqrt(observations_[row / 2].variance));
    }
    return residuals;
  }

  /// How far the joints' residuals reach, in their own variances; at least one.
  double scale(const Eigen::VectorXd& correction) {
    const double deviation = robust_deviation(residuals(correction));
    return std::max(1.0, deviation * deviation);
  }

  /// Of the last solution, as freedom_of.
  double freedom() const {
    const Eigen::MatrixXd inverse =
        system_.solve(Eigen::MatrixXd::Identity(residuals_.size(), residuals_.size()));
    return variance_.dot(inverse.diagonal());
  }

  /// Where these equations, straightened around `correction`, have their minimum. The equations of
  /// the rays are fewer than the unknowns, so they are what is solved for.
  Eigen::VectorXd solve(const Eigen::VectorXd& correction, double scale, bool robust) {
    const Turns turns(correction);
    look(turns);
    MatrixD jacobian = MatrixD::Zero(residuals_.size(), parameters());
    variance_.resize(residuals_.size());
    for (std::size_t k = 0; k < observations_.size(); ++k) {
      const auto row = 2 * static_cast<Eigen::Index>(k);
      const double weight = robust ? 1 / (1 + miss_squared(k) / (kCauchy * kCauchy * scale)) : 1.0;
      variance_.segment<2>(row).setConstant(observations_[k].variance / weight);
      const Eigen::Vector3d position = turns.position(observations_[k].levers, prior_.root);
      if (before_camera(position)) {
        turns.add_jacobian(observations_[k].levers, projection(position),
                           jacobian.middleRows<2>(row));
      }
    }
    for (std::size_t k = 0; k < prior_.held.size(); ++k) {
      const HeldDepth& joint = prior_.held[k];
      variance_[held_row(k)] = joint.variance;
      turns.add_jacobian(joint.levers, Eigen::RowVector3d(0, 0, 1),
                         jacobian.middleRows<1>(held_row(k)));
    }
    const Eigen::VectorXd wanted = residuals_ + jacobian * (correction - expected_);
    whiten(prior_, jacobian);
    Eigen::MatrixXd system = jacobian * jacobian.transpose();
    system.diagonal() += variance_;
    system_.compute(system);
    return expected_ + coloured(prior_, jacobian.transpose() * system_.solve(wanted));
  }

  double step_size(const Eigen::VectorXd& step) const {
    return whitened(prior_, step).norm() / std::sqrt(static_cast<double>(step.size()));
  }

 private:
  bool before_camera(const Eigen::Vector3d& position) const {
    return position.z() > kNearest * prior_.root.z();
  }
  double miss_squared(std::size_t k) const {
    return residuals_.segment<2>(2 * static_cast<Eigen::Index>(k)).squaredNorm() /
           observations_[k].variance;
  }
  /// The equation of a held depth: they follow those of the rays.
  Eigen::Index held_row(std::size_t k) const {
    return static_cast<Eigen::Index>(2 * observations_.size() + k);
  }
  void look(const Turns& turns) {
    for (std::size_t k = 0; k < prior_.held.size(); ++k) {
      const HeldDepth& joint = prior_.held[k];
      residuals_[held_row(k)] = joint.depth - turns.position(joint.levers, prior_.root).z();
    }
    for (std::size_t k = 0; k < observations_.size(); ++k) {
      const Eigen::Vector3d position = turns.position(observations_[k].levers, prior_.root);
      residuals_.segment<2>(2 * static_cast<Eigen::Index>(k)) =
          before_camera(position)
              ? Eigen::Vector2d(observations_[k].ray - position.head<2>() / position.z())
              : Eigen::Vector2d(0, 0);
    }
  }

  const std::vector<Observation>& observations_;
  const FramePrior& prior_;
  Eigen::VectorXd expected_, residuals_, variance_;
  Eigen::LLT<Eigen::MatrixXd> system_;
};

}  // namespace

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& turn_rad) {
  const double angle = turn_rad.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn_rad / angle).toRotationMatrix();
}

Eigen::Vector3d corrected_position(const std::vector<Lever>& levers, const Eigen::Vector3d& root,
                                   const Eigen::VectorXd& correction) {
  return Turns(correction).position(levers, root);
}

Eigen::Matrix<double, 2, Eigen::Dynamic> ray_jacobian(const Observation& observation,
                                                      const Eigen::Vector3d& root,
                                                      const Eigen::VectorXd& correction) {
  const Turns turns(correction);
  Eigen::Matrix<double, 2, Eigen::Dynamic> rows =
      Eigen::Matrix<double, 2, Eigen::Dynamic>::Zero(2, correction.size());
  turns.add_jacobian(observation.levers, projection(turns.position(observation.levers, root)),
                     rows);
  return rows;
}

FrameFit fit_frame(const std::vector<Observation>& observations, const FramePrior& prior) {
  Equations equations(observations, prior);
  FrameFit fit{equations.expected(), {}};
  if (observations.empty() || !(prior.root.z() > 0)) return fit;
  // All joints first: how well they can be met tells what is out of the ordinary.
  fit.correction = equations.solve(fit.correction, 1, false);
  for (int round = 1; round < kRounds; ++round) {
    const double scale = equations.scale(fit.correction);
    const double before = equations.cost(fit.correction, scale);
    Eigen::VectorXd step = equations.solve(fit.correction, scale, true) - fit.correction;
    for (int half = 0; half < kHalvings && equations.cost(fit.correction + step, scale) > before;
         ++half) {
      step *= 0.5;
    }
    fit.correction += step;
    if (equations.step_size(step) < kSmallStep) break;
  }
  fit.residuals = equations.residuals(fit.correction);
  return fit;
}

double freedom_of(const FrameFit& fit, const std::vector<Observation>& observations,
                  const FramePrior& prior) {
  if (fit.residuals.empty()) return 0;
  Equations equations(observations, prior);
  equations.solve(fit.correction, equations.scale(fit.correction), true);
  return equations.freedom();
}

}  // namespace mcdbn
