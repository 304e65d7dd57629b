#pragma once

#include <cstddef>
#include <cstdint>

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
  double initial_deviation = 0.01;      ///< of the first weights, where no fine-tuning follows
  std::size_t epochs = 3;
};

/// Multi-prediction training of the MRBM (eq 42).
struct MultiPredictionSettings {
  double rate = 3e-4;  ///< Adam's, for the first half; then it falls in a line to a fiftieth
  double weight_decay = 0.0;
  double initial_deviation = 0.01;  ///< of the first weights, where no fine-tuning follows
  std::size_t mean_field_steps = 5;
  std::size_t epochs = 1;
};

/// Fine-tuning: MinVI through the whole stack (fine_tuning.hpp).
struct FineTuningSettings {
  std::size_t steps = 3000;  ///< mini-batches; 0 leaves the stage out
  /// The greedy stages come first, on the same views and from weights of the size that fine-tuning
  /// wants.
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
  double average = 0.995;  ///< kept of the moving average of parameters, which is the result
  double reverse = 0.1;    ///< weight of the other direction, 2D from 3D
  std::size_t mean_field_steps = 2;
};

/// The network's size and how it is learnt, whatever the data are: the paper's Table 2 and section
/// V, and what it leaves out.
struct LearningSettings {
  std::uint64_t seed = 1;
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
  FineTuningSettings fine_tuning;

  /// The paper's architecture for the greedy stages alone, at rates and for epochs that train it:
  /// two CRBMs of order 5 and 300 units in each CDBN.
  static LearningSettings greedy();
  /// The paper's own figures (Table 2, section V.C): rate 0.1, momentum 0.9, weights from N(0, 1),
  /// MRBM of 150, no look-ahead. Diverges: the guard says so.
  static LearningSettings paper();
  /// @throws ConfigError naming the setting that is out of range
  void validate() const;
};

}  // namespace mcdbn
