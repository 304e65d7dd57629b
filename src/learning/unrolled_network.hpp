#pragma once

#include <array>
#include <deque>
#include <vector>

#include "device/updates.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// The same layer over units about zero: binary units are probabilities less one half, so that what
/// weights do is told apart from what biases do, by Adam and by weight decay (Montavon and Müller
/// 2012). Nothing that the layer computes changes but the half.
CrbmParameters centered(CrbmParameters layer);
CrbmParameters uncentered(CrbmParameters layer);
MrbmParameters centered(MrbmParameters mrbm);
MrbmParameters uncentered(MrbmParameters mrbm);

/// One matrix of the network in training.
struct TrainedParameter {
  TrainedParameter(Matrix& trained, bool weights);
  Matrix* value;
  bool is_weight;  ///< biases do not decay
  Matrix gradient, mean, square;
  Matrix average;  ///< over the last steps
};

/// A whole MCDBN in training by back-propagation: all parameters in centered form with what Adam
/// needs, and the copies that the backward pass reads.
class UnrolledNetwork {
 public:
  /// @param mean_field_steps that the result takes too, whatever `start` took
  UnrolledNetwork(Device& device, const Mcdbn& start, std::size_t mean_field_steps);
  UnrolledNetwork(const UnrolledNetwork&) = delete;
  UnrolledNetwork& operator=(const UnrolledNetwork&) = delete;

  struct Layer {
    Layer(Device& device, const CrbmParameters& parameters);
    Layer(const Layer&) = delete;
    Layer& operator=(const Layer&) = delete;
    Crbm crbm;  ///< centered
    TrainedParameter W, A, B, a, b;
    Matrix A_following, B_following;  ///< transpose_lags of A and B
  };
  std::deque<Layer>& layers(Modality modality) { return layers_[index_of(modality)]; }
  Mrbm& mrbm() { return mrbm_; }
  TrainedParameter& mrbm_W(Modality modality) { return mrbm_W_[index_of(modality)]; }
  TrainedParameter& mrbm_a(Modality modality) { return mrbm_a_[index_of(modality)]; }
  TrainedParameter& mrbm_b() { return mrbm_b_; }
  std::size_t mean_field_steps() const { return mean_field_steps_; }
  Device& device() const { return mrbm_.device(); }

  std::vector<TrainedParameter*> parameters();
  void clear_gradients();
  /// Adam on all parameters with a gradient of at most `longest_gradient`, then the moving average
  /// keeps `average_kept` of itself.
  void update(const AdamRule& rule, float longest_gradient, float average_kept);
  /// The moving average of the parameters in their place, to be judged; again: back.
  void exchange_averages();
  /// The network that the moving average of the parameters makes.
  Mcdbn averaged();

 private:
  void refresh_copies();

  std::size_t look_ahead_, mean_field_steps_;
  std::array<std::deque<Layer>, 2> layers_;
  Mrbm mrbm_;
  std::deque<TrainedParameter> mrbm_W_, mrbm_a_;
  TrainedParameter mrbm_b_;
  GradientLimit limit_;
  int updates_ = 0;
};

}  // namespace mcdbn
