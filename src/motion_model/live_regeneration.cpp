#include "mcdbn/motion_model/live_regeneration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "camera/confidence_weights.hpp"
#include "camera/keypoint_map.hpp"
#include "camera/track_resample.hpp"
#include "fitting/sliding_fit.hpp"
#include "fitting/track_smoothing.hpp"
#include "fitting/usual_body.hpp"
#include "machines/running_regeneration.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion/resample.hpp"
#include "motion_model/keypoint_columns.hpp"
#include "motion_model/live_output.hpp"
#include "motion_model/recent_track.hpp"

namespace mcdbn {
namespace {

/// Settled frames that are kept: they give the noise, and the body's size over a second.
constexpr double kKept_s = 2;

TrackFitSettings fit_of(const ClipPlacement& placement) {
  if (!placement.fit)
    throw ConfigError("a track is followed with the fit to it: leave out `fit` none");
  return *placement.fit;
}

std::size_t look_ahead_of(const Model& model, std::optional<std::size_t> asked) {
  const std::size_t own = model.network.look_ahead;
  if (asked.value_or(own) > own)
    throw ConfigError(fmt::format(
        "`look-ahead` {}: the model was trained to look {} frames ahead, and can wait for no more",
        *asked, own));
  return asked.value_or(own);
}

void check_skeleton(const Modalities& modalities, const ClipPlacement& placement) {
  if (!placement.skeleton) return;
  for (const Joint& joint : modalities.pose_features.skeleton().joints)
    if (placement.skeleton->find(joint.name) < 0)
      throw ConfigError(fmt::format(
          "a track is followed onto the model's joints, and the skeleton has no {}: regenerate the "
          "whole track onto it",
          joint.name));
}

std::optional<KeypointMap> map_of(const Modalities& modalities, const Track2d& like,
                                  const ClipPlacement& placement) {
  if (joined_by_name(like, modalities.track_features)) return {};
  const Skeleton& skeleton =
      placement.skeleton ? *placement.skeleton : modalities.pose_features.skeleton();
  return KeypointMap(keypoints_of_columns(like), skeleton,
                     skeleton_roles(skeleton, placement.joint_map));
}

KnownOfClip known_of(const ClipPlacement& placement, bool detected) {
  KnownOfClip known = placement;
  known.detected = detected;
  return known;
}

/// The height of the lowest joint of a motion's first frame.
double lowest_joint(const Motion& motion) {
  const RowVectorD places = joint_positions(motion).row(0);
  double lowest = std::numeric_limits<double>::infinity();
  for (Eigen::Index y = 1; y < places.size(); y += 3) lowest = std::min(lowest, places[y]);
  return lowest;
}

/// The model's mean pose above the origin, its feet on the ground, in one frame.
Motion standing_mean(const Modalities& modalities, const Skeleton& body, const Camera& camera) {
  const MatrixF mean = MatrixF::Zero(1, modalities.pose_scale.output_dimension());
  const auto at_height = [&](double root) {
    return modalities.pose_features.decode(
        modalities.pose_in_camera(mean, camera.camera_from_world), camera.camera_from_world, body,
        modalities.fps, Eigen::RowVector3d(0, root, 0));
  };
  return at_height(-lowest_joint(at_height(0)));
}

bool shows_anybody(const TrackFrame& frame) {
  return (frame.confidence.array() > 0).any();
}

Track2d without_frames(Track2d track) {
  drop_first(track, track.x_px.rows());
  return track;
}

}  // namespace

/// Frames at the model's rate on their way.
class LiveRegeneration::Frames {
 public:
  Frames(const Model& model, const Track2d& like, const ClipPlacement& placement,
         std::size_t look_ahead)
      : modalities_(model.modalities),
        network_(model.network),
        track_hz_(like.fps),
        raw_(without_frames(like)),
        map_(map_of(modalities_, like, placement)),
        running_(model.network),
        fit_(modalities_, known_of(placement, map_.has_value()), like, fit_of(placement)),
        output_(modalities_.fps, like.fps) {
    recent_ = raw_;
    recent_.fps = modalities_.fps;
    const bool same_rate = std::abs(track_hz_ / modalities_.fps - 1) < kSameRate;
    // At another rate frames lie between two others: they wait for the second of them on their way
    // in, and on their way out.
    open_at_most_ = static_cast<Eigen::Index>(look_ahead) + kMoreFrames - (same_rate ? 0 : 2);
  }

  std::vector<LiveFrame> push(const TrackFrame& frame) {
    append(raw_, frame);
    ++pushed_;
    shows_anybody_.push_back(shows_anybody(frame));
    return with_seen(take_frames(false));
  }

