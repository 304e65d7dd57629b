// Every gradient of CD-k (eq 37 to 41) and its momentum update, in one launch over the outputs of
// gibbs_chain.cl. Work-item t computes one TILE_ROWS x VEC tile of one parameter, accumulated in
// registers over the mini-batch, and updates it in place; of W it writes the transposed copy too.
// Tiles of W come first, then those of A, B, a and b; the last work-item adds up the losses.
//
// global: (tiles + 1). Compile-time: VISIBLE, HIDDEN, ORDER (as in
// contrastive_divergence.cl), TILE_ROWS (divides 16).
// rule: rate, momentum, weight decay, unused.

#include "units.clh"
#include "crbm_shape.clh"

#ifndef TILE_ROWS
#define TILE_ROWS 16
#endif

// velocity ← momentum · velocity + rate · (gradient − decay · parameter); parameter += velocity
INLINE floatN update(global float* parameter, global float* velocity, int at, floatN gradient,
                     float4 rule) {
  const floatN value = loadN(at, parameter);
  const floatN step = rule.y * loadN(at, velocity) + rule.x * (gradient - rule.z * value);
  storeN(step, at, velocity);
  storeN(value + step, at, parameter);
  return value + step;
}

// sum[r] += x[r] · y: one row of the mini-batch
INLINE void add_outer(floatN sum[TILE_ROWS], global const float* x, floatN y) {
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) sum[r] = fma((floatN)(x[r]), y, sum[r]);
}

// W: ⟨v hᵀ⟩ of the data less that of the chain's end (eq 37)
INLINE void update_w(int tile, int rows, float mean, global const float* visible_data,
                     global const float* visible, global const float* hidden_data,
                     global const float* hidden, global float* w, global float* velocity,
                     global float* w_transposed, float4 rule) {
  const int row0 = tile / (H_LD / VEC) * TILE_ROWS;
  const int column = tile % (H_LD / VEC) * VEC;
  floatN sum[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) sum[r] = (floatN)(0.0f);
  for (int i = 0; i < rows; ++i) {
    add_outer(sum, visible_data + i * V_LD + row0, loadN(i * H_LD + column, hidden_data));
    add_outer(sum, visible + i * V_LD + row0, -loadN(i * H_LD + column, hidden));
  }
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) {
    if (row0 + r >= VISIBLE) break;
    const floatN value = update(w, velocity, (row0 + r) * H_LD + column, mean * sum[r], rule);
    float lanes[VEC];
    storeN(value, 0, lanes);
    for (int lane = 0; lane < VEC && column + lane < HIDDEN; ++lane)
      w_transposed[(column + lane) * V_LD + row0 + r] = lanes[lane];
  }
}

// A or B: ⟨history · change⟩ (eq 38 to 41); `ld` is V_LD for A, H_LD for B
INLINE void update_directed(int tile, const int ld, int rows, float mean,
                            global const float* frames, global const int* index, int shift,
                            global const float* change, global float* weights,
                            global float* velocity, float4 rule) {
  const int row0 = tile / (ld / VEC) * TILE_ROWS;
  const int column = tile % (ld / VEC) * VEC;
  frames += (shift - ORDER) * V_LD + row0;
  floatN sum[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) sum[r] = (floatN)(0.0f);
  for (int i = 0; i < rows; ++i)
    add_outer(sum, frames + index[i] * V_LD, loadN(i * ld + column, change));
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r)
    update(weights, velocity, (row0 + r) * ld + column, mean * sum[r], rule);
}

INLINE void update_bias(int column, const int ld, int rows, float mean, global const float* change,
                        global float* bias, global float* velocity, float4 rule) {
  floatN sum = (floatN)(0.0f);
  for (int i = 0; i < rows; ++i) sum += loadN(i * ld + column, change);
  update(bias, velocity, column, mean * sum, rule);
}

kernel void cd_update(
    global const float* frames, global const int* index, int first, int shift, int rows,
    global const float* visible_data, global const float* visible,
    global const float* visible_change, global const float* hidden_data,
    global const float* hidden, global const float* hidden_change, global float* w,
    global float* w_transposed, global float* weights_a, global float* weights_b,
    global float* bias_a, global float* bias_b, global float* velocity_w,
    global float* velocity_a, global float* velocity_b, global float* velocity_bias_a,
    global float* velocity_bias_b, float4 rule_w, float4 rule_a, float4 rule_b,
    global const float* loss, global float* loss_sum, float loss_scale) {
  const float mean = 1.0f / (float)rows;
  const float4 rule_bias = (float4)(rule_w.xy, 0.0f, 0.0f);
  const int history_tiles = ORDER * V_LD / TILE_ROWS;
  index += first;
  int tile = get_global_id(0);
  if (tile < V_LD / TILE_ROWS * (H_LD / VEC)) {
    update_w(tile, rows, mean, visible_data, visible, hidden_data, hidden, w, velocity_w,
             w_transposed, rule_w);
    return;
  }
  tile -= V_LD / TILE_ROWS * (H_LD / VEC);
  if (tile < history_tiles * (V_LD / VEC)) {
    update_directed(tile, V_LD, rows, mean, frames, index, shift, visible_change, weights_a,
                    velocity_a, rule_a);
    return;
  }
  tile -= history_tiles * (V_LD / VEC);
  if (tile < history_tiles * (H_LD / VEC)) {
    update_directed(tile, H_LD, rows, mean, frames, index, shift, hidden_change, weights_b,
                    velocity_b, rule_b);
    return;
  }
  tile -= history_tiles * (H_LD / VEC);
  if (tile < V_LD / VEC) {
    update_bias(tile * VEC, V_LD, rows, mean, visible_change, bias_a, velocity_bias_a, rule_bias);
    return;
  }
  tile -= V_LD / VEC;
  if (tile < H_LD / VEC) {
    update_bias(tile * VEC, H_LD, rows, mean, hidden_change, bias_b, velocity_bias_b, rule_bias);
    return;
  }
  if (tile > H_LD / VEC) return;
  float sum = 0.0f;
  for (int i = 0; i < rows; ++i) sum += loss[i];
  *loss_sum += loss_scale * sum;
}
