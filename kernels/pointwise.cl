// Pointwise work on whole matrices, row-major, leading dimensions in floats, padding columns zero.
// global: (ceil(columns / VEC), rows) unless stated otherwise at a kernel.
//
// Variants that `scripts/lint kernels` compiles:
//   BIAS=none,row,matrix ACTIVATION=none,sigmoid,relu,centered_sigmoid,sigmoid_gradient,relu_gradient,centered_sigmoid_gradient SAMPLE=0,1,2,3
//   VEC=1,4,8,16 ACTIVATION=none,sigmoid,relu,centered_sigmoid,sigmoid_gradient,relu_gradient,centered_sigmoid_gradient
//   VEC=1,4,8,16 SAMPLE=0,1,2,3
//   VEC=1,4 UNROLL=16

#include "epilogue.clh"

// What a product back end without epilogues (CLBlast) leaves to do.
kernel void epilogue(global float* c, int c_offset, int ldc, int n, global const float* bias,
                     int bias_offset, int bias_ld, global const float* factor, int factor_offset,
                     int factor_ld, global float* sample, int sample_offset, int sample_ld,
                     float temperature, float kept_share, uint4 random) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= n) return;
  const floatN mask = column_mask(column, n);
  floatN value = loadN(c_offset + row * ldc + column, c);
  value = EPILOGUE_VALUE(value, row, column);
  storeN(value, c_offset + row * ldc + column, c);
#if SAMPLE
  uintN draws[DRAW_WORDS];
  draw_four_rows(draws, column, row / 4, random);
  const floatN drawn = sample_units(value, draws, row);
  storeN(mask * (value + temperature * (drawn - value)), sample_offset + row * sample_ld + column,
         sample);
#endif
}

// out[r, :] = frames[rows[first + r] + shift, :]   (columns may run on over several frames: eq 15)
kernel void gather_rows(global const float* frames, int ld, global const int* rows, int first,
                        int shift, int columns, global float* out, int out_offset, int out_ld) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  storeN(loadN((rows[first + row] + shift) * ld + column, frames), out_offset + row * out_ld + column,
         out);
}

// The inverse: frames[rows[first + r] + shift, :] = in[r, :]
kernel void scatter_rows(global const float* in, int in_ld, global float* frames, int ld,
                         global const int* rows, int first, int shift, int columns) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  storeN(loadN(row * in_ld + column, in), (rows[first + row] + shift) * ld + column, frames);
}

// gather_rows of two frame matrices in one launch, rows of out_ld_0 and out_ld_1 floats from the floats
// out_0 and out_1 of `out` on. global: (vectors of the wider, 2 · count)
kernel void gather_two(global const float* frames_0, int ld_0, global const int* rows_0, int first_0,
                       int shift_0, global const float* frames_1, int ld_1,
                       global const int* rows_1, int first_1, int shift_1, int count,
                       global float* out, int out_0, int out_ld_0, int out_1, int out_ld_1) {
  const int column = get_global_id(0) * VEC;
  const bool is_0 = get_global_id(1) < count;
  const int row = is_0 ? get_global_id(1) : get_global_id(1) - count;
  if (column >= (is_0 ? out_ld_0 : out_ld_1)) return;
  if (is_0)
    storeN(loadN((rows_0[first_0 + row] + shift_0) * ld_0 + column, frames_0),
           out_0 + row * out_ld_0 + column, out);
  else
    storeN(loadN((rows_1[first_1 + row] + shift_1) * ld_1 + column, frames_1),
           out_1 + row * out_ld_1 + column, out);
}

// out = scale · (x − y)
kernel void scaled_difference(global const float* x, int x_offset, int x_ld, global const float* y,
                              int y_offset, int y_ld, int columns, float scale, global float* out,
                              int out_offset, int out_ld) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  storeN(scale * (loadN(x_offset + row * x_ld + column, x) - loadN(y_offset + row * y_ld + column, y)),
         out_offset + row * out_ld + column, out);
}

// out = x, each row times its weight, the first column of `weights`
kernel void scale_rows(global const float* x, int x_offset, int x_ld, global const float* weights,
                       int weights_offset, int weights_ld, int columns, global float* out,
                       int out_offset, int out_ld) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  storeN(weights[weights_offset + row * weights_ld] * loadN(x_offset + row * x_ld + column, x),
         out_offset + row * out_ld + column, out);
}

