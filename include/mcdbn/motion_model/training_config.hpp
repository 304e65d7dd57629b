#pragma once

#include <cstddef>
#include <string>

#include "mcdbn/corpus/training_set.hpp"
#include "mcdbn/learning/settings.hpp"
#include "mcdbn/motion/planted_foot.hpp"

namespace mcdbn {

/// What fine-tuning minimizes on the 3D modality, each a mean over what it counts.
struct PoseLossWeights {
  double features = 1.0;    ///< of squared standardized features
  double positions = 0.0;   ///< of squared distances of joints from the truth, in units of 5 cm
  double velocities = 0.0;  ///< of squared differences of steps from frame to frame, units of 1 cm
  /// The same through the world, the root's travel included, of feet that are planted in truth,
  /// told by their speed alone.
  double contacts = 0.0;
  double planted_below_m_s = kPlantedInCapture.below_m_s;  ///< on a 1.7 m body; see PlantedFoot
};

/// Everything that shapes a training run on clips: how they become sequences, and how those are
/// learnt.
struct TrainingConfig : CorpusSettings, LearningSettings {
  /// Of fine-tuning's loss on the 3D modality.
  PoseLossWeights pose_loss{.positions = 0.5, .velocities = 0.2, .contacts = 0.1};
  /// Of at least so many people one is held out (held_out_person.hpp), and fine-tuning stops when
  /// that person fares worse; 0: never. Of few nobody can be spared: without one of nine CMU
  /// walkers the error on strangers is 28.7 instead of 23.6 mm, and the one held out did better to
  /// the end.
  std::size_t hold_out_among = 20;

  /// With LearningSettings::greedy or paper.
  static TrainingConfig greedy();
  static TrainingConfig paper();
  /// @throws ConfigError naming the setting that is out of range
  void validate() const;
};

/// The name that a setting had up to version 0.1, which is still understood: fine-tuning was called
/// the joint stage. Empty if it never had another.
std::string former_name(const std::string& setting);

/// Calls visit(name, member, help) for every setting, with dots between the parts of a name: the
/// one list from which flags, TOML files and the record in the model are made.
template <typename Config, typename Visit>
void visit_settings(Config& config, Visit&& visit) {
  visit("seed", config.seed, "seed of every random number");
  visit("fps", config.fps, "frame rate that clips are resampled to");
  visit("phases", config.phases, "sampling grids taken from each clip");
  visit("keep-first-frame", config.keep_first_frame, "keep a leading calibration pose");
  visit("order", config.order, "frames of history of every CRBM (N)");
  visit("hidden", config.hidden, "hidden units of every CRBM");
  visit("layers", config.layers, "CRBMs in each CDBN");
  visit("mrbm-hidden", config.mrbm_hidden, "hidden units of the MRBM");
  visit("look-ahead", config.look_ahead, "frames of 2D seen ahead; 0 is causal, the paper's");
  visit("batch", config.batch, "windows in a mini-batch");
  visit("least-batches", config.least_batches,
        "mini-batches an epoch at least: small data is gone over several times");
  const auto visit_cd = [&visit](const std::string& prefix, auto& settings) {
    visit(prefix + ".gibbs-steps", settings.gibbs_steps, "k of CD-k");
    visit(prefix + ".rate", settings.rate, "learning rate of W and the biases");
    visit(prefix + ".rate-A", settings.rate_A, "learning rate of A (history to visible)");
    visit(prefix + ".rate-B", settings.rate_B, "learning rate of B (history to hidden)");
    visit(prefix + ".momentum", settings.momentum, "momentum");
    visit(prefix + ".momentum-from-epoch", settings.momentum_from_epoch, "no momentum before it");
    visit(prefix + ".weight-decay", settings.weight_decay, "decay of W, A and B");
    visit(prefix + ".initial-deviation", settings.initial_deviation,
          "spread of the first weights, with --stages greedy");
    visit(prefix + ".epochs", settings.epochs, "epochs (with --stages greedy 100, binary 50)");
  };
  visit_cd("gaussian", config.gaussian);
  visit_cd("binary", config.binary);
  visit("mrbm.rate", config.mrbm.rate, "Adam's rate for the MRBM");
  visit("mrbm.weight-decay", config.mrbm.weight_decay, "decay of the MRBM's weights");
  visit("mrbm.initial-deviation", config.mrbm.initial_deviation,
        "spread of the first weights, with --stages greedy");
  visit("mrbm.mean-field-steps", config.mrbm.mean_field_steps, "unrolled steps of eq 32 and 33");
  visit("mrbm.epochs", config.mrbm.epochs, "epochs (with --stages greedy 30)");
  visit("fine-tuning.steps", config.fine_tuning.steps,
        "mini-batches of fine-tuning; 0: as --stages greedy");
  visit("fine-tuning.from-greedy", config.fine_tuning.from_greedy,
        "the greedy stages come before it; else they are left out");
  visit("fine-tuning.windows", config.fine_tuning.windows, "windows in a mini-batch");
  visit("fine-tuning.people-power", config.fine_tuning.people_power,
        "1: every frame counts alike; 0: every person, told by their bones");
  visit("fine-tuning.window-frames", config.fine_tuning.window_frames, "judged frames of a window");
  visit("fine-tuning.settle-frames", config.fine_tuning.settle_frames,
        "free-running frames before them");
  visit("fine-tuning.rate", config.fine_tuning.rate, "Adam's rate");
  visit("fine-tuning.weight-decay", config.fine_tuning.weight_decay,
        "decoupled decay of the weights");
  visit("fine-tuning.dropout", config.fine_tuning.dropout, "share of hidden units left out");
  visit("fine-tuning.average", config.fine_tuning.average,
        "kept of the parameters' moving average");
  visit("fine-tuning.positions", config.pose_loss.positions,
        "weight of joint positions in the loss");
  visit("fine-tuning.velocities", config.pose_loss.velocities,
        "weight of joint velocities in the loss");
  visit("fine-tuning.contacts", config.pose_loss.contacts,
        "weight of planted feet's steps in the loss");
  visit("fine-tuning.reverse", config.fine_tuning.reverse, "weight of 2D from 3D");
  visit("fine-tuning.mean-field-steps", config.fine_tuning.mean_field_steps,
        "unrolled steps of eq 32 and 33");
  visit("fine-tuning.hold-out-among", config.hold_out_among,
        "hold one of at least so many people out, and stop when they fare worse; 0: never");
  visit("augment.views", config.augment.views, "augmented views of each clip");
  visit("augment.mirror", config.augment.mirror, "exchange left and right in every other view");
  visit("augment.azimuth", config.augment.azimuth_deg, "camera azimuth varies by so many degrees");
  visit("augment.elevation", config.augment.elevation_deg, "camera elevation likewise");
  visit("augment.distance", config.augment.distance, "relative deviation of the camera distance");
  visit("augment.bone", config.augment.bone, "relative deviation of bone lengths");
  visit("augment.turn", config.augment.turn_deg, "deviation of a joint's carriage in degrees");
  visit("augment.speed", config.augment.speed, "relative change of speed");
  visit("augment.noise", config.augment.noise_px,
        "pixels of noise on 2D joints of a 200 px figure");
  visit("augment.missing", config.augment.missing,
        "share of the views in which limbs go out of sight");
  visit("camera.azimuth", config.camera.azimuth_deg, "degrees around the clip, 0 in front");
  visit("camera.elevation", config.camera.elevation_deg, "degrees above the horizon");
  visit("camera.fov", config.camera.field_of_view_deg, "vertical field of view in degrees");
}

}  // namespace mcdbn
