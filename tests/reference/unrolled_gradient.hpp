#pragma once

#include "reference/unrolled_reference.hpp"

namespace mcdbn::reference {

/// The same network over units about zero: binary units but those of the data are probabilities
/// less one half, which the biases take up.
UnrolledModel centered(const UnrolledModel& model);
UnrolledModel uncentered(const UnrolledModel& model);

/// Algorithm 3 on one window through a centered network, and the way back: the derivative of any
/// loss on the prediction by all centered parameters.
class UnrolledGradient {
 public:
  /// @param values the present modality [frames x D]  @param first the first frame that is
  /// predicted
  UnrolledGradient(const UnrolledModel& centered_model, int present, const MatrixD& values,
                   int first, int mean_field_steps, const DropOut& drop_out);

  /// [frames x D'], the layer's start before `first`.
  const MatrixD& prediction() const { return down_.front().dropped; }
  /// Adds dL/d parameters to `sum`. @param error dL/d prediction [frames x D'], 0 before `first`
  void add_to(UnrolledModel& sum, const MatrixD& error) const;

 private:
  /// Units of one layer in every frame, before and after drop-out.
  struct Units {
    MatrixD own, dropped;
    RowVectorD factors;
  };
  static void drop(Units& units, Eigen::Index row);
  /// dL/d input from dL/d unit after drop-out.
  static RowVectorD through(const Units& units, Eigen::Index row, const RowVectorD& error);
  /// The same of binary units of the data, which have no drop-out.
  static RowVectorD through_data(const Units& units, Eigen::Index row, const RowVectorD& error);

  void go_up();
  void infer(int steps);
  void go_down();
  MatrixD back_down(UnrolledModel& sum, MatrixD error) const;
  MatrixD back_through_mean_field(UnrolledModel& sum, const MatrixD& error) const;
  void back_up(UnrolledModel& sum, MatrixD error) const;

  const UnrolledModel& model_;
  std::size_t p_, q_;
  Eigen::Index frames_, first_;
  MatrixD values_;
  std::vector<Units> up_, shared_, missing_, down_;
};

}  // namespace mcdbn::reference
