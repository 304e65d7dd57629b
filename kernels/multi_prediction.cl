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

// The direction in which one modality is absent, as one block of rows takes it
struct Direction {
  int absent, units, ld, gaussian;  // the absent modality, its units, their padded number and kind
  global const float *w, *w_transposed, *a;
  global const float* target;  // its codes
  int row0, present_rows, stride;
};

// Mean field. What the present modalities give the shared units does not change (eq 32); the absent one
// starts from zeros, so that the first pass is that alone. x ends as the prediction.
INLINE void forward(local float* x, local float* h, struct Direction direction,
                    global const int* layout, global const float* parameters,
                    global const float* codes, global float* values, global float* hidden,
                    global float* present_input) {
  const int ld = direction.ld;
  floatN sum[ROWS][COLUMNS];
  for (int i = 0; i < MODALITIES - 1; ++i) {
    const int present = i < direction.absent ? i : i + 1;
    const int present_units = UNITS(present), present_ld = PADDED(present_units);
    global const float* present_w = parameters + W_AT(present);
    global const float* code =
        codes + direction.stride * UNITS_BEFORE(present) + direction.row0 * present_ld;
    for (int r = 0; r < ROWS; ++r)
      for (int column = get_local_id(0) * VEC; column < present_ld; column += GROUP * VEC)
        storeN(loadN(min(r, direction.present_rows - 1) * present_ld + column, code), r * X_LD + column, x);
    SYNC();
    global const float* before = i == 0 ? parameters + B_AT : present_input;
    const int before_ld = i == 0 ? 0 : H_LD;
    ADD_PRESENT_INPUT(present_units, present_w, before, before_ld);
    SYNC();
  }
  for (int t = 0; t < STEPS; ++t) {
    global float* hidden_t = hidden + t * direction.stride * H_LD;
    global float* values_t = values + t * direction.stride * ld;
    SHARED_UNITS(t > 0 ? direction.units : 0, direction.w, present_input,
                 { store_tile(sum, count, hidden_t, H_LD, column); });
    SYNC();
    ABSENT_UNITS(direction.units, direction.w_transposed, direction.a, direction.gaussian, {
      store_tile(sum, count, values_t, ld, column);
      keep_tile(sum, count, x, X_LD, column);
    });
    SYNC();
  }
}

// The loss of each row, and x ← the error before the units' activation, divided by the mini-batch's rows. It is
// prediction − target for either kind of units. `errors` gets it, too.
INLINE void output_errors(local float* x, struct Direction direction, int batch,
                          global float* errors, global float* loss) {
  const int ld = direction.ld;
  const float mean = 1.0f / (float)batch;
  for (int r = get_local_id(0); r < direction.present_rows; r += GROUP)
    loss[r] = direction.gaussian
                  ? row_half_squares(direction.target + r * ld, x + r * X_LD, ld)
                  : row_cross_entropy(direction.target + r * ld, x + r * X_LD, direction.units, ld);
  SYNC();
  for (int r = 0; r < ROWS; ++r)
    for (int column = get_local_id(0) * VEC; column < ld; column += GROUP * VEC) {
      const floatN value = loadN(r * X_LD + column, x);
      const floatN target = loadN(min(r, direction.present_rows - 1) * ld + column, direction.target);
      const floatN error = (r < direction.present_rows ? mean : 0.0f) * (value - target);
      storeN(error, r * ld + column, errors);
      storeN(error, r * X_LD + column, x);
    }
  SYNC();
}

// Errors of every step's units, from those of the last step's values, which x has
INLINE void back_propagate(local float* x, local float* h, struct Direction direction,
                           global const float* values, global float* value_errors,
                           global const float* hidden, global float* hidden_errors,
                           global float* present_input_errors) {
  const int ld = direction.ld;
  const int value_block = direction.stride * ld, hidden_block = direction.stride * H_LD;
  floatN sum[ROWS][COLUMNS];
  for (int t = STEPS - 1; t >= 0; --t) {
    FOR_TILES(H_LD, {
      clear_tile(sum, count);
      add_products(sum, count, x, X_LD, direction.units, direction.w, H_LD, column);
      through_sigmoid(sum, count, hidden + t * hidden_block, H_LD, column);
      store_tile(sum, count, hidden_errors + t * hidden_block, H_LD, column);
      keep_tile(sum, count, h, H_LD, column);
      if (t < STEPS - 1) add_tile(sum, count, present_input_errors, H_LD, column);
      store_tile(sum, count, present_input_errors, H_LD, column);
    });
    SYNC();
    if (t == 0) break;
    FOR_TILES(ld, {
      clear_tile(sum, count);
      add_products(sum, count, h, H_LD, HIDDEN, direction.w_transposed, ld, column);
      if (!direction.gaussian)
        through_sigmoid(sum, count, values + (t - 1) * value_block, ld, column);
      store_tile(sum, count, value_errors + (t - 1) * value_block, ld, column);
      keep_tile(sum, count, x, X_LD, column);
    });
    SYNC();
  }
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
  // No branch around barriers: with one, groups of more than one work-item gave wrong results on PoCL 3.1
  // (the cause was not isolated).
  const int absent = get_group_id(1);
  const int units = UNITS(absent), ld = PADDED(units);
  const int block = stride * UNITS_BEFORE(absent), row = row0 * ld;
  const struct Direction direction = {absent,
                                      units,
                                      ld,
                                      IS_GAUSSIAN(absent),
                                      parameters + W_AT(absent),
                                      transposed + WT_AT(absent),
                                      parameters + A_AT(absent),
                                      codes + block + row,
                                      row0,
                                      min(ROWS, rows - row0),
                                      stride};
  values += STEPS * block + row;
  value_errors += STEPS * block + row;
  hidden += (absent * STEPS * stride + row0) * H_LD;
  hidden_errors += (absent * STEPS * stride + row0) * H_LD;
  present_input += (absent * stride + row0) * H_LD;
  present_input_errors += (absent * stride + row0) * H_LD;
  loss += absent * batch + first + row0;

  forward(x, h, direction, layout, parameters, codes, values, hidden, present_input);
  output_errors(x, direction, batch, value_errors + (STEPS - 1) * stride * ld, loss);
  back_propagate(x, h, direction, values, value_errors, hidden, hidden_errors, present_input_errors);
}
