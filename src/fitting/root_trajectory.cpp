#include "fitting/root_trajectory.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fitting/robust_residuals.hpp"
#include "fitting/track_smoothing.hpp"
#include "mcdbn/base/errors.hpp"

namespace mcdbn {

namespace {

/// RMS distance of a 1.7 m person's joints from the hips (0.42 to 0.64 over the skeletons that were
/// tried): good enough to turn the noise below into file units.
constexpr double kRmsOfBody_m = 0.5;
/// The root's acceleration on that body where no velocity is known: a walking pelvis.
constexpr double kFreeAcceleration_m_s2 = 4.0;
/// Faster than any person; only keeps frames that nothing else determines from diverging.
constexpr double kFastest_m_s = 50.0;
constexpr int kRounds = 12;
constexpr int kFewestJoints = 3;

/// One joint as one frame sees it.
struct RootObservation {
  Eigen::Vector3d relative;  ///< to the root, camera axes
  Eigen::Vector2d ray;       ///< x/z and y/z, undistorted
  double confidence = 0;
};

/// The root as one frame alone determines it.
struct Fix {
  bool known = false;
  Eigen::Vector3d root{0, 0, 0};  ///< its position, camera axes
  /// Inverse covariance for a noise of one (in units of a ray).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  std::vector<double> residuals;  ///< of the rays, two a joint
};

/// Gauss-Newton on the distance between where a joint is seen and where it should be. The first
/// round puts (relative + root) onto the seen ray, which is linear: [1 0 -u; 0 1 -v]·root =
/// (u·z - x, v·z - y). To stay with those equations would draw the body nearer, as u and v are
/// noisy; the later rounds take u and v from the position found. Cauchy's weights discount a joint
/// that the tracker swapped.
Fix locate(const std::vector<RootObservation>& observations) {
  Fix fix;
  if (static_cast<int>(observations.size()) < kFewestJoints) return fix;
  const auto joints = static_cast<Eigen::Index>(observations.size());
  Eigen::Matrix<double, Eigen::Dynamic, 3> jacobian(2 * joints, 3);
  Eigen::VectorXd residual(2 * joints), weight(2 * joints);
  for (int round = 0; round < kRounds; ++round) {
    for (Eigen::Index k = 0; k < joints; ++k) {
      const RootObservation& observation = observations[k];
      const Eigen::Vector3d position = observation.relative + fix.root;
      const double depth = round == 0 ? 1.0 : position.z();
      if (!(depth > 0)) return fix;  // a body behind the camera explains nothing
      const Eigen::Vector2d ray =
          round == 0 ? observation.ray : Eigen::Vector2d(position.head<2>() / depth);
      jacobian.middleRows<2>(2 * k) << 1, 0, -ray.x(), 0, 1, -ray.y();
      jacobian.middleRows<2>(2 * k) /= depth;
      residual.segment<2>(2 * k) = round == 0
                                       ? Eigen::Vector2d(jacobian.middleRows<2>(2 * k) * position)
                                       : Eigen::Vector2d(ray - observation.ray);
    }
    const double scale = kCauchy * robust_deviation({residual.begin(), residual.end()}) + 1e-12;
    for (Eigen::Index k = 0; k < joints; ++k) {
      const double scaled = round == 0 ? 0 : residual.segment<2>(2 * k).norm() / scale;
      weight.segment<2>(2 * k).setConstant(observations[k].confidence / (1 + scaled * scaled));
    }
    fix.information = jacobian.transpose() * weight.asDiagonal() * jacobian;
    const Eigen::LDLT<Eigen::Matrix3d> solver(fix.information);
    if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return fix;
    fix.root -= solver.solve(jacobian.transpose() * weight.asDiagonal() * residual);
  }
  fix.residuals.assign(residual.begin(), residual.end());
  fix.known = fix.root.allFinite();
  return fix;
}

/// Noise of the rays over all frames: the bulk of the residuals, counted for the three numbers that
/// every frame fits to them.
double ray_noise(const std::vector<Fix>& fixes, const Camera& camera) {
  std::vector<double> residuals;
  std::size_t freedom = 0;
  for (const Fix& fix : fixes) {
    if (!fix.known) continue;
    residuals.insert(residuals.end(), fix.residuals.begin(), fix.residuals.end());
    freedom += fix.residuals.size() - 3;
  }
  const double least = kLeastNoise_px / camera.fx_px;
  const double share = static_cast<double>(freedom) / static_cast<double>(residuals.size());
  return std::max(least, robust_deviation(std::move(residuals)) / std::sqrt(share));
}

/// Adds weight·|Σ coefficient_k · root_(frame + k)|² for each axis to the normal equations.
void add_smoothness(std::vector<Eigen::Triplet<double>>& entries, int frame,
                    const std::vector<double>& coefficients, double weight) {
  for (std::size_t a = 0; a < coefficients.size(); ++a) {
    for (std::size_t b = 0; b < coefficients.size(); ++b) {
      for (int axis = 0; axis < 3; ++axis) {
        entries.emplace_back(3 * (frame + static_cast<int>(a)) + axis,
                             3 * (frame + static_cast<int>(b)) + axis,
                             weight * coefficients[a] * coefficients[b]);
      }
    }
  }
}

/// The path that best explains all fixes and the smoothness of what the motion model leaves
/// unexplained (`prediction`, the summed-up velocity): a Rauch-Tung-Striebel smoother, written as
/// the banded least squares that it solves. Each fix counts as sure as it is, so depth is smoothed
/// most. @param prediction [frames x 3]  @return [frames x 3], both in camera axes
MatrixD fuse(const std::vector<Fix>& fixes, const MatrixD& prediction, double noise,
             double acceleration, double speed, double frame_time_s) {
  const int frames = static_cast<int>(fixes.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(3 * frames);
  for (int frame = 0; frame < frames; ++frame) {
    if (!fixes[frame].known) continue;
    const Eigen::Matrix3d information = fixes[frame].information / (noise * noise);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        entries.emplace_back(3 * frame + row, 3 * frame + column, information(row, column));
      }
    }
    right_side.segment<3>(3 * frame) =
        information * (fixes[frame].root - prediction.row(frame).transpose());
  }
  const double bend = acceleration * frame_time_s * frame_time_s, step = speed * frame_time_s;
  for (int frame = 0; frame + 1 < frames; ++frame) {
    add_smoothness(entries, frame, {-1, 1}, 1 / (step * step));
    if (frame + 2 < frames) add_smoothness(entries, frame, {1, -2, 1}, 1 / (bend * bend));
  }
  Eigen::SparseMatrix<double> normal(3 * frames, 3 * frames);
  normal.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower,
                              Eigen::NaturalOrdering<int>>
      solver(normal);
  const Eigen::VectorXd correction = solver.solve(right_side);
  return prediction + Eigen::Map<const MatrixD>(correction.data(), frames, 3);
}

void check_shapes(const MatrixD& relative_positions, const TrackRays& track,
                  const MatrixD& velocity) {
  const Eigen::Index frames = track.frames();
  const bool fits = relative_positions.rows() == frames &&
                    relative_positions.cols() == 3 * track.asked &&
                    (velocity.rows() == 0 || (velocity.rows() == frames && velocity.cols() == 3));
  if (!fits) {
    throw ShapeError(fmt::format(
        "root_trajectory: {}x{} positions of {} joints, {}x{} velocities, {} frames of 2D",
        relative_positions.rows(), relative_positions.cols(), track.asked, velocity.rows(),
        velocity.cols(), frames));
  }
}

}  // namespace

