// Every gradient of multi-prediction (eq 42) and its Adam update, in one launch over the outputs of
// multi_prediction.cl, whose names and stacks are used here. Work-item t computes one TILE_ROWS x VEC
// tile of one parameter and updates it in place; of W it writes the transposed copy too. Tiles of
// W_0 come first, then those of W_1, a_0, a_1 and b; the last work-item adds up the losses.
//
// global: (tiles + 1). Compile-time: VISIBLE_0, VISIBLE_1, HIDDEN, STEPS, TILE_ROWS (divides 16).
// `adam`: rate, β1, β2, ε; `correction`: 1 − β1^t, 1 − β2^t, weight decay, unused.

#include "philox.clh"
#include "activation.clh"
#include "mrbm_shape.clh"

#ifndef TILE_ROWS
#define TILE_ROWS 16
#endif

// update.cl's adam_update at one place, and the gradient for whoever asks
INLINE floatN update(global float* parameter, global float* mean, global float* square,
                     global float* gradient, int at, floatN g, float4 adam, float4 correction) {
  const floatN m = adam.y * loadN(at, mean) + (1.0f - adam.y) * g;
  const floatN s = adam.z * loadN(at, square) + (1.0f - adam.z) * g * g;
  const floatN value = loadN(at, parameter);
  storeN(g, at, gradient);
  storeN(m, at, mean);
  storeN(s, at, square);
  const floatN step = (m / correction.x) / (sqrt(s / correction.y) + adam.w);
  const floatN updated = value - adam.x * (step + correction.z * value);
  storeN(updated, at, parameter);
  return updated;
}

// sum[r] += Σ_i x[i · x_ld + r] · y[i · H_LD …]
INLINE void add_products(floatN sum[TILE_ROWS], int rows, global const float* x, const int x_ld,
                         global const float* y) {
  for (int i = 0; i < rows; ++i) {
    const floatN row = loadN(i * H_LD, y);
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) sum[r] = fma((floatN)(x[i * x_ld + r]), row, sum[r]);
  }
}

INLINE floatN column_sum(global const float* x, int rows, const int ld) {
  floatN sum = (floatN)(0.0f);
  for (int i = 0; i < rows; ++i) sum += loadN(i * ld, x);
  return sum;
}

// W of a modality: through each step of the direction in which it is absent, and through the drive
// of the other.
INLINE void update_w(int tile, const int units, int stride, global const float* codes,
                     global const float* values, global const float* value_errors,
                     global const float* hidden, global const float* hidden_errors,
                     global const float* drive_errors, global float* w, global float* wt,
                     global float* mean, global float* square, global float* gradient, float4 adam,
                     float4 correction) {
  const int ld = PADDED(units);
  const int row0 = tile / (H_LD / VEC) * TILE_ROWS;
  const int column = tile % (H_LD / VEC) * VEC;
  floatN sum[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) sum[r] = (floatN)(0.0f);
  add_products(sum, STEPS * stride, value_errors + row0, ld, hidden + column);
  add_products(sum, (STEPS - 1) * stride, values + row0, ld,
               hidden_errors + stride * H_LD + column);
  add_products(sum, stride, codes + row0, ld, drive_errors + column);
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) {
    if (row0 + r >= units) break;
    const floatN value = update(w, mean, square, gradient, (row0 + r) * H_LD + column, sum[r], adam,
                                correction);
    float lanes[VEC];
    storeN(value, 0, lanes);
    for (int lane = 0; lane < VEC && column + lane < HIDDEN; ++lane)
      wt[(column + lane) * ld + row0 + r] = lanes[lane];
  }
}

kernel void multi_prediction_update(
    int stride, global const float* codes_0, global const float* values_0,
    global const float* value_errors_0, global const float* codes_1, global const float* values_1,
    global const float* value_errors_1, global const float* hidden,
    global const float* hidden_errors, global const float* drive_errors, global float* w_0,
    global float* wt_0, global float* w_mean_0, global float* w_square_0, global float* w_gradient_0,
    global float* w_1, global float* wt_1, global float* w_mean_1, global float* w_square_1,
    global float* w_gradient_1, global float* a_0, global float* a_mean_0, global float* a_square_0,
    global float* a_gradient_0, global float* a_1, global float* a_mean_1, global float* a_square_1,
    global float* a_gradient_1, global float* b, global float* b_mean, global float* b_square,
    global float* b_gradient, float4 adam, float4 correction, global const float* loss, int rows,
    global float* loss_sums) {
  const int stack = STEPS * stride * H_LD, block = stride * H_LD;
  const int tiles_0 = PADDED(VISIBLE_0) / TILE_ROWS * (H_LD / VEC);
  const int tiles_1 = PADDED(VISIBLE_1) / TILE_ROWS * (H_LD / VEC);
  const float4 no_decay = (float4)(correction.xy, 0.0f, 0.0f);
  int tile = get_global_id(0);
  if (tile < tiles_0) {
    update_w(tile, VISIBLE_0, stride, codes_0, values_0, value_errors_0, hidden, hidden_errors,
             drive_errors + block, w_0, wt_0, w_mean_0, w_square_0, w_gradient_0, adam, correction);
    return;
  }
  tile -= tiles_0;
  if (tile < tiles_1) {
    update_w(tile, VISIBLE_1, stride, codes_1, values_1, value_errors_1, hidden + stack,
             hidden_errors + stack, drive_errors, w_1, wt_1, w_mean_1, w_square_1, w_gradient_1,
             adam, correction);
    return;
  }
  tile = (tile - tiles_1) * VEC;
  if (tile < PADDED(VISIBLE_0)) {
    const floatN g = column_sum(value_errors_0 + tile, STEPS * stride, PADDED(VISIBLE_0));
    update(a_0, a_mean_0, a_square_0, a_gradient_0, tile, g, adam, no_decay);
    return;
  }
  tile -= PADDED(VISIBLE_0);
  if (tile < PADDED(VISIBLE_1)) {
    const floatN g = column_sum(value_errors_1 + tile, STEPS * stride, PADDED(VISIBLE_1));
    update(a_1, a_mean_1, a_square_1, a_gradient_1, tile, g, adam, no_decay);
    return;
  }
  tile -= PADDED(VISIBLE_1);
  if (tile < H_LD) {
    const floatN g = column_sum(drive_errors + tile, 2 * stride, H_LD);
    update(b, b_mean, b_square, b_gradient, tile, g, adam, no_decay);
    return;
  }
  if (tile != H_LD) return;
  // Slot 0 is the pose (1) from the track (0), slot 1 the other way round; a mean over units.
  float sum_0 = 0.0f, sum_1 = 0.0f;
  for (int i = 0; i < rows; ++i) {
    sum_0 += loss[i];
    sum_1 += loss[stride + i];
  }
  loss_sums[0] += sum_1 / (float)(rows * VISIBLE_1);
  loss_sums[1] += sum_0 / (float)(rows * VISIBLE_0);
}
