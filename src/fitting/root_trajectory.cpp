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
/// Least depth of a joint as a share of the root's, where the body's size gives the root's depth.
constexpr double kNearestBySize = 0.1;

/// One joint as one frame sees it.
struct RootObservation {
  Eigen::Vector3d relative;  ///< to the root, camera axes
  Eigen::Vector2d ray;       ///< x/z and y/z, undistorted
  double confidence = 0;
};

/// The root as one frame alone determines it.
struct RootEstimate {
  bool known = false;
  Eigen::Vector3d root{0, 0, 0};  ///< camera axes
  /// Inverse covariance for a noise of one (in units of a ray).
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  std::vector<double> residuals;  ///< of the rays, two a joint
};

/// Errors of the rays of a frame's joints, two numbers a joint, and their derivatives with respect
/// to the root's position.
struct RayErrors {
  explicit RayErrors(const std::vector<RootObservation>& seen)
      : jacobian(2 * std::ssize(seen), 3), residual(jacobian.rows()), weight(jacobian.rows()) {}

  /// @param ray where the joint is expected  @param depth of the joint
  void put_joint(Eigen::Index k, const Eigen::Vector2d& ray, double depth) {
    jacobian.middleRows<2>(2 * k) << 1, 0, -ray.x(), 0, 1, -ray.y();
    jacobian.middleRows<2>(2 * k) /= depth;
  }
  /// Cauchy's: a joint that the tracker swapped counts less. The first round counts all alike.
  void weigh(const std::vector<RootObservation>& seen, bool all_alike = false) {
    const double scale = kCauchy * robust_deviation({residual.begin(), residual.end()}) + 1e-12;
    for (Eigen::Index k = 0; k < std::ssize(seen); ++k) {
      const double scaled = all_alike ? 0 : residual.segment<2>(2 * k).norm() / scale;
      weight.segment<2>(2 * k).setConstant(seen[static_cast<std::size_t>(k)].confidence /
                                           (1 + scaled * scaled));
    }
  }
  Eigen::Matrix3d information() const {
    return jacobian.transpose() * weight.asDiagonal() * jacobian;
  }

  Eigen::Matrix<double, Eigen::Dynamic, 3> jacobian;
  Eigen::VectorXd residual, weight;
};

bool all_before_camera(const std::vector<RootObservation>& seen, const Eigen::Vector3d& root) {
  return std::ranges::all_of(seen, [&](const RootObservation& observation) {
    return observation.relative.z() + root.z() > 0;
  });
}

/// The errors with the root there.
RayErrors errors_at(const std::vector<RootObservation>& seen, const Eigen::Vector3d& root) {
  RayErrors errors(seen);
  for (Eigen::Index k = 0; k < std::ssize(seen); ++k) {
    const RootObservation& observation = seen[static_cast<std::size_t>(k)];
    const Eigen::Vector3d position = observation.relative + root;
    const Eigen::Vector2d ray = position.head<2>() / position.z();
    errors.put_joint(k, ray, position.z());
    errors.residual.segment<2>(2 * k) = ray - observation.ray;
  }
  errors.weigh(seen);
  return errors;
}

/// The equations (relative + root) on the seen ray, which are linear: [1 0 -u; 0 1 -v]·root =
/// (u·z - x, v·z - y).
RayErrors linear_errors(const std::vector<RootObservation>& seen) {
  RayErrors errors(seen);
  for (Eigen::Index k = 0; k < std::ssize(seen); ++k) {
    const RootObservation& observation = seen[static_cast<std::size_t>(k)];
    errors.put_joint(k, observation.ray, 1);
    errors.residual.segment<2>(2 * k) = errors.jacobian.middleRows<2>(2 * k) * observation.relative;
  }
  errors.weigh(seen, true);
  return errors;
}