MatrixD root_trajectory(const MatrixD& relative_positions, const TrackRays& track,
                        const Camera& camera, const MatrixD& velocity, double velocity_error_m_s2) {
  check_shapes(relative_positions, track, velocity);
  const double frame_time_s = 1.0 / track.fps;

  std::vector<Fix> fixes;
  MatrixD prediction = MatrixD::Zero(track.frames(), 3);
  double squares = 0;
  for (int frame = 0; frame < track.frames(); ++frame) {
    std::vector<RootObservation> observations;
    for (Eigen::Index k = 0; k < track.joints(); ++k) {
      const Eigen::Vector3d relative =
          relative_positions.row(frame).segment<3>(3 * track.indices[k]);
      squares += relative.squaredNorm();
      if (!track.seen(frame, k)) continue;
      observations.push_back({camera.camera_from_world * relative,
                              track.rays.row(frame).segment<2>(2 * k), track.confidence(frame, k)});
    }
    fixes.push_back(locate(observations));
    if (frame > 0) {
      prediction.row(frame) = prediction.row(frame - 1);
      if (velocity.rows() > 0) {
        prediction.row(frame) +=
            frame_time_s * velocity.row(frame) * camera.camera_from_world.transpose();
      }
    }
  }
  if (std::none_of(fixes.begin(), fixes.end(), [](const Fix& fix) { return fix.known; })) {
    throw InputError(fmt::format(
        "the 2D track never shows {} joints of the model at once before the camera; the root's "
        "position cannot be determined",
        kFewestJoints));
  }
  const double metre =
      std::sqrt(squares / static_cast<double>(fixes.size() * track.indices.size())) / kRmsOfBody_m;
  const MatrixD path =
      fuse(fixes, prediction, ray_noise(fixes, camera),
           metre * (velocity.rows() > 0 ? velocity_error_m_s2 : kFreeAcceleration_m_s2),
           metre * kFastest_m_s, frame_time_s);
  // x_camera = R·x_world + t, row by row.
  return (path.rowwise() - camera.translation.transpose()) * camera.camera_from_world;
}

MatrixD travelled_way(const MatrixD& velocity, double fps) {
  MatrixD way = MatrixD::Zero(velocity.rows(), 3);
  for (Eigen::Index t = 1; t < way.rows(); ++t) way.row(t) = way.row(t - 1) + velocity.row(t) / fps;
  return way;
}

}  // namespace mcdbn
