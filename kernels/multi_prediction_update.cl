// Every gradient of multi-prediction (eq 42) and its Adam update, over the outputs of
// multi_prediction.cl, whose names and stacks are used here. Two launches: the stacks are long (STEPS
// times the mini-batch) and wide, so multi_prediction_products adds up the tiles of W over pieces of
// them that stay in a core's cache, and multi_prediction_update adds up the pieces, in order, and
// updates. A tile is TILE_ROWS x VEC; tiles of W_0 come first, then those of W_1; in the update those
// of a_0, a_1 and b follow, and the last work-item adds up the losses.
//
// multi_prediction_products: global (at least the tiles of W_0 and W_1, pieces). The pieces of PIECE_ROWS rows
//   count through three products: value_errorsᵀ·hidden, valuesᵀ·hidden_errors of the step after, and
//   codesᵀ·drive_errors of the other direction. partial[piece][tile][TILE_ROWS][VEC].
// multi_prediction_update: global (tiles + 1).
// Compile-time: VISIBLE_0, VISIBLE_1, HIDDEN, STEPS, TILE_ROWS (divides 16), PIECE_ROWS.
// `adam`: rate, β1, β2, ε; `correction`: 1 − β1^t, 1 − β2^t, weight decay, unused.

#include "units.clh"
#include "mrbm_shape.clh"

#ifndef TILE_ROWS
#define TILE_ROWS 16
#endif
#ifndef PIECE_ROWS
#define PIECE_ROWS 1024
#endif

#define PIECES(rows) (((rows) + PIECE_ROWS - 1) / PIECE_ROWS)
#define TILES(units) (PADDED(units) / TILE_ROWS * (H_LD / VEC))
#define ALL_TILES (TILES(VISIBLE_0) + TILES(VISIBLE_1))

// optimizers.cl's adam_update at one place, and the gradient for whoever asks
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

INLINE floatN column_sum(global const float* x, int rows, const int ld) {
  floatN sum = (floatN)(0.0f);
  for (int i = 0; i < rows; ++i) sum += loadN(i * ld, x);
  return sum;
}

// A tile of one piece: Σ_i x[i · x_ld + r] · y[i · H_LD …]
INLINE void piece_product(int rows, global const float* x, const int x_ld, global const float* y,
                          global float* partial) {
  floatN sum[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) sum[r] = (floatN)(0.0f);
  for (int i = 0; i < rows; ++i) {
    const floatN row = loadN(i * H_LD, y);
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) sum[r] = fma((floatN)(x[i * x_ld + r]), row, sum[r]);
  }
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) storeN(sum[r], r * VEC, partial);
}

kernel void multi_prediction_products(
    int stride, global const float* codes_0, global const float* values_0,
    global const float* value_errors_0, global const float* codes_1, global const float* values_1,
    global const float* value_errors_1, global const float* hidden,
    global const float* hidden_errors, global const float* drive_errors, global float* partial) {
  if (get_global_id(0) >= ALL_TILES) return;
  const bool is_0 = get_global_id(0) < TILES(VISIBLE_0);
  const int tile = get_global_id(0) - (is_0 ? 0 : TILES(VISIBLE_0));
  const int ld = is_0 ? PADDED(VISIBLE_0) : PADDED(VISIBLE_1);
  const int row0 = tile / (H_LD / VEC) * TILE_ROWS, column = tile % (H_LD / VEC) * VEC;
  const int block = stride * H_LD, direction = is_0 ? 0 : STEPS * block;
  partial += (get_global_id(1) * ALL_TILES + get_global_id(0)) * TILE_ROWS * VEC;

  int piece = get_global_id(1), rows = STEPS * stride;
  global const float* x = is_0 ? value_errors_0 : value_errors_1;
  global const float* y = hidden + direction;
  if (piece >= PIECES(rows)) {
    piece -= PIECES(rows);
    rows = (STEPS - 1) * stride;
    x = is_0 ? values_0 : values_1;
    y = hidden_errors + direction + block;
    if (piece >= PIECES(rows)) {
      piece -= PIECES(rows);
      rows = stride;
      x = is_0 ? codes_0 : codes_1;
      y = drive_errors + (is_0 ? block : 0);
    }
  }
  const int first = piece * PIECE_ROWS;
  piece_product(min(PIECE_ROWS, rows - first), x + first * ld + row0, ld, y + first * H_LD + column,
                partial);
}

INLINE void update_w(int tile, const int units, int pieces, global const float* partial,
                     global float* w, global float* wt, global float* mean, global float* square,
                     global float* gradient, float4 adam, float4 correction) {
  const int ld = PADDED(units);
  const int row0 = tile / (H_LD / VEC) * TILE_ROWS;
  const int column = tile % (H_LD / VEC) * VEC;
  floatN sum[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) sum[r] = (floatN)(0.0f);
  for (int piece = 0; piece < pieces; ++piece) {
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) sum[r] += loadN(r * VEC, partial);
    partial += ALL_TILES * TILE_ROWS * VEC;
  }
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
    int stride, int pieces, global const float* partial, global const float* value_errors_0,
    global const float* value_errors_1, global const float* drive_errors, global float* w_0,
    global float* wt_0, global float* w_mean_0, global float* w_square_0, global float* w_gradient_0,
    global float* w_1, global float* wt_1, global float* w_mean_1, global float* w_square_1,
    global float* w_gradient_1, global float* a_0, global float* a_mean_0, global float* a_square_0,
    global float* a_gradient_0, global float* a_1, global float* a_mean_1, global float* a_square_1,
    global float* a_gradient_1, global float* b, global float* b_mean, global float* b_square,
    global float* b_gradient, float4 adam, float4 correction, global const float* loss, int rows,
    global float* loss_sums) {
  const int tiles_0 = TILES(VISIBLE_0), tiles_1 = TILES(VISIBLE_1);
  const float4 no_decay = (float4)(correction.xy, 0.0f, 0.0f);
  int tile = get_global_id(0);
  if (tile < tiles_0) {
    update_w(tile, VISIBLE_0, pieces, partial + tile * TILE_ROWS * VEC, w_0, wt_0, w_mean_0,
             w_square_0, w_gradient_0, adam, correction);
    return;
  }
  tile -= tiles_0;
  if (tile < tiles_1) {
    update_w(tile, VISIBLE_1, pieces, partial + (tiles_0 + tile) * TILE_ROWS * VEC, w_1, wt_1,
             w_mean_1, w_square_1, w_gradient_1, adam, correction);
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