  std::vector<LiveFrame> finish() {
    std::vector<LiveFrame> finished = take_frames(true);
    add(finished, settle(open_));
    while (waiting_ > 0) add(finished, mean_pose());
    add(finished, output_.finish(pushed_));
    return with_seen(std::move(finished));
  }

  const SlidingFit& fit() const { return fit_; }
  double track_hz() const { return track_hz_; }

 private:
  static void add(std::vector<LiveFrame>& to, std::vector<LiveFrame> more) {
    std::ranges::move(more, std::back_inserter(to));
  }

  /// Of the next frames of the track, which they are for.
  std::vector<LiveFrame> with_seen(std::vector<LiveFrame> frames) {
    for (LiveFrame& frame : frames) {
      frame.seen = frame.seen && shows_anybody_.front();
      shows_anybody_.pop_front();
    }
    return frames;
  }

  /// Frames of the model's rate that the track's make whole. @param ended no more will come
  std::vector<LiveFrame> take_frames(bool ended) {
    const double step = track_hz_ / modalities_.fps;
    const bool same_rate = std::abs(step - 1) < kSameRate;
    const double reach = same_rate ? 0.5 : std::max(1.0, step);
    std::vector<LiveFrame> finished;
    for (;; ++taken_) {
      const double at = static_cast<double>(taken_) * (same_rate ? 1 : step);
      const auto last = static_cast<double>(pushed_ - 1);
      // A frame between two others is whole when all are there that it is a mean of.
      const bool whole =
          ended || same_rate ? at <= last + kSameRate : at + reach <= last + 1 + kSameRate;
      if (!whole) break;
      add(finished, take(frame_at(raw_, at - static_cast<double>(raw_first_), reach)));
      const auto unneeded = std::clamp<Eigen::Index>(
          static_cast<Eigen::Index>(std::floor(at - reach)) - raw_first_, 0, raw_.x_px.rows());
      drop_first(raw_, unneeded);
      raw_first_ += unneeded;
    }
    return finished;
  }

  /// The next frame at the model's rate.
  std::vector<LiveFrame> take(const Track2d& track) {
    const TrackFrame frame{track.x_px.row(0), track.y_px.row(0), track.confidence.row(0)};
    if (!placed_ && !shows_anybody(frame)) return await_person();
    append(recent_, frame);
    ++open_;
    std::vector<LiveFrame> finished;
    if (!placed_) {
      try {
        solve();
      } catch (const InputError&) {  // too little of a person
        forget();
        return await_person();
      }
      placed_ = true;
      while (waiting_ > 0) add(finished, mean_pose());
    } else {
      solve();
    }
    if (open_ > open_at_most_) add(finished, settle(open_ - open_at_most_));
    return finished;
  }

  /// One frame more before the first person. @return the first of them, once it has to come back
  std::vector<LiveFrame> await_person() {
    return ++waiting_ > open_at_most_ ? mean_pose() : std::vector<LiveFrame>();
  }

  void forget() {
    recent_ = without_frames(recent_);
    joints_ = without_frames(joints_);
    open_ = 0;
  }

  /// The frames that the fit is of: those that it holds, and the open ones.
  Eigen::Index first_of_fit() const { return recent_.frames() - open_ - fit_.held(); }

  void solve() {
    put_sides_right();
    const Eigen::Index first = first_of_fit(), count = recent_.frames() - first;
    see_joints(first, count);
    const Track2d seen = map_ ? map_->evidence(some_frames(joints_, first, count))
                              : some_frames(joints_, first, count);
    fit_.solve(answered(), seen, track_noise_px(joints_));
    if (!placed_) shown_ = without_frames(fit_.shown());
    while (shown_.x_px.rows() < recent_.frames())
      append(shown_, TrackFrame::unseen(shown_.joint_count()));
    replace_frames(shown_, first, fit_.shown());
  }

  /// Sides are as they settle; those of open frames may still be found to be exchanged.
  void put_sides_right() {
    right_ = recent_;
    if (!map_) return;
    exchange_sides(right_, find_side_swaps(recent_));
    replace_frames(right_, 0, some_frames(recent_, 0, recent_.frames() - open_));
  }

  void see_joints(Eigen::Index first, Eigen::Index count) {
    if (!map_) {
      joints_ = right_;
      return;
    }
    const Track2d weighted = some_frames(weighted_by_confidence(right_), first, count);
    Track2d joints;
    if (placed_ && fit_.motion().frames() + 1 == count) {
      Motion answer = fit_.motion();  // the new frame as the one before
      answer.channels.conservativeResize(count, Eigen::NoChange);
      answer.channels.row(count - 1) = answer.channels.row(count - 2);
      joints = map_->joints_of(weighted, answer, fit_.camera());
    } else {
      joints = map_->joints_of(weighted);
    }
    if (joints_.joint_names.empty()) joints_ = without_frames(joints);
    while (joints_.frames() < recent_.frames())
      append(joints_, {joints.x_px.row(0), joints.y_px.row(0), joints.confidence.row(0)});
    replace_frames(joints_, first, joints);
  }

