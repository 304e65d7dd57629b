// Every gradient of CD-k (eq 37 to 41) and what the optimizer makes of it (optimizer.clh), in one launch
// over the outputs of contrastive_divergence.cl. Work-item t computes one TILE_ROWS x VEC tile of one
// parameter, accumulated in registers over the mini-batch, and updates it in place; of W it writes the
// transposed copy too. Tiles of W come first, then those of A, B, a and b; the last work-item adds up
// the losses.
//
// global: (tiles + 1). Compile-time: crbm_shape.clh, TILE_ROWS (divides 16), OPTIMIZER.
// parameters_at: the first floats of W, A, B, a and b. The optimizer descends, so its gradient
// is the chain's end less the data.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 TILE_ROWS=4,8,16 GAUSSIAN= SAMPLE=
//   VISIBLE=1,97 HIDDEN=1,97 ORDER_A=0,1,5 ORDER_B=0,5 OPTIMIZER=none,momentum,adam,momentum_l1,adam_l1

#include "units.clh"
#include "crbm_shape.clh"
#include "weight_tile.clh"

// W: ⟨v hᵀ⟩ of the data less that of the chain's end (eq 37)
INLINE void update_w(int tile, int rows, float mean, global const float* visible_data,
                     global const float* visible, global const float* hidden_data,
                     global const float* hidden, int at, global float* parameters,
                     global float* gradients, global float* states, int size,
                     global float* w_transposed, float8 rule) {
  const int row0 = TILE_ROW(tile), column = TILE_COLUMN(tile);
  floatN sum[TILE_ROWS];
  clear_sums(sum);
  for (int i = 0; i < rows; ++i) {
    add_outer(sum, visible_data + i * V_LD + row0, loadN(i * H_LD + column, hidden_data));
    add_outer(sum, visible + i * V_LD + row0, -loadN(i * H_LD + column, hidden));
  }
  update_weights(tile, sum, -mean, VISIBLE, V_LD, at, w_transposed, parameters, gradients, states, size,
                 rule);
}

// A or B: ⟨history · change⟩ (eq 38 to 41); `ld` is V_LD for A, H_LD for B, `order` the frames it sees
INLINE void update_directed(int tile, const int order, const int ld, int rows, float mean,
                            global const float* frames, global const int* index, int shift,
                            global const float* change, int at, global float* parameters,
                            global float* gradients, global float* states, int size, float8 rule) {
  const int row0 = tile / (ld / VEC) * TILE_ROWS;
  const int column = tile % (ld / VEC) * VEC;
  frames += (shift - order) * V_LD + row0;
  floatN sum[TILE_ROWS];
  clear_sums(sum);
  for (int i = 0; i < rows; ++i)
    add_outer(sum, frames + index[i] * V_LD, loadN(i * ld + column, change));
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r)
    update(parameters, gradients, states, size, at + (row0 + r) * ld + column, -mean * sum[r], rule);
}

INLINE void update_bias(int column, const int ld, int rows, float mean, global const float* change,
                        int at, global float* parameters, global float* gradients,
                        global float* states, int size, float8 rule) {
  floatN sum = (floatN)(0.0f);
  for (int i = 0; i < rows; ++i) sum += loadN(i * ld + column, change);
  update(parameters, gradients, states, size, at + column, -mean * sum, rule);
}

kernel void cd_update(
    global const float* frames, global const int* index, int first, int shift, int rows,
    global const float* visible_data, global const float* visible,
    global const float* visible_change, global const float* hidden_data,
    global const float* hidden, global const float* hidden_change, int8 parameters_at,
    global float* parameters, global float* w_transposed, global float* gradients,
    global float* states, int size, float8 rule_w, float8 rule_a, float8 rule_b,
    global const float* loss, global float* loss_sum, float loss_scale) {
  const float mean = 1.0f / (float)rows;
  const float8 rule_bias = without_decay(rule_w);
  const int frame_tiles = V_LD / TILE_ROWS;
  index += first;
  int tile = get_global_id(0);
  if (tile < frame_tiles * (H_LD / VEC)) {
    update_w(tile, rows, mean, visible_data, visible, hidden_data, hidden, parameters_at.s0, parameters,
             gradients, states, size, w_transposed, rule_w);
    return;
  }
  tile -= frame_tiles * (H_LD / VEC);
  if (tile < ORDER_A * frame_tiles * (V_LD / VEC)) {
    update_directed(tile, ORDER_A, V_LD, rows, mean, frames, index, shift, visible_change, parameters_at.s1, parameters,
                    gradients, states, size, rule_a);
    return;
  }
  tile -= ORDER_A * frame_tiles * (V_LD / VEC);
  if (tile < ORDER_B * frame_tiles * (H_LD / VEC)) {
    update_directed(tile, ORDER_B, H_LD, rows, mean, frames, index, shift, hidden_change, parameters_at.s2, parameters,
                    gradients, states, size, rule_b);
    return;
  }
  tile -= ORDER_B * frame_tiles * (H_LD / VEC);
  if (tile < V_LD / VEC) {
    update_bias(tile * VEC, V_LD, rows, mean, visible_change, parameters_at.s3, parameters, gradients, states,
                size, rule_bias);
    return;
  }
  tile -= V_LD / VEC;
  if (tile < H_LD / VEC) {
    update_bias(tile * VEC, H_LD, rows, mean, hidden_change, parameters_at.s4, parameters, gradients, states,
                size, rule_bias);
    return;
  }
  if (tile > H_LD / VEC) return;
  float sum = 0.0f;
  for (int i = 0; i < rows; ++i) sum += loss[i];
  *loss_sum += loss_scale * sum;
}
