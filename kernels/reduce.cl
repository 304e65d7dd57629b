// Losses, reduced on the device in a fixed order: one partial sum a row, then one work-item adds
// them to accumulator[slot]; the host reads the accumulators once an epoch. block_sum adds up the
// blocks of rows that a back-propagation through several steps keeps.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16
//   VEC=1,4 UNROLL=16

#include "types.clh"

// partial[r] = sum_c (x[r, c] − y[r, c])²; global: (rows)
kernel void squared_error_rows(global const float* x, int x_offset, int x_ld,
                               global const float* y, int y_offset, int y_ld, int columns,
                               global float* partial) {
  const int row = get_global_id(0);
  x += x_offset + row * x_ld;
  y += y_offset + row * y_ld;
  float sum = 0.0f;
  UNROLLED
  for (int c = 0; c < columns; ++c) sum = fma(x[c] - y[c], x[c] - y[c], sum);
  partial[row] = sum;
}

// partial[r] = sum_c (factor[c] · (x[r, c] − y[r, c]))²; global: (rows)
kernel void scaled_squared_error_rows(global const float* x, int x_offset, int x_ld,
                                      global const float* y, int y_offset, int y_ld, int columns,
                                      global const float* factor, global float* partial) {
  const int row = get_global_id(0);
  x += x_offset + row * x_ld;
  y += y_offset + row * y_ld;
  float sum = 0.0f;
  UNROLLED
  for (int c = 0; c < columns; ++c) {
    const float difference = factor[c] * (x[c] - y[c]);
    sum = fma(difference, difference, sum);
  }
  partial[row] = sum;
}

// partial[r] = − sum_c x·log y + (1 − x)·log(1 − y), y kept away from 0 and 1; global: (rows)
kernel void cross_entropy_rows(global const float* x, int x_offset, int x_ld,
                               global const float* y, int y_offset, int y_ld, int columns,
                               global float* partial) {
  const int row = get_global_id(0);
  x += x_offset + row * x_ld;
  y += y_offset + row * y_ld;
  float sum = 0.0f;
  for (int c = 0; c < columns; ++c) {
    float p = y[c];  // comparisons let a NaN through to the divergence guard, clamp() would not
    p = p < 1e-7f ? 1e-7f : p;
    p = p > 1.0f - 1e-7f ? 1.0f - 1e-7f : p;
    sum -= x[c] * log(p) + (1.0f - x[c]) * log(1.0f - p);
  }
  partial[row] = sum;
}

// accumulator[slot] += scale · sum(partial); global: (1)
kernel void accumulate(global const float* partial, int rows, float scale,
                       global float* accumulator, int slot) {
  float sum = 0.0f;
  UNROLLED
  for (int row = 0; row < rows; ++row) sum += partial[row];
  accumulator[slot] += scale * sum;
}

// out[r, c] = sum over blocks t of in[t · rows + r, c]; global: (ceil(columns / VEC), rows)
kernel void block_sum(global const float* in, int ld, int rows, int blocks, int columns,
                      global float* out, int out_ld) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  floatN sum = (floatN)(0.0f);
  UNROLLED
  for (int t = 0; t < blocks; ++t) sum += loadN((t * rows + row) * ld + column, in);
  storeN(sum, row * out_ld + column, out);
}
