#include "motion_model/live_joints.hpp"

#include <utility>

#include "camera/confidence_weights.hpp"
#include "camera/cut_off.hpp"
#include "mcdbn/camera/side_swaps.hpp"
#include "motion_model/recent_track.hpp"

namespace mcdbn {
namespace {

/// The motion, and its last frame once more.
Motion with_last_repeated(Motion motion) {
  const Eigen::Index frames = motion.channels.rows();
  motion.channels.conservativeResize(frames + 1, Eigen::NoChange);
  motion.channels.row(frames) = motion.channels.row(frames - 1);
  return motion;
}

}  // namespace

LiveJoints::LiveJoints(const Track2d& like, double fps, std::optional<KeypointMap> map)
    : recent_(without_frames(like)), map_(std::move(map)) {
  recent_.fps = fps;
}

void LiveJoints::push(const TrackFrame& frame) {
  append(recent_, frame);
}

void LiveJoints::correct_sides(Eigen::Index open) {
  corrected_ = recent_;
  if (!map_) return;
  exchange_sides(corrected_, find_side_swaps(recent_));
  replace_frames(corrected_, 0, some_frames(recent_, 0, frames() - open));
}

void LiveJoints::find(Eigen::Index first, const Motion* answer, const Camera& camera) {
  if (!map_) {
    joints_ = corrected_;
    return;
  }
  const Eigen::Index count = frames() - first;
  const Track2d weighted =
      some_frames(without_cut_off(weighted_by_confidence(corrected_)), first, count);
  const Track2d found = answer != nullptr && answer->frames() + 1 == count
                            ? map_->joints_of(weighted, with_last_repeated(*answer), camera)
                            : map_->joints_of(weighted);
  if (joints_.joint_names.empty()) joints_ = without_frames(found);
  while (joints_.frames() < frames())
    append(joints_, {found.x_px.row(0), found.y_px.row(0), found.confidence.row(0)});
  replace_frames(joints_, first, found);
}

void LiveJoints::settle(Eigen::Index open, Eigen::Index count) {
  const Eigen::Index settled = frames() - open;
  replace_frames(recent_, settled, some_frames(corrected_, settled, count));
}

void LiveJoints::drop_oldest(Eigen::Index frames) {
  drop_first(recent_, frames);
  drop_first(joints_, frames);
}

void LiveJoints::clear() {
  recent_ = without_frames(recent_);
  joints_ = without_frames(joints_);
}

Track2d LiveJoints::evidence(Eigen::Index first) const {
  const Track2d some = some_frames(joints_, first, frames() - first);
  return map_ ? map_->evidence(some) : some;
}

}  // namespace mcdbn
