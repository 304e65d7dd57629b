// Every gradient of multi-prediction (eq 42) and what the optimizer makes of it (optimizer.clh), over
// the outputs of multi_prediction.cl, whose names and stacks are used here. Two kernels: the stacks are
// long (STEPS times a part of the mini-batch) and wide, so multi_prediction_products adds up the panels of
// every W (weight_tile.clh) over pieces of a part's stacks, and after the last part
// multi_prediction_update adds up the pieces, in order, and updates tiles of ROWS x VEC. Those of the
// first modality's W come first; in the update those of every a and of b follow, and the last work-item
// adds up the losses.
//
// multi_prediction_products: global (panels · GROUP, pieces + 1), local (GROUP, 1). The pieces of
//   PIECE_STEPS steps count through the products of a W: value_errorsᵀ·hidden, valuesᵀ·hidden_errors of
//   the step after, and codesᵀ·present_input_errors of each other direction. partial[piece] is
//   [partial_rows x H_LD], the rows of every W one after another, padded; behind the pieces stand the
//   gradients of every a and of b, padded, which the last row of groups adds up. Where it `resumes`, all go
//   on from the part before. Pieces are whole steps: their sums are the same whatever the blocks of rows.
// multi_prediction_update: global (tiles + 1). loss_sums[m] is of the direction in which m is absent.
// Compile-time: mrbm_shape.clh, PIECE_STEPS, OPTIMIZER, tile.clh's ROWS (divides 16), COLUMNS and GROUP,
// PANEL_TILES.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 ROWS=4,8,16 PANEL_TILES=1,3 CHUNK=128 PIECE_STEPS=1,4 SAMPLE= BINARY=
//   VEC=1,16 GROUP=1,64,256 ROWS=4,8 COLUMNS=1,2,3,4
//   MODALITIES=2,3 VISIBLE=,1,97 LARGEST=97 HIDDEN=1,97 STEPS=1,10
//   OPTIMIZER=none,momentum,adam
//   VEC=1,4 UNROLL=16

#include "mrbm_shape.clh"
#include "weight_tile.clh"

#ifndef PIECE_STEPS
#define PIECE_STEPS 4
#endif

#define PIECES(steps) (((steps) + PIECE_STEPS - 1) / PIECE_STEPS)

INLINE void add_column_sum(global float* sums, global const float* x, int rows, const int ld,
                           bool resumes) {
  floatN sum = resumes ? loadN(0, sums) : (floatN)(0.0f);
  UNROLLED
  for (int i = 0; i < rows; ++i) sum = add_in_order(sum, loadN(i * ld, x));
  storeN(sum, 0, sums);
}