// x[r, c] ← x[r, c] · factor[c], or divided by it
kernel void scale_columns(global float* x, int offset, int ld, int columns,
                          global const float* factor, int divides) {
  const int column = get_global_id(0) * VEC;
  const int at = offset + (int)get_global_id(1) * ld + column;
  if (column >= columns) return;
  // What is divided by is 1 in the padding.
  const floatN by = loadN(column, factor) + (1.0f - column_mask(column, columns));
  storeN(divides ? loadN(at, x) / by : loadN(at, x) * by, at, x);
}

// x[r, c] ← x[r, c] · by[r, c]
kernel void multiply(global float* x, int offset, int ld, int columns, global const float* by,
                     int by_offset, int by_ld) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  const int at = offset + row * ld + column;
  storeN(loadN(at, x) * loadN(by_offset + row * by_ld + column, by), at, x);
}

#if SAMPLE == 1
// Drop-out: keeps an entry, divided by the share that is kept, or makes it zero. Runs of `alike` rows
// share their draws.
kernel void dropout(global float* c, int c_offset, int ldc, int columns, int alike, float kept_share,
                    uint4 random) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  const int draw = row / alike;
  uintN draws[DRAW_WORDS];
  draw_four_rows(draws, column, draw / 4, random);
  const floatN kept = sample_units((floatN)(kept_share), draws, draw);
  const int at = c_offset + row * ldc + column;
  storeN(kept * (loadN(at, c) / kept_share), at, c);
}
#endif

// VEC entries of a column from `row` on, 0 from `rows` on.
static inline floatN column_of(global const float* in, int ld, int column, int row, int rows) {
  float lanes[VEC];
#pragma unroll
  for (int lane = 0; lane < VEC; ++lane)
    lanes[lane] = row + lane < rows ? in[(row + lane) * ld + column] : 0.0f;
  return loadN(0, lanes);
}

// out[c, r] = in[r, c]; global: (columns, ceil(rows / VEC))
kernel void transpose(global const float* in, int ld, int rows, global float* out, int out_ld) {
  const int column = get_global_id(0);
  const int row = get_global_id(1) * VEC;
  storeN(column_of(in, ld, column, row, rows), column * out_ld + row, out);
}

// Weights of a history with the lags turned round: block j of `out` is block lags − 1 − j of `in`,
// transposed, so that the frames after one stand in the order of its history. Blocks of ld_rows rows,
// a multiple of VEC, padding included; global: (columns, lags · ld_rows / VEC)
kernel void transpose_lags(global const float* in, int ld_rows, int ld, global float* out,
                           int out_ld_rows, int out_ld, int lags) {
  const int column = get_global_id(0);
  const int vectors = ld_rows / VEC;
  const int row = get_global_id(1) % vectors * VEC, lag = get_global_id(1) / vectors;
  storeN(column_of(in + lag * ld_rows * ld, ld, column, row, ld_rows),
         ((lags - 1 - lag) * out_ld_rows + column) * out_ld + row, out);
}

// out[0, c] = beta · out[0, c] + scale · sum over rows of in[r, c], rows in ascending order;
// global: (ceil(columns / VEC), 1)
kernel void column_sum(global const float* in, int in_offset, int ld, int rows, int columns,
                       float scale, float beta, global float* out) {
  const int column = get_global_id(0) * VEC;
  if (column >= columns) return;
  floatN sum = (floatN)(0.0f);
  UNROLLED
  for (int row = 0; row < rows; ++row) sum += loadN(in_offset + row * ld + column, in);
  sum *= scale;
  if (beta != 0.0f) sum = fma((floatN)(beta), loadN(column, out), sum);
  storeN(sum, column, out);
}

// Philox words as they are, for the test against the published vectors: out[row, column];
// global: (columns, rows)
kernel void philox_words(global uint* out, int ld, uint4 random) {
  const int column = get_global_id(0);
  const int row = get_global_id(1);
  uintN words[4];
  words[0] = (uintN)((uint)column);
  words[1] = (uintN)((uint)row / 4);
  words[2] = (uintN)(random.z);
  words[3] = (uintN)(random.w);
  philoxN(words, random.x, random.y);
#if VEC == 1
  out[row * ld + column] = words[row & 3];
#else
  out[row * ld + column] = words[row & 3].s0;
#endif
}
