// Every gradient of the joint likelihood by contrastive divergence and what the optimizer makes of it
// (optimizer.clh), in one launch over the outputs of joint_likelihood.cl, whose names and stacks are used
// here. A work-group adds up one panel of a W (weight_tile.clh) and updates it in place, with the
// transposed copy. Before the panels come groups each work-item of which takes a vector of an a or of b,
// the next one adds up the losses.
//
// global: (groups · GROUP), local: (GROUP). Compile-time: mrbm_shape.clh, OPTIMIZER, tile.clh's ROWS
// (divides 16), COLUMNS and GROUP, PANEL_TILES. `gradients` is needed where `rows` are more than CHUNK,
// too, for sums that are not complete.
// The optimizer descends, so its gradient is the chain's end less the data.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 ROWS=4,8,16 PANEL_TILES=1,3 CHUNK=128 SAMPLE= STEPS= BINARY=
//   VEC=1,16 GROUP=1,64,256 ROWS=4,8 COLUMNS=1,2,3,4
//   MODALITIES=2,3 VISIBLE=,1,97 LARGEST=97 HIDDEN=1,97 OPTIMIZER=none,momentum,adam
//   VEC=1,4 UNROLL=16

#include "mrbm_shape.clh"
#include "weight_tile.clh"

// Σ (end − data) over the mini-batch
INLINE floatN sum_of_changes(global const float* data, global const float* end, int rows,
                             const int ld) {
  floatN sum = (floatN)(0.0f);
  UNROLLED
  for (int i = 0; i < rows; ++i) sum = add_in_order(sum, loadN(i * ld, end) - loadN(i * ld, data));
  return sum;
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void joint_likelihood_update(
    global const int* layout, int rows, int stride, global const float* codes,
    global const float* visible, global const float* hidden_data, global const float* hidden,
    global float* parameters, global float* transposed, global float* gradients,
    global float* states, int size, float8 rule, global const float* loss,
    global float* loss_sums) {
  local float x[PANEL_FLOATS], x_end[PANEL_FLOATS];
  const float mean = 1.0f / (float)rows;
  const float8 bias_rule = without_decay(rule);
  int column = get_global_id(0) * VEC;
  for (int m = 0; m < MODALITIES; ++m) {
    const int ld = PADDED(UNITS(m));
    if (column < ld) {
      const int first = stride * UNITS_BEFORE(m) + column;
      const floatN sum = sum_of_changes(codes + first, visible + first, rows, ld);
      update(parameters, gradients, states, size, A_AT(m) + column, mean * sum, bias_rule);
      return;
    }
    column -= ld;
  }
  if (column < H_LD) {
    const floatN sum = sum_of_changes(hidden_data + column, hidden + column, rows, H_LD);
    update(parameters, gradients, states, size, B_AT + column, mean * sum, bias_rule);
    return;
  }
  if (column == H_LD) {
    for (int m = 0; m < MODALITIES; ++m) {
      float sum = 0.0f;
      UNROLLED
      for (int i = 0; i < rows; ++i) sum += loss[m * stride + i];
      loss_sums[m] += sum / (float)(rows * UNITS(m));
    }
  }
  int vectors = H_LD / VEC;
  for (int m = 0; m < MODALITIES; ++m) vectors += PADDED(UNITS(m)) / VEC;
  int panel = (int)get_group_id(0) - (vectors + GROUP) / GROUP;
  if (panel < 0) return;
  for (int m = 0; m < MODALITIES; ++m) {
    const int ld = PADDED(UNITS(m));
    if (panel < PANELS(ld)) {
      const int row0 = panel * PANEL_ROWS, tiles = TILES_IN(panel, ld);
      const int at = W_AT(m) + row0 * H_LD;
      global const float* data = codes + stride * UNITS_BEFORE(m) + row0;
      global const float* end = visible + stride * UNITS_BEFORE(m) + row0;
      ADD_UP_PANEL(
          rows, tiles, H_LD, gradients + at, UNITS(m) - row0, false,
          {
            pack_row(x, i, tiles, data + (first + i) * ld);
            pack_row(x_end, i, tiles, end + (first + i) * ld);
          },
          {
            add_outer(sum, count, x_end + x_at, hidden + (first + i) * H_LD + column, 1.0f);
            add_outer(sum, count, x + x_at, hidden_data + (first + i) * H_LD + column, -1.0f);
          },
          {
            const int row = t * ROWS;
            const int present = UNITS(m) - row0 - row;
            update_tile(sum, count, mean, present, H_LD, at + row * H_LD, column, parameters, gradients,
                        states, size, rule);
            store_transposed(sum, count, transposed + WT_AT(m), ld, row0 + row, present, column, HIDDEN);
          });
      return;
    }
    panel -= PANELS(ld);
  }
}
