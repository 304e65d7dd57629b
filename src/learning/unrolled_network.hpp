#pragma once

#include <deque>
#include <vector>

#include "device/optimizer.hpp"
#include "mcdbn/machines/mcdbn.hpp"

namespace mcdbn {

/// What a layer's visible units are: data, or the code of the layer beneath.
enum class InputKind { data, code };

/// The layer with its binary units shifted to be about zero, probabilities less one half, so that
/// Adam and weight decay treat the effect of weights apart from that of biases (Montavon and Müller
/// 2012). What the layer computes changes only by that half.
/// @param input_kind a code is moved, data stay as they are
CrbmParameters centered(CrbmParameters layer, InputKind input_kind);
CrbmParameters uncentered(CrbmParameters layer, InputKind input_kind);
MrbmParameters centered(MrbmParameters mrbm);
MrbmParameters uncentered(MrbmParameters mrbm);

/// A whole MCDBN in training by back-propagation: all parameters in centered form in one buffer,
/// the optimizer's, and the copies that the backward pass reads. Deviations of Gaussian units stay
/// as they are.
class UnrolledNetwork {
 public:
  /// @param mean_field_steps that the result takes too, whatever `start` took
  UnrolledNetwork(Device& device, const Mcdbn& start, std::size_t mean_field_steps);
  UnrolledNetwork(const UnrolledNetwork&) = delete;
  UnrolledNetwork& operator=(const UnrolledNetwork&) = delete;

  struct Layer {
    /// @param start centered; its weights and biases are in `parameters`
    Layer(const Parameters& parameters, const Parameters& gradients, const CrbmParameters& start,
          InputKind input_kind);
    Layer(const Layer&) = delete;
    Layer& operator=(const Layer&) = delete;
    Crbm crbm;  ///< centered
    CrbmMatrices gradient;
    Matrix A_following;  ///< transpose_lags of A
    Matrix B_following;  ///< of B, where a layer lies below
  };
  std::deque<Layer>& layers(std::size_t modality) { return layers_[modality]; }
  std::size_t modality_count() const { return layers_.size(); }
  Mrbm& mrbm() { return mrbm_; }
  MrbmMatrices& mrbm_gradient() { return mrbm_gradient_; }
  std::size_t mean_field_steps() const { return mean_field_steps_; }
  Device& device() const { return parameters_.device(); }

  /// With modalities track and pose: track.0.W, track.0.A …, pose.0.W …, mrbm.W_track … mrbm.b
  const Parameters& parameters() const { return parameters_; }
  void clear_gradients() { optimizer_.gradients().set_zero(); }
  /// Adam on all parameters with a gradient of at most `longest_gradient`, then the moving average
  /// keeps `average_kept` of itself.
  void update(const UpdateRule& rule, float longest_gradient, float average_kept);
  /// The moving average of the parameters in their place, to be judged; again: back.
  void exchange_averages();
  /// The moving average of the parameters, laid out as they are. [1 x floats]
  const Matrix& averages() const { return averages_; }
  /// The network that parameters so laid out make.
  Mcdbn with_parameters(const Matrix& values);
  void visit_state(TrainingState& state);

 private:
  void refresh_copies();

  std::size_t look_ahead_, mean_field_steps_;
  Parameters parameters_;
  Optimizer optimizer_;
  std::vector<std::deque<Layer>> layers_;
  Mrbm mrbm_;
  MrbmMatrices mrbm_gradient_;
  GradientLimit limit_;
  Matrix averages_, spare_;  // [1 x floats]
};

}  // namespace mcdbn
