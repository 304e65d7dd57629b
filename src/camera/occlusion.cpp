#include "camera/occlusion.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace mcdbn {
namespace {

/// A part of the body, as thick as adults are (shares of body height).
struct Rod {
  JointRole from, to;
  double radius;
};

using enum JointRole;
constexpr std::array kRods{Rod{pelvis, neck, 0.09},
                           Rod{neck, head, 0.045},
                           Rod{left_hip, left_knee, 0.04},
                           Rod{right_hip, right_knee, 0.04},
                           Rod{left_knee, left_ankle, 0.03},
                           Rod{right_knee, right_ankle, 0.03},
                           Rod{left_shoulder, left_elbow, 0.026},
                           Rod{right_shoulder, right_elbow, 0.026},
                           Rod{left_elbow, left_wrist, 0.02},
                           Rod{right_elbow, right_wrist, 0.02}};

/// Whether a rod carries the place, and so does not hide it: a rod that ends at the place's joint,
/// and the trunk for what hangs from it. A place on the head's surface, as the nose, is hidden by
/// the head from behind.
bool carries(const Rod& rod, JointRole role, double off) {
  if (rod.to == head && role == head) return off < rod.radius;
  if (rod.from == role || rod.to == role) return true;
  const bool of_trunk = rod.from == pelvis;
  switch (role) {
    case spine:
    case chest:
    case left_clavicle:
    case right_clavicle:
    case left_shoulder:
    case right_shoulder:
    case left_hip:
    case right_hip:
      return of_trunk;
    case left_hand:
      return rod.to == left_wrist;
    case right_hand:
      return rod.to == right_wrist;
    case left_toe:
      return rod.to == left_ankle;
    case right_toe:
      return rod.to == right_ankle;
    default:
      return false;
  }
}

/// How near the line of sight to `place` comes to the rod's middle line, and at which share of the
/// way to the place (Ericson 2005, 5.1.9).
struct Crossing {
  double distance, share;
};

Crossing crossing(const Eigen::Vector3d& eye, const Eigen::Vector3d& place,
                  const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d ray = place - eye, rod = to - from, between = eye - from;
  const double a = ray.squaredNorm(), b = ray.dot(rod), e = rod.squaredNorm(), c = ray.dot(between),
               f = rod.dot(between), determinant = a * e - b * b;
  double share = determinant > 0 ? std::clamp((b * f - c * e) / determinant, 0.0, 1.0) : 0.0;
  double along = e > 0 ? std::clamp((b * share + f) / e, 0.0, 1.0) : 0.0;
  share = std::clamp((b * along - c) / a, 0.0, 1.0);
  return {(eye + share * ray - from - along * rod).norm(), share};
}

}  // namespace

Flags hidden_places(const RolePositions& body, const std::vector<Keypoint>& keypoints,
                    const MatrixD& places, const Camera& camera) {
  const Eigen::Vector3d eye = -camera.camera_from_world.transpose() * camera.translation;
  Flags hidden = Flags::Constant(places.rows(), places.cols() / 3, false);
  for (Eigen::Index frame = 0; frame < places.rows(); ++frame) {
    for (std::size_t i = 0; i < keypoints.size(); ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      const Eigen::Vector3d place = places.row(frame).segment<3>(3 * column).transpose();
      const double way = (place - eye).norm();
      const std::optional<JointRole>& role = keypoints[i].role;
      const double off = role ? (place - body.at(frame, *role)).norm() / body.height : 0;
      hidden(frame, column) = std::ranges::any_of(kRods, [&](const Rod& rod) {
        if (role && carries(rod, *role, off)) return false;
        const Eigen::Vector3d from = body.at(frame, rod.from), to = body.at(frame, rod.to);
        if (from.hasNaN() || to.hasNaN()) return false;
        const Crossing met = crossing(eye, place, from, to);
        const double radius = rod.radius * body.height;
        return met.distance < radius && met.share * way < way - radius;
      });
    }
  }
  return hidden;
}

}  // namespace mcdbn
