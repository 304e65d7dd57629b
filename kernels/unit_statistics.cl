// What a CRBM's units are like over a mini-batch, and what is made of it: hidden units that should seldom
// be on, and the deviation of Gaussian visible units. Matrices are row-major, leading dimensions in floats,
// padding columns zero. global: (ceil(columns / VEC))
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16
//   VEC=1,4 UNROLL=16

#include "types.clh"

// Hinton (2010), section 11: the derivative of the cross-entropy between the activity of a hidden unit,
// averaged over past mini-batches, and the target, with respect to the unit's input: activity − target,
// the same for every row. It is taken off the data's side of all gradients.
// activity[j] ← kept · activity[j] + (1 − kept) · mean over rows of hidden_data
kernel void pull_to_target(global float* hidden_data, global float* hidden_change, int ld, int rows,
                           int columns, float kept, float target, float strength,
                           global float* activity) {
  const int column = get_global_id(0) * VEC;
  if (column >= columns) return;
  floatN sum = (floatN)(0.0f);
  UNROLLED
  for (int row = 0; row < rows; ++row) sum += loadN(row * ld + column, hidden_data);
  const floatN mask = column_mask(column, columns);
  const floatN average = kept * loadN(column, activity) + (1.0f - kept) * (sum / (float)rows);
  storeN(average, column, activity);
  const floatN pull = mask * (strength * (average - target));
  for (int row = 0; row < rows; ++row) {
    storeN(loadN(row * ld + column, hidden_data) - pull, row * ld + column, hidden_data);
    storeN(loadN(row * ld + column, hidden_change) - pull, row * ld + column, hidden_change);
  }
}

// The deviation σ of Gaussian units, whose data are u = v / σ: log p(v) has the derivative
// mean of u (u − reconstruction) − 1 with respect to log σ, where reconstruction = a + p(h | u) Wᵀ; the
// partition function of u does not know σ. σ ← σ · exp(rate · derivative)
kernel void deviation_update(global const float* data, global const float* reconstruction, int ld,
                             int rows, int columns, float rate, global float* deviation) {
  const int column = get_global_id(0) * VEC;
  if (column >= columns) return;
  floatN sum = (floatN)(0.0f);
  UNROLLED
  for (int row = 0; row < rows; ++row) {
    const floatN u = loadN(row * ld + column, data);
    sum = fma(u, u - loadN(row * ld + column, reconstruction), sum);
  }
  const floatN derivative = sum / (float)rows - 1.0f;
  storeN(column_mask(column, columns) * loadN(column, deviation) * exp(rate * derivative), column,
         deviation);
}
