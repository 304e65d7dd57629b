#pragma once

#include <cstdint>
#include <functional>

#include "reference/unrolled_gradient.hpp"

namespace mcdbn::reference {

/// Everything that shapes a run of fine-tuning.
struct FineTuningSettings {
  std::uint64_t seed = 1;
  std::size_t look_ahead = 0;  ///< frames that the 2D window is later by
  std::size_t steps = 1, windows = 1, window_frames = 2, settle_frames = 0;
  double people_power = 1.0;
  double rate = 1e-3, weight_decay = 0, dropout = 0, average = 0, reverse = 0;
  int mean_field_steps = 1;
};

/// Clips of both modalities, frame by frame, and who is seen in each.
struct FineTuningData {
  std::vector<MatrixD> tracks, poses;
  std::vector<std::size_t> people;
};

/// How the windows of a mini-batch lie, behind one another: `frames` each, predicted from `first`
/// on, judged from `judged_from` on.
struct WindowLayout {
  Eigen::Index count = 0, frames = 0, first = 0, judged_from = 0;
};

/// A loss on the windows of a mini-batch and its derivative by the prediction.
struct Judgement {
  double loss = 0;
  MatrixD error;
};
using Judge =
    std::function<Judgement(const WindowLayout&, const MatrixD& prediction, const MatrixD& target)>;

/// weight · mean squared difference of the judged frames.
Judgement mean_squared(const WindowLayout& layout, const MatrixD& prediction, const MatrixD& target,
                       double weight);

/// The windows of mini-batch `step`, behind one another, in both modalities.
struct DrawnWindows {
  MatrixD track, pose;
};
DrawnWindows drawn_windows(const FineTuningData& data, const WindowLayout& layout,
                           const FineTuningSettings& settings, std::size_t step);

/// The drop-out of window `window` in mini-batch `step`.
/// @param first_phase 0 for 3D from 2D, 0x100 for 2D from 3D
DropOut drawn_drop_out(const UnrolledModel& model, int present, const FineTuningSettings& settings,
                       std::size_t step, std::uint16_t first_phase, std::uint32_t window);

/// Calls call(matrix, whether it is a weight, name) for all parameters, in the order of
/// flattened().
template <typename Model, typename Call>
void for_each_matrix(Model& model, const Call& call) {
  for (auto& stack : model.stacks)
    for (auto& layer : stack) {
      call(layer.weights, true, "W");
      call(layer.visible_history, true, "A");
      call(layer.hidden_history, true, "B");
      call(layer.visible_bias, false, "a");
      call(layer.hidden_bias, false, "b");
    }
  for (std::size_t m = 0; m < 2; ++m) {
    call(model.mrbm.weights[m], true, "MRBM W");
    call(model.mrbm.visible_bias[m], false, "MRBM a");
  }
  call(model.mrbm.hidden_bias, false, "MRBM b");
}

/// The whole of fine-tuning, mini-batch by mini-batch, in double precision.
class FineTuning {
 public:
  /// @param start in ordinary form  @param judge_pose the loss on 3D
  FineTuning(const UnrolledModel& start, FineTuningData data, const FineTuningSettings& settings,
             Judge judge_pose);

  /// One mini-batch. @return its loss on 3D
  double step();
  /// The length of the last mini-batch's gradient, before it was cut.
  double gradient_length() const { return gradient_length_; }
  /// The moving average of the parameters, in centered form.
  UnrolledModel averaged() const { return shape_.with_parameters(average_); }
  /// The loss of the moving average on the first four mini-batches of other data, without drop-out.
  double loss_on(const FineTuningData& others) const;
  const WindowLayout& layout() const { return layout_; }

 private:
  Eigen::VectorXd gradient(double& loss) const;
  void learn(const Eigen::VectorXd& gradient);

  FineTuningSettings settings_;
  FineTuningData data_;
  Judge judge_pose_;
  UnrolledModel shape_;  ///< of the centered model; its parameters are `value_`
  WindowLayout layout_;
  Eigen::VectorXd value_, mean_, square_, average_, is_weight_;
  double gradient_length_ = 0;
  std::size_t done_ = 0;
};

}  // namespace mcdbn::reference
