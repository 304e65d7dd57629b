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
/// Of a body that sizes put there no joint is nearer to the camera than this share of the root's
/// depth.
constexpr double kNearestBySize = 0.1;

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

/// How far off the rays of a frame's joints are, two numbers a joint, and how that changes with the
/// root's place.
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
Fix locate(const std::vector<RootObservation>& seen) {
  Fix fix;
  if (std::ssize(seen) < kFewestJoints) return fix;
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0 && !all_before_camera(seen, fix.root)) return fix;
    const RayErrors errors = round == 0 ? linear_errors(seen) : errors_at(seen, fix.root);
    fix.information = errors.information();
    const Eigen::LDLT<Eigen::Matrix3d> solver(fix.information);
    if (solver.info() != Eigen::Success || !(solver.rcond() > 1e-12)) return fix;
    fix.root -=
        solver.solve(errors.jacobian.transpose() * errors.weight.asDiagonal() * errors.residual);
    if (round + 1 == kRounds) fix.residuals.assign(errors.residual.begin(), errors.residual.end());
  }
  fix.known = fix.root.allFinite() && all_before_camera(seen, fix.root);
  return fix;
}

/// The root where the joints' middle is on the rays' middle, at the depth Z that sizes give: of the
/// true pose (x - u·z, y - v·z) + (X, Y) = Z·(u, v), so that both sides spread alike.
/// @return unknown where all rays, or all joints, are one
Fix locate_by_size(const std::vector<RootObservation>& seen) {
  Fix fix;
  if (std::ssize(seen) < kFewestJoints) return fix;
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
  if (!(spread > 0) || !(ray_spread > kAtOnePlace * sum)) return fix;
  const double depth = std::max(nearest, std::sqrt(spread / ray_spread));
  fix.root << middle_ray * depth - middle, depth;
  const RayErrors errors = errors_at(seen, fix.root);
  fix.information = errors.information();
  fix.residuals.assign(errors.residual.begin(), errors.residual.end());
  fix.known = fix.root.allFinite();
  return fix;
}

/// @param frames what each of them shows
/// @param by_size whether the pose matches the rays in less than half of those with enough joints
/// @throws InputError if none can be located
std::vector<Fix> located(const std::vector<std::vector<RootObservation>>& frames, bool& by_size) {
  std::vector<Fix> fixes(frames.size());
  std::ranges::transform(frames, fixes.begin(), locate);
  const auto enough = std::ranges::count_if(
      frames, [](const auto& seen) { return std::ssize(seen) >= kFewestJoints; });
  by_size = 2 * std::ranges::count(fixes, true, &Fix::known) < enough;
  if (by_size) std::ranges::transform(frames, fixes.begin(), locate_by_size);
  if (std::ranges::any_of(fixes, &Fix::known)) return fixes;
  constexpr const char* kUnknown = "the root's position cannot be determined";
  if (enough > 0)
    throw InputError(
        fmt::format("the 2D track shows all joints of a frame at one place; {}", kUnknown));
  throw InputError(fmt::format("the 2D track never shows {} joints of the model at once; {}",
                               kFewestJoints, kUnknown));
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
                        const Camera& camera, const MatrixD& velocity, double velocity_error_m_s2,
                        bool* by_size) {
  check_shapes(relative_positions, track, velocity);
  const double frame_time_s = 1.0 / track.fps;

  std::vector<std::vector<RootObservation>> seen;
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
    seen.push_back(std::move(observations));
    if (frame > 0) {
      prediction.row(frame) = prediction.row(frame - 1);
      if (velocity.rows() > 0) {
        prediction.row(frame) +=
            frame_time_s * velocity.row(frame) * camera.camera_from_world.transpose();
      }
    }
  }
  bool sizes_alone = false;
  const std::vector<Fix> fixes = located(seen, sizes_alone);
  if (by_size) *by_size = sizes_alone;
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
