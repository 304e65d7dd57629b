// Every gradient of multi-prediction (eq 42) and what the optimizer makes of it (optimizer.clh), over
// the outputs of multi_prediction.cl, whose names and stacks are used here. Two launches: the stacks are
// long (STEPS times the mini-batch) and wide, so multi_prediction_products adds up the tiles of every W
// over pieces of them that stay in a core's cache, and multi_prediction_update adds up the pieces, in
// order, and updates. A tile is TILE_ROWS x VEC; tiles of the first modality's W come first; in the
// update those of every a and of b follow, and the last work-item adds up the losses.
//
// multi_prediction_products: global (at least the tiles of every W, pieces). The pieces of PIECE_ROWS
//   rows count through the products of a W: value_errorsᵀ·hidden, valuesᵀ·hidden_errors of the step
//   after, and codesᵀ·drive_errors of each other direction. partial[piece][tile][TILE_ROWS][VEC].
// multi_prediction_update: global (tiles + 1). loss_sums[m] is of the direction in which m is absent.
// Compile-time: mrbm_shape.clh, TILE_ROWS (divides 16), PIECE_ROWS, OPTIMIZER.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 TILE_ROWS=4,8,16 PIECE_ROWS=256 SAMPLE= BINARY=
//   MODALITIES=2,3 VISIBLE=,1,97 LARGEST=97 HIDDEN=1,97 STEPS=1,10
//   OPTIMIZER=none,momentum,adam

#include "units.clh"
#include "mrbm_shape.clh"
#include "weight_tile.clh"

#ifndef PIECE_ROWS
#define PIECE_ROWS 1024
#endif

#define PIECES(rows) (((rows) + PIECE_ROWS - 1) / PIECE_ROWS)
#define TILES(units) (PADDED(units) / TILE_ROWS * (H_LD / VEC))

INLINE int all_tiles(global const int* layout) {
  int tiles = 0;
  for (int m = 0; m < MODALITIES; ++m) tiles += TILES(UNITS(m));
  return tiles;
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
  clear_sums(sum);
  for (int i = 0; i < rows; ++i) add_outer(sum, x + i * x_ld, loadN(i * H_LD, y));
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) storeN(sum[r], r * VEC, partial);
}

kernel void multi_prediction_products(global const int* layout, int stride,
                                      global const float* codes, global const float* values,
                                      global const float* value_errors,
                                      global const float* hidden,
                                      global const float* hidden_errors,
                                      global const float* drive_errors, global float* partial) {
  const int tiles = all_tiles(layout);
  int tile = get_global_id(0);
  if (tile >= tiles) return;
  partial += (get_global_id(1) * tiles + tile) * TILE_ROWS * VEC;
  int m = 0;
  for (; tile >= TILES(UNITS(m)); ++m) tile -= TILES(UNITS(m));
  const int ld = PADDED(UNITS(m));
  const int row0 = TILE_ROW(tile), column = TILE_COLUMN(tile);
  const int block = stride * H_LD, direction = m * STEPS * block;

  int piece = get_global_id(1), rows = STEPS * stride;
  global const float* x = value_errors + rows * UNITS_BEFORE(m);
  global const float* y = hidden + direction;
  if (piece >= PIECES(rows)) {
    piece -= PIECES(rows);
    x = values + rows * UNITS_BEFORE(m);
    y = hidden_errors + direction + block;
    rows -= stride;
    if (piece >= PIECES(rows)) {
      piece -= PIECES(rows);
      rows = stride;
      const int i = piece / PIECES(rows);
      piece %= PIECES(rows);
      x = codes + stride * UNITS_BEFORE(m);
      y = drive_errors + (i < m ? i : i + 1) * block;
    }
  }
  const int first = piece * PIECE_ROWS;
  piece_product(min(PIECE_ROWS, rows - first), x + first * ld + row0, ld, y + first * H_LD + column,
                partial);
}

INLINE void update_w(int tile, int tiles, const int units, int pieces, global const float* partial,
                     int w_at, global float* wt, global float* parameters, global float* gradients,
                     global float* states, int size, float8 rule) {
  floatN sum[TILE_ROWS];
  clear_sums(sum);
  for (int piece = 0; piece < pieces; ++piece) {
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) sum[r] += loadN(r * VEC, partial);
    partial += tiles * TILE_ROWS * VEC;
  }
  update_weights(tile, sum, 1.0f, units, PADDED(units), w_at, wt, parameters, gradients, states, size,
                 rule);
}

kernel void multi_prediction_update(
    global const int* layout, int rows, int stride, int pieces, global const float* partial,
    global const float* value_errors, global const float* drive_errors, global float* parameters,
    global float* transposed, global float* gradients, global float* states, int size, float8 rule,
    global const float* loss, global float* loss_sums) {
  const int tiles = all_tiles(layout);
  int tile = get_global_id(0);
  partial += tile * TILE_ROWS * VEC;
  for (int m = 0; m < MODALITIES; ++m) {
    if (tile < TILES(UNITS(m))) {
      update_w(tile, tiles, UNITS(m), pieces, partial, W_AT(m), transposed + WT_AT(m), parameters,
               gradients, states, size, rule);
      return;
    }
    tile -= TILES(UNITS(m));
  }
  const float8 bias_rule = without_decay(rule);
  int column = tile * VEC;
  for (int m = 0; m < MODALITIES; ++m) {
    const int ld = PADDED(UNITS(m));
    if (column < ld) {
      const floatN gradient = column_sum(
          value_errors + STEPS * stride * UNITS_BEFORE(m) + column, STEPS * stride, ld);
      update(parameters, gradients, states, size, A_AT(m) + column, gradient, bias_rule);
      return;
    }
    column -= ld;
  }
  if (column < H_LD) {
    const floatN gradient = column_sum(drive_errors + column, MODALITIES * stride, H_LD);
    update(parameters, gradients, states, size, B_AT + column, gradient, bias_rule);
    return;
  }
  if (column != H_LD) return;
  for (int m = 0; m < MODALITIES; ++m) {
    float sum = 0.0f;
    for (int i = 0; i < rows; ++i) sum += loss[m * stride + i];
    loss_sums[m] += sum / (float)(rows * UNITS(m));
  }
}