/// Gauss-Newton on the distance between where a joint is seen and where it should be. The first
/// round is linear. To stay with its equations would draw the body nearer, as u and v are noisy;
/// the later rounds take u and v from the position found.
/// @return unknown where that puts a joint behind the camera: such a body explains nothing
RootEstimate estimate_root(const std::vector<RootObservation>& seen) {
  RootEstimate estimate;
  if (std::ssize(seen) < kFewestJoints) return estimate;
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0 && !all_before_camera(seen, estimate.root)) return estimate;
    const RayErrors errors = round == 0 ? linear_errors(seen) : errors_at(seen, estimate.root);
    estimate.information = errors.information();
    const Eigen::LDLT<Eigen::Matrix3d> solver(estimate.information);
    if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return estimate;
    estimate.root -=
        solver.solve(errors.jacobian.transpose() * errors.weight.asDiagonal() * errors.residual);
    if (round + 1 == kRounds)
      estimate.residuals.assign(errors.residual.begin(), errors.residual.end());
  }
  estimate.known = estimate.root.allFinite() && all_before_camera(seen, estimate.root);
  return estimate;
}

/// The root where the joints' middle is on the rays' middle, at the depth Z that sizes give: of the
/// true pose (x - u·z, y - v·z) + (X, Y) = Z·(u, v), so that both sides spread alike.
/// @return unknown where all rays, or all joints, are one
RootEstimate estimate_root_by_size(const std::vector<RootObservation>& seen) {
  RootEstimate estimate;
  if (std::ssize(seen) < kFewestJoints) return estimate;
  const auto offset = [](const RootObservation& observation) -> Eigen::Vector2d {
    return observation.relative.head<2>() - observation.ray * observation.relative.z();
  };
  double sum = 0;
  Eigen::Vector2d middle(0, 0), middle_ray(0, 0);
  for (const RootObservation& observation : seen) {
    sum += observation.confidence;
    middle += observation.confidence * offset(observation);
    middle_ray += observation.confidence * observation.ray;
  }
  middle /= sum;
  middle_ray /= sum;
  double spread = 0, ray_spread = 0, nearest = 0;
  for (const RootObservation& observation : seen) {
    spread += observation.confidence * (offset(observation) - middle).squaredNorm();
    ray_spread += observation.confidence * (observation.ray - middle_ray).squaredNorm();
    nearest = std::max(nearest, -observation.relative.z() / (1 - kNearestBySize));
  }
  constexpr double kAtOnePlace = 1e-12;  // squared, in units of a ray
  if (!(spread > 0) || !(ray_spread > kAtOnePlace * sum)) return estimate;
  const double depth = std::max(nearest, std::sqrt(spread / ray_spread));
  estimate.root << middle_ray * depth - middle, depth;
  const RayErrors errors = errors_at(seen, estimate.root);
  estimate.information = errors.information();
  estimate.residuals.assign(errors.residual.begin(), errors.residual.end());
  estimate.known = estimate.root.allFinite();
  return estimate;
}

/// The root in every frame, and whether body and image sizes gave its depth: where the pose matches
/// the rays in less than half of the frames that show enough joints.
struct RootEstimates {
  std::vector<RootEstimate> frames;
  bool by_size = false;
};

/// @param frames what each of them shows  @throws InputError if the root is found in none
RootEstimates estimate_roots(const std::vector<std::vector<RootObservation>>& frames) {
  RootEstimates estimates{std::vector<RootEstimate>(frames.size())};
  std::ranges::transform(frames, estimates.frames.begin(), estimate_root);
  const auto enough = std::ranges::count_if(
      frames, [](const auto& seen) { return std::ssize(seen) >= kFewestJoints; });
  const auto matching = std::ranges::count(estimates.frames, true, &RootEstimate::known);
  estimates.by_size = 2 * matching < enough;
  if (estimates.by_size)
    std::ranges::transform(frames, estimates.frames.begin(), estimate_root_by_size);
  if (std::ranges::any_of(estimates.frames, &RootEstimate::known)) return estimates;
  constexpr const char* kUnknown = "the root's position cannot be determined";
  if (enough > 0)
    throw InputError(
        fmt::format("the 2D track shows all joints of a frame at one place; {}", kUnknown));
  throw InputError(fmt::format("the 2D track never shows {} joints of the model at once; {}",
                               kFewestJoints, kUnknown));
}

