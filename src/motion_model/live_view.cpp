#include "motion_model/live_view.hpp"

#include <algorithm>
#include <cmath>

#include "fitting/level_ground.hpp"
#include "motion/body_size.hpp"
#include "motion/turned_motion.hpp"

namespace mcdbn {
namespace {

constexpr double kWatched_s = 10, kAsked_s = 1;
/// How fast the world is turned.
constexpr double kTurn_deg_s = 3;

/// A step from `now` towards `wanted`, of at most so much; unset: 0.
std::optional<double> stepped(const std::optional<double>& now, const std::optional<double>& wanted,
                              double most) {
  if (!wanted) return now;
  const double from = now.value_or(0);
  return from + std::clamp(*wanted - from, -most, most);
}

}  // namespace

LiveView::LiveView(const Modalities& modalities, const ClipPlacement& placement, int width_px,
                   int height_px)
    : modalities_(modalities),
      said_(placement.view),
      view_(said_),
      wanted_(said_),
      known_(placement.camera.has_value()),
      finds_(finds_view(modalities, placement)),
      width_px_(width_px),
      height_px_(height_px) {
  if (known_)
    camera_ = *placement.camera;
  else
    look(said_);
}

void LiveView::look(const AssumedView& view) {
  const Eigen::Vector3d place = camera_.translation;
  view_ = view;
  camera_ = modalities_.assumed_camera(view, width_px_, height_px_);
  camera_.translation = place;
}

void LiveView::step() {
  if (!finds_ || kept_.frames() == 0) return;
  AssumedView view = view_;
  const double most_deg = kTurn_deg_s / modalities_.fps;
  view.pitch_deg = stepped(view.pitch_deg, wanted_.pitch_deg, most_deg);
  view.roll_deg = stepped(view.roll_deg, wanted_.roll_deg, most_deg);
  look(view);
}

void LiveView::see(const SlidingFit& fit, const PosePrior& prior) {
  if (known_ || kept_.frames() > 0) return;
  const Motion& motion = fit.motion();
  const int root_joint = motion.skeleton.find(modalities_.root_name());
  const Eigen::Vector3d root =
      joint_positions(motion).row(0).segment<3>(3 * root_joint).transpose();
  const Eigen::Vector3d in_camera =
      fit.camera().camera_from_world * root + fit.camera().translation;
  if (finds_) {
    look(levelled_view(said_, {motion, fit.shown(), fit.camera()}));
    wanted_ = view_;
  }
  const double height =
      file_units_per_metre(motion.skeleton) *
      modalities_.pose_features.root_features(modalities_.pose_scale.invert(prior.mean))
          .col(0)
          .mean();
  camera_.translation = in_camera - camera_.camera_from_world * Eigen::Vector3d(0, height, 0);
}

void LiveView::keep(const Skeleton& skeleton, const RowVectorD& pose) {
  if (known_) return;
  if (kept_.frames() == 0) kept_in_ = camera_;
  Motion one{skeleton, 1 / modalities_.fps, pose};
  // Turned about the origin, which both worlds share.
  one = turned_motion(std::move(one),
                      kept_in_.camera_from_world.transpose() * camera_.camera_from_world);
  const Eigen::Index most = std::lround(kWatched_s * modalities_.fps);
  MatrixD channels(std::min<Eigen::Index>(kept_.frames() + 1, most), pose.size());
  const Eigen::Index before = channels.rows() - 1;
  if (before > 0) channels.topRows(before) = kept_.channels.bottomRows(before);
  channels.row(before) = one.channels.row(0);
  kept_ = {skeleton, 1 / modalities_.fps, std::move(channels)};
  if (!finds_ || ++kept_since_ < std::lround(kAsked_s * modalities_.fps)) return;
  kept_since_ = 0;
  wanted_ = levelled_view(said_, {kept_, {}, kept_in_});
}

}  // namespace mcdbn
