#include "learning/squared_loss.hpp"

#include <algorithm>

#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "device/training_state.hpp"

namespace mcdbn {

void require_windows(const SequenceWindows& windows, const Matrix& prediction, const Matrix& target,
                     const Matrix& error) {
  require(prediction.rows() >= windows.rows() && target.rows() >= windows.rows() &&
              error.rows() >= windows.rows() && prediction.columns() == target.columns() &&
              error.columns() == target.columns(),
          "window loss: shapes differ");
}

SquaredLoss::SquaredLoss(Device& device, const SequenceWindows& windows, double weight,
                         const Matrix* seen)
    : windows_(windows),
      weight_(weight),
      seen_(seen),
      losses_(device, windows.rows(), 1),
      sum_(device, 1, 1) {
  if (seen) seen_count_ = Matrix(device, 1, seen->columns());
}

void SquaredLoss::differentiate(const Matrix& prediction, const Matrix& target, Matrix& error) {
  require_windows(windows_, prediction, target, error);
  Device& device = error.device();
  Defines defines{{"DIMENSION", to_int(target.columns())}, {"LD", to_int(target.stride())}};
  if (seen_) defines["MASKED"] = 1;
  const int count = to_int(windows_.count), frames = to_int(windows_.frames),
            judged_from = to_int(windows_.judged_from);
  const auto run = [&](const auto&... more) {
    launch(device, device.programs().kernel("squared_loss.cl", "squared_loss", defines),
           {{windows_.rows(), 1}}, prediction.buffer(), target.buffer(), count, frames, judged_from,
           static_cast<float>(weight_), error.buffer(), losses_.buffer(), to_int(losses_.stride()),
           more...);
  };
  if (seen_) {
    require_windows(windows_, *seen_, target, error);
    launch(device, device.programs().kernel("squared_loss.cl", "count_seen", defines),
           {{target.columns(), 1}}, seen_->buffer(), count, frames, judged_from,
           seen_count_.buffer());
    run(seen_->buffer(), seen_count_.buffer());
  } else {
    run();
  }
  column_sum(losses_, 1.0F, 1.0F, sum_);
  ++steps_;
}

void SquaredLoss::visit_state(TrainingState& state) {
  state.matrix("loss", sum_);
  state.number("loss.steps", steps_);
}

double SquaredLoss::read_and_reset() {
  const double sum = sum_.to_host()(0) / static_cast<double>(std::max(steps_, 1UL));
  sum_.set_zero();
  steps_ = 0;
  return sum;
}

}  // namespace mcdbn
