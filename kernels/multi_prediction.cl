// Multi-prediction of the MRBM (eq 42) in three launches: multi_prediction runs the unrolled mean
// field (eq 32, 33) and its back-propagation for a block of rows, multi_prediction_update.cl makes
// every gradient and applies it.
//
// global: (blocks · GROUP, 2), local: (GROUP, 1). Group (i, d) carries rows i · ROWS … through the
// direction in which modality d is absent. Compile-time: VISIBLE_0, VISIBLE_1, HIDDEN (units of the
// modalities and shared), STEPS of mean field, ROWS, COLUMNS, GROUP (tile.clh).
// Outputs are stacks of blocks of `stride` rows, block t after block t − 1; rows past `rows` have
// errors of zero. Of modality d: codes_d [1 block], values_d and value_errors_d [STEPS blocks]. Of
// direction d: hidden, hidden_errors [STEPS blocks at d · STEPS], drive, drive_errors [1 block at d],
// loss[d · stride + row] = Σ cross-entropy of the row.

#include "tile.clh"
#include "mrbm_shape.clh"

#define X_LD (PADDED(VISIBLE_0) > PADDED(VISIBLE_1) ? PADDED(VISIBLE_0) : PADDED(VISIBLE_1))

// sum ∘= y · (1 − y), the derivative of the sigmoid whose value is y
INLINE void through_sigmoid(floatN sum[ROWS][COLUMNS], const int count, global const float* y,
                            const int ld, int column) {
#pragma unroll
  for (int r = 0; r < ROWS; ++r)
#pragma unroll
    for (int c = 0; c < count; ++c) {
      const floatN value = loadN(r * ld + column + c * VEC, y);
      sum[r][c] *= value * (1.0f - value);
    }
}

