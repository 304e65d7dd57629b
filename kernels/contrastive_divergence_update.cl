// Every gradient of CD-k (eq 37 to 41) and what the optimizer makes of it (optimizer.clh), in one launch
// over the outputs of contrastive_divergence.cl. A work-group makes one panel of one parameter
// (weight_tile.clh) and updates it in place; of W it writes the transposed copy too. First come groups each
// work-item of which takes a vector of a or of b, the next one adds up the losses; then panels of W, A and
// B. The longest panels come last, so that work-groups finish at about the same time.
//
// global: (groups · GROUP), local: (GROUP). Compile-time: crbm_shape.clh, OPTIMIZER, tile.clh's ROWS
// (divides 16), COLUMNS and GROUP, PANEL_TILES. `gradients` is needed where `rows` are more than CHUNK,
// too, for sums that are not complete.
// parameters_at: the first floats of W, A, B, a and b. The optimizer descends, so its gradient
// is the chain's end less the data.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 ROWS=4,8,16 PANEL_TILES=1,3 CHUNK=128 GAUSSIAN= SAMPLE=
//   VEC=1,16 GROUP=1,64,256 ROWS=4,8 COLUMNS=1,2,3,4
//   VISIBLE=1,97 HIDDEN=1,97 ORDER_A=0,1,5 ORDER_B=0,5 OPTIMIZER=none,momentum,adam,momentum_l1,adam_l1
//   VEC=1,4 UNROLL=16

#include "crbm_shape.clh"
#include "weight_tile.clh"

// W: ⟨v hᵀ⟩ of the data less that of the chain's end (eq 37)
INLINE void update_w(local float* x, local float* x_end, int panel, int rows, float mean,
                     global const float* visible_data, global const float* visible,
                     global const float* hidden_data, global const float* hidden, int at,
                     global float* parameters, global float* gradients, global float* states,
                     int size, global float* w_transposed, float8 rule) {
  const int row0 = panel * PANEL_ROWS;
  const int tiles = TILES_IN(panel, V_LD);
  at += row0 * H_LD;
  ADD_UP_PANEL(
      rows, tiles, H_LD, gradients + at, VISIBLE - row0, false,
      {
        pack_row(x, i, tiles, visible_data + (first + i) * V_LD + row0);
        pack_row(x_end, i, tiles, visible + (first + i) * V_LD + row0);
      },
      {
        add_outer(sum, count, x + x_at, hidden_data + (first + i) * H_LD + column, 1.0f);
        add_outer(sum, count, x_end + x_at, hidden + (first + i) * H_LD + column, -1.0f);
      },
      {
        const int row = t * ROWS;
        const int present = VISIBLE - row0 - row;
        update_tile(sum, count, -mean, present, H_LD, at + row * H_LD, column, parameters, gradients,
                    states, size, rule);
        store_transposed(sum, count, w_transposed, V_LD, row0 + row, present, column, HIDDEN);
      });
}

// A or B: ⟨history · change⟩ (eq 38 and 39); `ld` is V_LD for A, H_LD for B, `order` the frames it sees
INLINE void update_directed(local float* x, int panel, const int order, const int ld, int rows,
                            float mean, global const float* frames, global const int* index,
                            int shift, global const float* change, int at, global float* parameters,
                            global float* gradients, global float* states, int size, float8 rule) {
  const int row0 = panel * PANEL_ROWS;
  const int tiles = TILES_IN(panel, order * V_LD);
  frames += (shift - order) * V_LD + row0;
  at += row0 * ld;
  ADD_UP_PANEL(
      rows, tiles, ld, gradients + at, PANEL_ROWS, false,
      { pack_row(x, i, tiles, frames + index[first + i] * V_LD); },
      { add_outer(sum, count, x + x_at, change + (first + i) * ld + column, 1.0f); },
      {
        update_tile(sum, count, -mean, ROWS, ld, at + t * ROWS * ld, column, parameters, gradients,
                    states, size, rule);
      });
}

INLINE void update_bias(int column, const int ld, int rows, float mean, global const float* change,
                        int at, global float* parameters, global float* gradients,
                        global float* states, int size, float8 rule) {
  floatN sum = (floatN)(0.0f);
  UNROLLED
  for (int i = 0; i < rows; ++i) sum = add_in_order(sum, loadN(i * ld + column, change));
  update(parameters, gradients, states, size, at + column, -mean * sum, rule);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void cd_update(
    global const float* frames, global const int* index, int first, int shift, int rows,
    global const float* visible_data, global const float* visible,
    global const float* visible_change, global const float* hidden_data,
    global const float* hidden, global const float* hidden_change, int8 parameters_at,
    global float* parameters, global float* w_transposed, global float* gradients,
    global float* states, int size, float8 rule_w, float8 rule_a, float8 rule_b,
    global const float* loss, global float* loss_sum, float loss_scale) {
  local float x[PANEL_FLOATS], x_end[PANEL_FLOATS];
  const float mean = 1.0f / (float)rows;
  index += first;
  int vector = get_global_id(0);
  if (vector < V_LD / VEC) {
    update_bias(vector * VEC, V_LD, rows, mean, visible_change, parameters_at.s3, parameters, gradients,
                states, size, without_decay(rule_w));
    return;
  }
  vector -= V_LD / VEC;
  if (vector < H_LD / VEC) {
    update_bias(vector * VEC, H_LD, rows, mean, hidden_change, parameters_at.s4, parameters, gradients,
                states, size, without_decay(rule_w));
    return;
  }
  if (vector == H_LD / VEC) {
    float sum = 0.0f;
    UNROLLED
    for (int i = 0; i < rows; ++i) sum += loss[i];
    *loss_sum += loss_scale * sum;
  }
  int panel = (int)get_group_id(0) - ((V_LD + H_LD) / VEC + GROUP) / GROUP;
  if (panel < 0) return;
  if (panel < PANELS(V_LD)) {
    update_w(x, x_end, panel, rows, mean, visible_data, visible, hidden_data, hidden, parameters_at.s0,
             parameters, gradients, states, size, w_transposed, rule_w);
    return;
  }
  panel -= PANELS(V_LD);
  if (panel < PANELS(ORDER_A * V_LD)) {
    update_directed(x, panel, ORDER_A, V_LD, rows, mean, frames, index, shift, visible_change,
                    parameters_at.s1, parameters, gradients, states, size, rule_a);
    return;
  }
  panel -= PANELS(ORDER_A * V_LD);
  update_directed(x, panel, ORDER_B, H_LD, rows, mean, frames, index, shift, hidden_change,
                  parameters_at.s2, parameters, gradients, states, size, rule_b);
}
