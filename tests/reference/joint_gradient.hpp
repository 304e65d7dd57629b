#pragma once

#include "reference/joint_reference.hpp"

namespace mcdbn::reference {

/// The same network over units about zero: binary units are probabilities less one half, which the
/// biases take up.
JointModel centered(const JointModel& model);
JointModel uncentered(const JointModel& model);

/// Algorithm 3 on one window through a centered network, and the way back: the derivative of any
/// loss on the prediction by all centered parameters.
class JointGradient {
 public:
  /// @param values the present modality [frames x D]  @param first the first frame that is
  /// predicted
  JointGradient(const JointModel& centered_model, int present, const MatrixD& values, int first,
                int mean_field_steps, const DropOut& drop_out);

  /// [frames x D'], the layer's start before `first`.
  const MatrixD& prediction() const { return down_.front().dropped; }
  /// Adds dL/d parameters to `sum`. @param error dL/d prediction [frames x D'], 0 before `first`
  void add_to(JointModel& sum, const MatrixD& error) const;

 private:
  /// Units of one layer in every frame, before and after drop-out.
  struct Units {
    MatrixD own, dropped;
    RowVectorD factors;
  };
  static void drop(Units& units, Eigen::Index row);
  /// dL/d input from dL/d unit after drop-out.
  static RowVectorD through(const Units& units, Eigen::Index row, const RowVectorD& error);

  void go_up();
  void infer(int steps);
  void go_down();
  MatrixD back_down(JointModel& sum, MatrixD error) const;
  MatrixD back_through_mean_field(JointModel& sum, const MatrixD& error) const;
  void back_up(JointModel& sum, MatrixD error) const;

  const JointModel& model_;
  std::size_t p_, q_;
  Eigen::Index frames_, first_;
  MatrixD values_;
  std::vector<Units> up_, shared_, missing_, down_;
};

}  // namespace mcdbn::reference