// − Σ t · log y + (1 − t) · log(1 − y) of one row, y kept away from 0 and 1; a NaN stays one.
INLINE float row_cross_entropy(global const float* target, local const float* prediction,
                               const int units, const int ld) {
  floatN sum = (floatN)(0.0f);
  for (int column = 0; column < ld; column += VEC) {
    const floatN t = loadN(column, target);
    floatN y = loadN(column, prediction);
    y = y < (floatN)(1e-7f) ? (floatN)(1e-7f) : y;
    y = y > (floatN)(1.0f - 1e-7f) ? (floatN)(1.0f - 1e-7f) : y;
    sum -= column_mask(column, units) * (t * log(y) + (1.0f - t) * log(1.0f - y));
  }
  return sum_lanes(sum);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void multi_prediction(
    global const float* frames_0, global const int* index_0, int first_0, int shift_0,
    global const float* frames_1, global const int* index_1, int first_1, int shift_1, int rows,
    int stride, global const float* w_0, global const float* wt_0, global const float* a_0,
    global const float* w_1, global const float* wt_1, global const float* a_1,
    global const float* b, global float* codes_0, global float* values_0,
    global float* value_errors_0, global float* codes_1, global float* values_1,
    global float* value_errors_1, global float* hidden, global float* hidden_errors,
    global float* drive, global float* drive_errors, global float* loss) {
  local float x[ROWS * X_LD];
  local float h[ROWS * H_LD];
  const int row0 = get_group_id(0) * ROWS;
  // q is the absent modality, p the present one. No branch around barriers: with one, groups of
  // more than one work-item gave wrong results on PoCL 3.1 (the cause was not isolated). Sizes that
  // are the same, as they usually are, still fold into constants.
  const bool q_is_0 = get_group_id(1) == 0;
#define EITHER(of_0, of_1) (q_is_0 ? (of_0) : (of_1))
  const int Q = EITHER(VISIBLE_0, VISIBLE_1), P = EITHER(VISIBLE_1, VISIBLE_0);
  const int Q_LD = PADDED(Q), P_LD = PADDED(P);
  global const float* frames_q = EITHER(frames_0, frames_1);
  global const float* frames_p = EITHER(frames_1, frames_0);
  global const int* index_q = EITHER(index_0 + first_0, index_1 + first_1);
  global const int* index_p = EITHER(index_1 + first_1, index_0 + first_0);
  const int shift_q = EITHER(shift_0, shift_1), shift_p = EITHER(shift_1, shift_0);
  global const float* w_q = EITHER(w_0, w_1);
  global const float* w_p = EITHER(w_1, w_0);
  global const float* wt_q = EITHER(wt_0, wt_1);
  global const float* a_q = EITHER(a_0, a_1);
  global float* codes_p = EITHER(codes_1, codes_0) + row0 * P_LD;
  global float* values = EITHER(values_0, values_1) + row0 * Q_LD;
  global float* value_errors = EITHER(value_errors_0, value_errors_1) + row0 * Q_LD;
  const int direction = get_group_id(1);
  hidden += (direction * STEPS * stride + row0) * H_LD;
  hidden_errors += (direction * STEPS * stride + row0) * H_LD;
  drive += (direction * stride + row0) * H_LD;
  drive_errors += (direction * stride + row0) * H_LD;
  loss += direction * stride + row0;

  const int value_block = stride * Q_LD, hidden_block = stride * H_LD;
  floatN sum[ROWS][COLUMNS];
  int target[ROWS];
  for (int r = 0; r < ROWS; ++r) {
    const int row = min(row0 + r, rows - 1);
    target[r] = (index_q[row] + shift_q) * Q_LD;
    for (int column = get_local_id(0) * VEC; column < P_LD; column += GROUP * VEC) {
      const floatN code = loadN((index_p[row] + shift_p) * P_LD + column, frames_p);
      storeN(code, r * P_LD + column, codes_p);
      storeN(code, r * X_LD + column, x);
    }
  }
  SYNC();

  // Forward; the absent modality starts from zeros, so that the first pass is the drive alone.
  FOR_TILES(H_LD, {
    load_tile(sum, count, b, 0, column);
    add_products(sum, count, x, X_LD, P, w_p, H_LD, column);
    store_tile(sum, count, drive, H_LD, column);
  });
  for (int t = 0; t < STEPS; ++t) {
    FOR_TILES(H_LD, {
      load_tile(sum, count, drive, H_LD, column);
      if (t > 0) add_products(sum, count, x, X_LD, Q, w_q, H_LD, column);
      apply_sigmoid(sum, count, column, HIDDEN);
      store_tile(sum, count, hidden + t * hidden_block, H_LD, column);
      keep_tile(sum, count, h, H_LD, column);
    });
    SYNC();
    FOR_TILES(Q_LD, {
      load_tile(sum, count, a_q, 0, column);
      add_products(sum, count, h, H_LD, HIDDEN, wt_q, Q_LD, column);
      apply_sigmoid(sum, count, column, Q);
      store_tile(sum, count, values + t * value_block, Q_LD, column);
      keep_tile(sum, count, x, X_LD, column);
    });
    SYNC();
  }

  // The cross-entropy's error before the sigmoid is prediction − target.
  const float mean = 1.0f / (float)rows;
  for (int r = get_local_id(0); r < ROWS && row0 + r < rows; r += GROUP)
    loss[r] = row_cross_entropy(frames_q + target[r], x + r * X_LD, Q, Q_LD);
  SYNC();
  for (int r = 0; r < ROWS; ++r)
    for (int column = get_local_id(0) * VEC; column < Q_LD; column += GROUP * VEC) {
      const floatN value = loadN(r * X_LD + column, x);
      const floatN error =
          (row0 + r < rows ? mean : 0.0f) * (value - loadN(target[r] + column, frames_q));
      storeN(error, (STEPS - 1) * value_block + r * Q_LD + column, value_errors);
      storeN(error, r * X_LD + column, x);
    }
  SYNC();

  for (int t = STEPS - 1; t >= 0; --t) {
    FOR_TILES(H_LD, {
      clear_tile(sum, count);
      add_products(sum, count, x, X_LD, Q, w_q, H_LD, column);
      through_sigmoid(sum, count, hidden + t * hidden_block, H_LD, column);
      store_tile(sum, count, hidden_errors + t * hidden_block, H_LD, column);
      keep_tile(sum, count, h, H_LD, column);
      if (t < STEPS - 1) add_tile(sum, count, drive_errors, H_LD, column);
      store_tile(sum, count, drive_errors, H_LD, column);
    });
    SYNC();
    if (t == 0) break;
    FOR_TILES(Q_LD, {
      clear_tile(sum, count);
      add_products(sum, count, h, H_LD, HIDDEN, wt_q, Q_LD, column);
      through_sigmoid(sum, count, values + (t - 1) * value_block, Q_LD, column);
      store_tile(sum, count, value_errors + (t - 1) * value_block, Q_LD, column);
      keep_tile(sum, count, x, X_LD, column);
    });
    SYNC();
  }
}
