#include "mcdbn/motion_model/live_regeneration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fitting/sliding_fit.hpp"
#include "fitting/track_smoothing.hpp"
#include "fitting/usual_body.hpp"
#include "machines/running_regeneration.hpp"
#include "mcdbn/base/errors.hpp"
#include "motion_model/frames_at_rate.hpp"
#include "motion_model/keypoint_columns.hpp"
#include "motion_model/live_joints.hpp"
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

}  // namespace

/// From the track's frames to the motion's: the network's answer to the open frames at the model's
/// rate, and its fit.
class LiveRegeneration::Pipeline {
 public:
  Pipeline(const Model& model, const Track2d& like, const ClipPlacement& placement,
           std::size_t look_ahead)
      : modalities_(model.modalities),
        network_(model.network),
        track_hz_(like.fps),
        frames_(like, modalities_.fps),
        joints_(like, modalities_.fps, keypoint_map_of(modalities_, like, placement)),
        running_(model.network),
        fit_(modalities_, known_of(placement, joints_.from_keypoints()), like, fit_of(placement)),
        output_(modalities_.fps, like.fps) {
    // At another rate frames lie between two others: they wait for the second of them on their way
    // in, and on their way out.
    open_at_most_ =
        static_cast<Eigen::Index>(look_ahead) + kMoreFrames - (frames_.same_rate() ? 0 : 2);
  }

  std::vector<LiveFrame> push(const TrackFrame& frame) {
    frames_.push(frame);
    output_.expect(shows_anybody(frame));
    return take_frames(false);
  }

  std::vector<LiveFrame> finish() {
    std::vector<LiveFrame> finished = take_frames(true);
    add(finished, settle(open_));
    while (waiting_ > 0) add(finished, mean_pose());
    add(finished, output_.finish(frames_.pushed()));
    return finished;
  }

  const SlidingFit& fit() const { return fit_; }
  double track_hz() const { return track_hz_; }

 private:
  static void add(std::vector<LiveFrame>& to, std::vector<LiveFrame> more) {
    std::ranges::move(more, std::back_inserter(to));
  }

  std::vector<LiveFrame> take_frames(bool ended) {
    std::vector<LiveFrame> finished;
    for (const TrackFrame& frame : frames_.take(ended)) add(finished, take(frame));
    return finished;
  }

  /// The next frame at the model's rate.
  std::vector<LiveFrame> take(const TrackFrame& frame) {
    if (!placed_ && !shows_anybody(frame)) return await_person();
    joints_.push(frame);
    ++open_;
    std::vector<LiveFrame> finished;
    if (!placed_) {
      try {
        solve();
      } catch (const InputError&) {  // too little of a person
        joints_.clear();
        open_ = 0;
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

  /// Fits the frames that the fit holds, and the open ones.
  void solve() {
    const Eigen::Index first = joints_.frames() - open_ - fit_.held();
    joints_.correct_sides(open_);
    joints_.find(first, placed_ ? &fit_.motion() : nullptr, fit_.camera());
    fit_.solve(answered(), joints_.evidence(first), track_noise_px(joints_.joints()));
    if (!placed_) shown_ = without_frames(fit_.shown());
    while (shown_.x_px.rows() < joints_.frames())
      append(shown_, TrackFrame::unseen(shown_.joint_count()));
    replace_frames(shown_, first, fit_.shown());
  }

  /// The network's answer for the open frames. Features that the track does not show are taken from
  /// the solution before.
  PosePrior answered() {
    const Camera camera = fit_.camera();
    MatrixF features =
        modalities_.encode_track(smooth_track(joints_.joints()), camera).bottomRows(open_);
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
    joints_.settle(open_, count);
    running_.settle(static_cast<std::size_t>(count));
    open_ -= count;
    fit_.settle(count);
    const auto kept = static_cast<Eigen::Index>(std::lround(kKept_s * modalities_.fps));
    const Eigen::Index old = std::max<Eigen::Index>(0, joints_.frames() - open_ - kept);
    joints_.drop_oldest(old);
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
  FramesAtRate frames_;
  LiveJoints joints_;
  Track2d shown_;  ///< all the model's joints as the solutions put them, in the frames of joints_
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
  pipeline_ = std::make_unique<Pipeline>(model, like, placement, look_ahead_of(model, look_ahead));
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
  return pipeline_->push(frame);
}

std::vector<LiveFrame> LiveRegeneration::finish() {
  return pipeline_->finish();
}

const Skeleton& LiveRegeneration::skeleton() const {
  return pipeline_->fit().body();
}

double LiveRegeneration::fps() const {
  return pipeline_->track_hz();
}

Camera LiveRegeneration::camera() const {
  return pipeline_->fit().camera();
}

}  // namespace mcdbn
