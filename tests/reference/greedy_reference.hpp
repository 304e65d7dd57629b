#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reference/crbm_reference.hpp"
#include "reference/mrbm_reference.hpp"

/// Algorithm 1 from its first random number to its last parameter, in double precision on the host:
/// which windows, in which order, with which rates and draws. Nothing here is about devices.
namespace mcdbn::reference {

/// One kind of CRBM layer (Algorithm 2).
struct CdPlan {
  int gibbs_steps = 1;
  double rate = 0, rate_A = 0, rate_B = 0;
  double momentum = 0;
  int momentum_from_epoch = 0;  ///< none up to this epoch
  double weight_decay = 0;      ///< of W, A and B
  double initial_deviation = 0;
  double history_noise = 0;  ///< deviation of what is added to each frame of a history
  int epochs = 1;
};

/// The MRBM by multi-prediction with Adam (eq 42).
struct MrbmPlan {
  double rate = 0, weight_decay = 0, initial_deviation = 0;
  int mean_field_steps = 1, epochs = 1;
};

struct GreedyPlan {
  std::uint64_t seed = 1;
  int order = 1, hidden = 1, layers = 1, mrbm_hidden = 1, look_ahead = 0, batch = 1;
  int least_batches = 1;
  double people_power = 1;          ///< groups are drawn as their frames to this power
  std::vector<std::size_t> groups;  ///< of the clips; none: all of one
  CdPlan gaussian, binary;
  MrbmPlan mrbm;
};

/// A layer and the mean of what it was trained on.
struct GreedyLayer {
  Crbm crbm;
  RowVectorD visible_mean;
};

struct GreedyMachine {
  std::vector<GreedyLayer> track, pose;
  Mrbm mrbm;  ///< 0 is the track, 1 the pose
};

struct GreedyStage {
  std::string name;            ///< pose.0, pose.1, …, track.0, …, mrbm
  std::vector<double> losses;  ///< of each epoch
};

struct GreedyRun {
  GreedyMachine machine;
  std::vector<GreedyStage> stages;
  double closest_draw = 1.0;  ///< smallest |p − u| of all draws of hidden units
};

/// Clips as a layer sees them; the first `valid_from` frames of each have no code.
struct GreedyCode {
  std::vector<MatrixD> clips;
  int valid_from = 0;
};

/// Hidden probabilities of every frame that has a history in its own clip.
GreedyCode up_pass(const Crbm& layer, const GreedyCode& visible);

/// @param start what to start from; nothing: small random weights
GreedyRun train_greedy(const GreedyPlan& plan, const std::vector<MatrixD>& tracks,
                       const std::vector<MatrixD>& poses, const GreedyMachine* start = nullptr);

/// One layer alone. @param stream of its random numbers
GreedyRun train_layer(const GreedyPlan& plan, const CdPlan& rule, const GreedyCode& visible,
                      const Crbm& initial, int stream);

}  // namespace mcdbn::reference