// The gradients of every a and of b, a vector at a time.
INLINE void add_up_biases(global const int* layout, int stride, bool resumes,
                          global const float* value_errors, global const float* present_input_errors,
                          global float* sums) {
  for (int vector = get_global_id(0);; vector += get_global_size(0)) {
    int column = vector * VEC, m = 0;
    for (; m < MODALITIES && column >= PADDED(UNITS(m)); ++m) column -= PADDED(UNITS(m));
    if (m == MODALITIES && column >= H_LD) return;
    global const float* errors = m < MODALITIES
                                     ? value_errors + STEPS * stride * UNITS_BEFORE(m) + column
                                     : present_input_errors + column;
    add_column_sum(sums + vector * VEC, errors, (m < MODALITIES ? STEPS : MODALITIES) * stride,
                   m < MODALITIES ? PADDED(UNITS(m)) : H_LD, resumes);
  }
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void multi_prediction_products(
    global const int* layout, int stride, int resumes, global const float* codes,
    global const float* values, global const float* value_errors, global const float* hidden,
    global const float* hidden_errors, global const float* present_input_errors, global float* partial,
    int partial_rows) {
  local float packed[PANEL_FLOATS];
  // The long pieces last: who takes groups in order, half of what is left at a time, as PoCL's threads
  // do, would else give one thread all of them.
  const int pieces = get_num_groups(1) - 1;
  int piece = pieces - (int)get_group_id(1), steps = STEPS;
  if (piece == pieces) {
    add_up_biases(layout, stride, resumes, value_errors, present_input_errors,
                  partial + pieces * partial_rows * H_LD);
    return;
  }
  int panel = get_group_id(0), m = 0;
  for (; panel >= PANELS(PADDED(UNITS(m))); ++m) panel -= PANELS(PADDED(UNITS(m)));
  const int ld = PADDED(UNITS(m));
  const int row0 = panel * PANEL_ROWS, tiles = TILES_IN(panel, ld);
  const int block = stride * H_LD, direction = m * STEPS * block;

  partial += (piece * partial_rows + UNITS_BEFORE(m) + row0) * H_LD;
  global const float* x = value_errors + STEPS * stride * UNITS_BEFORE(m);
  global const float* y = hidden + direction;
  if (piece >= PIECES(steps)) {
    piece -= PIECES(steps);
    x = values + STEPS * stride * UNITS_BEFORE(m);
    y = hidden_errors + direction + block;
    steps -= 1;
    if (piece >= PIECES(steps)) {
      piece -= PIECES(steps);
      const int i = piece;
      piece = 0;
      steps = 1;
      x = codes + stride * UNITS_BEFORE(m);
      y = present_input_errors + (i < m ? i : i + 1) * block;
    }
  }
  const int from = piece * PIECE_STEPS * stride;
  x += from * ld + row0;
  y += from * H_LD;
  const int rows = min(PIECE_STEPS, steps - piece * PIECE_STEPS) * stride;
  ADD_UP_PANEL(
      rows, tiles, H_LD, partial, PANEL_ROWS, resumes,
      { pack_row(packed, i, tiles, x + (first + i) * ld); },
      { add_outer(sum, count, packed + x_at, y + (first + i) * H_LD + column, 1.0f); },
      { store_tile(sum, count, waiting, H_LD, column); });
}

// One tile of W, a vector wide.
INLINE void update_w(int tile, int partial_rows, const int units, int pieces,
                     global const float* partial, int w_at, global float* wt,
                     global float* parameters, global float* gradients, global float* states,
                     int size, float8 rule) {
  const int row0 = tile / (H_LD / VEC) * ROWS, column = tile % (H_LD / VEC) * VEC;
  floatN sum[ROWS][COLUMNS];
  clear_tile(sum, 1);
  UNROLLED
  for (int piece = 0; piece < pieces; ++piece)
    add_tile(sum, 1, partial + (piece * partial_rows + row0) * H_LD, H_LD, column);
  update_tile(sum, 1, 1.0f, units - row0, H_LD, w_at + row0 * H_LD, column, parameters, gradients,
              states, size, rule);
  store_transposed(sum, 1, wt, PADDED(units), row0, units - row0, column, HIDDEN);
}

kernel void multi_prediction_update(
    global const int* layout, int rows, int pieces, int partial_rows, global const float* partial,
    global float* parameters, global float* transposed, global float* gradients,
    global float* states, int size, float8 rule, global const float* loss,
    global float* loss_sums) {
  int tile = get_global_id(0);
  for (int m = 0; m < MODALITIES; ++m) {
    const int tiles = PADDED(UNITS(m)) / ROWS * (H_LD / VEC);
    if (tile < tiles) {
      update_w(tile, partial_rows, UNITS(m), pieces, partial + UNITS_BEFORE(m) * H_LD, W_AT(m),
               transposed + WT_AT(m), parameters, gradients, states, size, rule);
      return;
    }
    tile -= tiles;
  }
  const float8 bias_rule = without_decay(rule);
  global const float* sums = partial + pieces * partial_rows * H_LD + tile * VEC;
  int column = tile * VEC;
  for (int m = 0; m < MODALITIES; ++m) {
    const int ld = PADDED(UNITS(m));
    if (column < ld) {
      update(parameters, gradients, states, size, A_AT(m) + column, loadN(0, sums), bias_rule);
      return;
    }
    column -= ld;
  }
  if (column < H_LD) {
    update(parameters, gradients, states, size, B_AT + column, loadN(0, sums), bias_rule);
    return;
  }
  if (column != H_LD) return;
  for (int m = 0; m < MODALITIES; ++m) {
    float sum = 0.0f;
    UNROLLED
    for (int i = 0; i < rows; ++i) sum += loss[m * rows + i];
    loss_sums[m] += sum / (float)(rows * UNITS(m));
  }
}