  /// The network's answer for the open frames. Features that the track does not show are taken from
  /// the solution before.
  PosePrior answered() {
    const Camera camera = fit_.camera();
    MatrixF features = modalities_.encode_track(smooth_track(joints_), camera).bottomRows(open_);
    if (placed_) {
      const Eigen::Index newest = shown_.frames() - 1;
      append(shown_,
             {shown_.x_px.row(newest), shown_.y_px.row(newest), shown_.confidence.row(newest)});
      features = where_known(features, modalities_.encode_track(shown_, camera).bottomRows(open_));
    }
    CodedAnswer answer = running_.answer(features);
    return {std::move(answer.mean),
            network_.deviation ? network_.deviation->of(answer.code) : MatrixF()};
  }

  /// The first of the open frames will not change any more.
  std::vector<LiveFrame> settle(Eigen::Index count) {
    std::vector<LiveFrame> finished;
    if (count == 0) return finished;
    const Motion& motion = fit_.motion();
    for (Eigen::Index t = 0; t < count; ++t) {
      add(finished, output_.add(motion.skeleton, motion.channels.row(fit_.held() + t), true));
    }
    const Eigen::Index settled = recent_.frames() - open_;
    replace_frames(recent_, settled, some_frames(right_, settled, count));
    running_.settle(static_cast<std::size_t>(count));
    open_ -= count;
    fit_.settle(count);
    const auto kept = static_cast<Eigen::Index>(std::lround(kKept_s * modalities_.fps));
    const Eigen::Index old = std::max<Eigen::Index>(0, recent_.frames() - open_ - kept);
    drop_first(recent_, old);
    drop_first(joints_, old);
    drop_first(shown_, old);
    return finished;
  }

  /// For a frame before the first person was seen.
  std::vector<LiveFrame> mean_pose() {
    --waiting_;
    const Motion pose = standing_mean(modalities_, fit_.body(), fit_.camera());
    return output_.add(pose.skeleton, pose.channels.row(0), false);
  }

  const Modalities& modalities_;
  const Mcdbn& network_;
  double track_hz_;
  Track2d raw_;              ///< frames of the track that those still to be taken are made of
  long long raw_first_ = 0;  ///< which frame of the track its first is
  long long pushed_ = 0, taken_ = 0;
  std::deque<bool> shows_anybody_;  ///< frames of the track that have not come back
  Track2d recent_;                  ///< at the model's rate, settled and open
  Track2d right_;                   ///< the same, sides of the open frames put right
  Track2d joints_;                  ///< the model's joints as they show them
  Track2d shown_;                   ///< all its joints as the solutions put them
  std::optional<KeypointMap> map_;  ///< of a detector's keypoints
  Eigen::Index open_ = 0, open_at_most_ = 0, waiting_ = 0;
  bool placed_ = false;
  RunningRegeneration running_;
  SlidingFit fit_;
  LiveOutput output_;
};

LiveRegeneration::LiveRegeneration(const Model& model, const Track2d& like,
                                   const ClipPlacement& placement,
                                   std::optional<std::size_t> look_ahead)
    : latency_frames_(static_cast<int>(look_ahead_of(model, look_ahead)) + kMoreFrames) {
  check_skeleton(model.modalities, placement);
  frames_ = std::make_unique<Frames>(model, like, placement, look_ahead_of(model, look_ahead));
}

LiveRegeneration::~LiveRegeneration() = default;

Motion LiveRegeneration::before_anybody(const Model& model, const ClipPlacement& placement,
                                        std::optional<std::size_t> look_ahead) {
  (void)fit_of(placement);
  (void)look_ahead_of(model, look_ahead);
  check_skeleton(model.modalities, placement);
  // How large the camera's image is does not matter to the pose.
  return standing_mean(model.modalities,
                       body_to_begin_with(known_of(placement, true), model.modalities),
                       placement.camera_of(Track2d{}, model.modalities));
}

std::vector<LiveFrame> LiveRegeneration::push(const TrackFrame& frame) {
  return frames_->push(frame);
}

std::vector<LiveFrame> LiveRegeneration::finish() {
  return frames_->finish();
}

const Skeleton& LiveRegeneration::skeleton() const {
  return frames_->fit().body();
}

double LiveRegeneration::fps() const {
  return frames_->track_hz();
}

Camera LiveRegeneration::camera() const {
  return frames_->fit().camera();
}

}  // namespace mcdbn
