#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "mcdbn/motion/camera.hpp"
#include "mcdbn/training/augmentation.hpp"

namespace mcdbn {

/// How one kind of CRBM layer is trained (Algorithm 2, eq 36 to 41).
struct CdSettings {
  std::size_t gibbs_steps = 5;  ///< k of CD-k
  double rate = 1e-3;           ///< of W, a and b
  double rate_A = 1e-5;         ///< much smaller, or A explains everything by itself
  double rate_B = 1e-3;
  double momentum = 0.9;
  std::size_t momentum_from_epoch = 5;  ///< 0 before
  double weight_decay = 2e-4;           ///< of W, A and B
  double initial_deviation = 0.01;      ///< of the first weights, where no joint stage follows
  std::size_t epochs = 3;
};

/// Multi-prediction training of the MRBM (eq 42).
struct MultiPredictionSettings {
  double rate = 3e-4;  ///< Adam's, for the first half; then it falls in a line to a fiftieth
  double weight_decay = 0.0;
  double initial_deviation = 0.01;  ///< of the first weights, where no joint stage follows
  std::size_t mean_field_steps = 5;
  std::size_t epochs = 1;
};

/// The joint MinVI stage through the whole stack (joint_fine_tuning.hpp).
struct JointSettings {
  std::size_t steps = 3000;  ///< mini-batches; 0 leaves the stage out
  /// The greedy stages come first, on the same augmented views and from weights of the size that
  /// the joint stage wants.
  bool from_greedy = true;
  std::size_t windows = 48;  ///< in a mini-batch
  /// Windows are drawn from people as their frames to this power: 1 draws every frame alike, 0
  /// every person, however many clips there are of them.
  double people_power = 0.5;
  std::size_t window_frames = 20;  ///< judged frames of a window
  std::size_t settle_frames = 4;   ///< frames before them that run freely too
  double rate = 2e-3;              ///< Adam's; falls along a cosine to a fiftieth
  double weight_decay = 1.0;       ///< decoupled, times the rate
  double dropout = 0.0;            ///< of hidden units, the same throughout a window
  double average = 0.995;   ///< kept of the moving average of parameters, which is the result
  double places = 0.5;      ///< weight of joint places (PoseLossWeights), features have 1
  double velocities = 0.2;  ///< and of their steps from frame to frame
  double contacts = 0.1;    ///< and of the steps of planted feet
  double reverse = 0.1;     ///< weight of the other direction, 2D from 3D
  std::size_t mean_field_steps = 2;
  /// Of at least so many people one is held out (held_out_person.hpp), and the stage stops when
  /// that person fares worse; 0: never. Of few nobody can be spared: without one of nine CMU
  /// walkers the error on strangers is 28.7 instead of 23.6 mm, and the one held out did better to
  /// the end.
  std::size_t hold_out_among = 20;
};

/// Everything that shapes a training run: the paper's Table 2 and section V, and what it leaves
/// out.
struct TrainingConfig {
  std::uint64_t seed = 1;
  double fps = 30.0;
  std::size_t phases = 1;  ///< sampling grids taken from each clip where its own rate allows
  bool keep_first_frame = false;
  CameraPlacement camera;

  /// One CRBM that sees 10 frames of history in each CDBN, where the paper has two of order 5: the
  /// same frames in all, at a third of the cost, so that the layer can be wider and trained longer.
  std::size_t order = 10;
  std::size_t hidden = 768;
  std::size_t layers = 1;
  std::size_t mrbm_hidden = 512;
  std::size_t look_ahead = 5;  ///< the MRBM pairs the 2D code of frame t + look_ahead with 3D of t
  std::size_t batch = 100;
  /// An epoch has at least so many mini-batches: few clips are gone over several times in it, or
  /// the rates and epochs that suit an hour of motion would stop long before a minute's was learnt.
  std::size_t least_batches = 40;

  CdSettings gaussian;
  CdSettings binary{.gibbs_steps = 1, .rate = 1e-2, .rate_A = 1e-3, .rate_B = 1e-3};
  MultiPredictionSettings mrbm;
  JointSettings joint;
  AugmentationSettings augment;

  /// The paper's architecture for the greedy stages alone, at rates and for epochs that train it:
  /// two CRBMs of order 5 and 300 units in each CDBN.
  static TrainingConfig greedy();
  /// The paper's own figures (Table 2, section V.C): rate 0.1, momentum 0.9, weights from N(0, 1),
  /// MRBM of 150, no look-ahead. Diverges (DESIGN section 2): the guard says so.
  static TrainingConfig paper();
  /// @throws ConfigError naming the setting that is out of range
  void validate() const;
};

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
  visit("joint.steps", config.joint.steps,
        "mini-batches of the joint stage; 0: as --stages greedy");
  visit("joint.from-greedy", config.joint.from_greedy,
        "the greedy stages come before it; else they are left out");
  visit("joint.windows", config.joint.windows, "windows in a mini-batch");
  visit("joint.people-power", config.joint.people_power,
        "1: every frame counts alike; 0: every person, told by their bones");
  visit("joint.window-frames", config.joint.window_frames, "judged frames of a window");
  visit("joint.settle-frames", config.joint.settle_frames, "free-running frames before them");
  visit("joint.rate", config.joint.rate, "Adam's rate");
  visit("joint.weight-decay", config.joint.weight_decay, "decoupled decay of the weights");
  visit("joint.dropout", config.joint.dropout, "share of hidden units left out");
  visit("joint.average", config.joint.average, "kept of the parameters' moving average");
  visit("joint.places", config.joint.places, "weight of joint places in the loss");
  visit("joint.velocities", config.joint.velocities, "weight of joint velocities in the loss");
  visit("joint.contacts", config.joint.contacts, "weight of planted feet's steps in the loss");
  visit("joint.reverse", config.joint.reverse, "weight of 2D from 3D");
  visit("joint.mean-field-steps", config.joint.mean_field_steps, "unrolled steps of eq 32 and 33");
  visit("joint.hold-out-among", config.joint.hold_out_among,
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
