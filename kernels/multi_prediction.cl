// Multi-prediction of the MRBM (eq 42) in launches of three kernels: multi_prediction runs the unrolled
// mean field (eq 32, 33) and its back-propagation for a block of rows, multi_prediction_update.cl makes
// every gradient and applies it. A long mini-batch is taken in parts of `rows` of its `batch` rows, from
// `first` on, so that what a part leaves for its gradients stays in cache.
//
// global: (blocks · GROUP, MODALITIES), local: (GROUP, 1). Group (i, d) carries rows i · ROWS … through
// the direction in which modality d is absent and the others are present. Compile-time: mrbm_shape.clh,
// which has `layout` too, and tile.clh's ROWS, COLUMNS, GROUP.
// Stacks are made of blocks of `stride` rows, block t after block t − 1, for one modality after
// another; rows past `rows` have errors of zero. Of a modality: codes [1 block], the mini-batch; values
// and value_errors [STEPS blocks]. Of direction d: hidden, hidden_errors [STEPS blocks at d · STEPS],
// present_input, present_input_errors [1 block at d], loss[d · batch + first + row] =
// −log p(target | prediction) of the row but for a constant: Σ cross-entropy, or of Gaussian units half the
// squared errors.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 STEPS=1,10 GROUP=1,64 SAMPLE=
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8
//   MODALITIES=2,3 VISIBLE=,1,97 LARGEST=97 HIDDEN=1,97 BINARY=0,1
//   VEC=1,4 UNROLL=16

#include "mean_field.clh"

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

// ½ Σ (t − y)² of one row; padding is zero in both.
INLINE float row_half_squares(global const float* target, local const float* prediction,
                              const int ld) {
  floatN sum = (floatN)(0.0f);
  for (int column = 0; column < ld; column += VEC) {
    const floatN error = loadN(column, target) - loadN(column, prediction);
    sum = fma(0.5f * error, error, sum);
  }
  return sum_lanes(sum);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void multi_prediction(
    global const int* layout, int rows, int stride, int first, int batch,
    global const float* parameters, global const float* transposed, global const float* codes,
    global float* values, global float* value_errors, global float* hidden,
    global float* hidden_errors, global float* present_input, global float* present_input_errors,
    global float* loss) {
  local float x[ROWS * X_LD];
  local float h[ROWS * H_LD];
  const int row0 = get_group_id(0) * ROWS;
  // q is the absent modality. No branch around barriers: with one, groups of more than one work-item
  // gave wrong results on PoCL 3.1 (the cause was not isolated).
  const int q = get_group_id(1);
  const int Q = UNITS(q), Q_LD = PADDED(Q), gaussian = IS_GAUSSIAN(q);
  global const float* w_q = parameters + W_AT(q);
  global const float* wt_q = transposed + WT_AT(q);
  global const float* a_q = parameters + A_AT(q);
  global const float* target = codes + stride * UNITS_BEFORE(q) + row0 * Q_LD;
  values += STEPS * stride * UNITS_BEFORE(q) + row0 * Q_LD;
  value_errors += STEPS * stride * UNITS_BEFORE(q) + row0 * Q_LD;
  hidden += (q * STEPS * stride + row0) * H_LD;
  hidden_errors += (q * STEPS * stride + row0) * H_LD;
  present_input += (q * stride + row0) * H_LD;
  present_input_errors += (q * stride + row0) * H_LD;
  loss += q * batch + first + row0;

  const int value_block = stride * Q_LD, hidden_block = stride * H_LD;
  const int present_rows = min(ROWS, rows - row0);
  floatN sum[ROWS][COLUMNS];

  // Forward. What the present modalities give the shared units does not change (eq 32); the absent one
  // starts from zeros, so that the first pass is that alone.
  for (int i = 0; i < MODALITIES - 1; ++i) {
    const int p = i < q ? i : i + 1;
    const int P = UNITS(p), P_LD = PADDED(P);
    global const float* w_p = parameters + W_AT(p);
    global const float* code = codes + stride * UNITS_BEFORE(p) + row0 * P_LD;
    for (int r = 0; r < ROWS; ++r)
      for (int column = get_local_id(0) * VEC; column < P_LD; column += GROUP * VEC)
        storeN(loadN(min(r, present_rows - 1) * P_LD + column, code), r * X_LD + column, x);
    SYNC();
    global const float* before = i == 0 ? parameters + B_AT : present_input;
    const int before_ld = i == 0 ? 0 : H_LD;
    ADD_PRESENT_INPUT(P, w_p, before, before_ld);
    SYNC();
  }
  for (int t = 0; t < STEPS; ++t) {
    SHARED_UNITS(t > 0 ? Q : 0, w_q, present_input,
                 { store_tile(sum, count, hidden + t * hidden_block, H_LD, column); });
    SYNC();
    ABSENT_UNITS(Q, wt_q, a_q, gaussian, {
      store_tile(sum, count, values + t * value_block, Q_LD, column);
      keep_tile(sum, count, x, X_LD, column);
    });
    SYNC();
  }

  // The error before the units' activation is prediction − target, of either kind.
  const float mean = 1.0f / (float)batch;
  for (int r = get_local_id(0); r < ROWS && row0 + r < rows; r += GROUP)
    loss[r] = gaussian ? row_half_squares(target + r * Q_LD, x + r * X_LD, Q_LD)
                       : row_cross_entropy(target + r * Q_LD, x + r * X_LD, Q, Q_LD);
  SYNC();
  for (int r = 0; r < ROWS; ++r)
    for (int column = get_local_id(0) * VEC; column < Q_LD; column += GROUP * VEC) {
      const floatN value = loadN(r * X_LD + column, x);
      const floatN error =
          (row0 + r < rows ? mean : 0.0f) * (value - loadN(min(r, present_rows - 1) * Q_LD + column, target));
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
      if (t < STEPS - 1) add_tile(sum, count, present_input_errors, H_LD, column);
      store_tile(sum, count, present_input_errors, H_LD, column);
    });
    SYNC();
    if (t == 0) break;
    FOR_TILES(Q_LD, {
      clear_tile(sum, count);
      add_products(sum, count, h, H_LD, HIDDEN, wt_q, Q_LD, column);
      if (!gaussian) through_sigmoid(sum, count, values + (t - 1) * value_block, Q_LD, column);
      store_tile(sum, count, value_errors + (t - 1) * value_block, Q_LD, column);
      keep_tile(sum, count, x, X_LD, column);
    });
    SYNC();
  }
}