/// Noise of the rays over all frames: the bulk of the residuals, counted for the three numbers that
/// every frame fits to them.
double ray_noise(const std::vector<RootEstimate>& estimates, const Camera& camera) {
  std::vector<double> residuals;
  std::size_t freedom = 0;
  for (const RootEstimate& estimate : estimates) {
    if (!estimate.known) continue;
    residuals.insert(residuals.end(), estimate.residuals.begin(), estimate.residuals.end());
    freedom += estimate.residuals.size() - 3;
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

/// The path that best explains all estimates and the smoothness of what the motion model leaves
/// unexplained (`prediction`, the summed-up velocity): a Rauch-Tung-Striebel smoother, written as
/// the banded least squares that it solves. Each estimate counts by its information, so depth is
/// smoothed most. @param prediction [frames x 3]  @return [frames x 3], both in camera axes
MatrixD smooth_path(const std::vector<RootEstimate>& estimates, const MatrixD& prediction,
                    double noise, double acceleration, double speed, double frame_time_s) {
  const int frames = static_cast<int>(estimates.size());
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right_side = Eigen::VectorXd::Zero(3 * frames);
  for (int frame = 0; frame < frames; ++frame) {
    if (!estimates[frame].known) continue;
    const Eigen::Matrix3d information = estimates[frame].information / (noise * noise);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        entries.emplace_back(3 * frame + row, 3 * frame + column, information(row, column));
      }
    }
    right_side.segment<3>(3 * frame) =
        information * (estimates[frame].root - prediction.row(frame).transpose());
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

/// What a frame shows of the joints.
std::vector<RootObservation> observations_of(const MatrixD& relative_positions,
                                             const TrackRays& track, const Camera& camera,
                                             int frame) {
  std::vector<RootObservation> observations;
  for (Eigen::Index k = 0; k < track.joints(); ++k) {
    if (!track.seen(frame, k)) continue;
    const Eigen::Vector3d relative = relative_positions.row(frame).segment<3>(3 * track.indices[k]);
    observations.push_back({camera.camera_from_world * relative,
                            track.rays.row(frame).segment<2>(2 * k), track.confidence(frame, k)});
  }
  return observations;
}

/// The summed-up velocity. @return [frames x 3] camera axes; zero where no velocity is known
MatrixD predicted_path(const MatrixD& velocity, const TrackRays& track, const Camera& camera) {
  MatrixD path = MatrixD::Zero(track.frames(), 3);
  const double frame_time_s = 1.0 / track.fps;
  for (Eigen::Index t = 1; t < velocity.rows(); ++t)
    path.row(t) =
        path.row(t - 1) + frame_time_s * velocity.row(t) * camera.camera_from_world.transpose();
  return path;
}

/// File units in a metre, by the size of the body.
double units_per_metre(const MatrixD& relative_positions, const TrackRays& track) {
  double squares = 0;
  for (int frame = 0; frame < track.frames(); ++frame)
    for (Eigen::Index k = 0; k < track.joints(); ++k)
      squares += relative_positions.row(frame).segment<3>(3 * track.indices[k]).squaredNorm();
  const auto positions = static_cast<double>(track.frames()) * std::ssize(track.indices);
  return std::sqrt(squares / positions) / kRmsOfBody_m;
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

RootPath root_trajectory(const MatrixD& relative_positions, const TrackRays& track,
                         const Camera& camera, const MatrixD& velocity,
                         double velocity_error_m_s2) {
  check_shapes(relative_positions, track, velocity);
  std::vector<std::vector<RootObservation>> seen;
  seen.reserve(static_cast<std::size_t>(track.frames()));
  for (int frame = 0; frame < track.frames(); ++frame)
    seen.push_back(observations_of(relative_positions, track, camera, frame));
  const RootEstimates estimates = estimate_roots(seen);
  const double metre = units_per_metre(relative_positions, track);
  const double acceleration =
      metre * (velocity.rows() > 0 ? velocity_error_m_s2 : kFreeAcceleration_m_s2);
  const MatrixD path = smooth_path(estimates.frames, predicted_path(velocity, track, camera),
                                   ray_noise(estimates.frames, camera), acceleration,
                                   metre * kFastest_m_s, 1.0 / track.fps);
  // x_camera = R·x_world + t, row by row.
  return {(path.rowwise() - camera.translation.transpose()) * camera.camera_from_world,
          estimates.by_size};
}

MatrixD travelled_way(const MatrixD& velocity, double fps) {
  MatrixD way = MatrixD::Zero(velocity.rows(), 3);
  for (Eigen::Index t = 1; t < way.rows(); ++t) way.row(t) = way.row(t - 1) + velocity.row(t) / fps;
  return way;
}

}  // namespace mcdbn
