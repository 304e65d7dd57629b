// The whole chain of CD-k (Algorithm 2) in one launch. Rows of a mini-batch are independent while
// they are sampled, so one work-group runs everything for its ROWS rows: dynamic biases from the
// history read in place (eq 15 to 17), the hidden units of the data, then `gibbs_steps` times
// visible means and hidden units. What the products read, visible means `v` and hidden units `s`,
// is in __local; the rest goes to the outputs, which contrastive_divergence_update.cl reads.
//
// global: (blocks · GROUP), local: (GROUP). Compile-time: crbm_shape.clh, ROWS, COLUMNS, GROUP
// (tile.clh).
// parameters_at: the first floats of W, A, B, a and b.
// Outputs are [blocks · ROWS x V_LD or H_LD]; rows past `rows` repeat the last one.
//   visible_data, hidden_data          v and p(h | v, H) of the data
//   visible, hidden                    the same at the chain's end
//   visible_change, hidden_change      data − end; dynamic biases while the chain runs
//   loss[row]                          Σ (v data − v end)²
// SAMPLE_VISIBLE=1 draws the visible units of every step, too (eq 6, 10), with phases from
// VISIBLE_PHASE on. PERSISTENT=1 takes the first step's hidden units from `particles` [blocks · ROWS x
// H_LD], one row for each of the mini-batch, and leaves those of the last step there; where `fresh`,
// the chains start from the data. MASKED=1 keeps the units at zero that were not seen: `seen` [as
// frames] is 1 for what was, 0 for what was not, where the data are zero too. Variants that do not
// use `particles` or `seen` take any buffer for it.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 GAUSSIAN=0,1 GROUP=1,64 SAMPLE=
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8
//   VEC=1,16 GROUP=1,64 GAUSSIAN=0,1 SAMPLE_VISIBLE=0,1 PERSISTENT=0,1 MASKED=0,1
//   VISIBLE=1,97 HIDDEN=1,97 ORDER_A=0,1,5 ORDER_B=0,5 GAUSSIAN=0,1
//   VEC=1,4 UNROLL=16

#undef SAMPLE
#define SAMPLE 1
#include "persistent_chain.clh"
#include "crbm_shape.clh"

#ifndef SAMPLE_VISIBLE
#define SAMPLE_VISIBLE 0
#endif
#ifndef MASKED
#define MASKED 0
#endif

// v ← the frames `back` before those of the block's rows
INLINE void take_frames(local float* v, global const float* frames, const int at[ROWS], int back) {
  SYNC();
  for (int column = get_local_id(0) * VEC; column < V_LD; column += GROUP * VEC)
    for (int r = 0; r < ROWS; ++r)
      storeN(loadN((at[r] - back) * V_LD + column, frames), r * V_LD + column, v);
  SYNC();
}

// change = data − end, where `end` is this tile
INLINE void store_change(floatN end[ROWS][COLUMNS], const int count, global const float* data,
                         global float* change, const int ld, int column) {
#pragma unroll
  for (int r = 0; r < ROWS; ++r)
#pragma unroll
    for (int c = 0; c < count; ++c) {
      const int at = r * ld + column + c * VEC;
      storeN(loadN(at, data) - end[r][c], at, change);
    }
}

#if SAMPLE_VISIBLE
// Visible means in columns column … column + VEC of v become draws.
INLINE void draw_visible(local float* v, int column, int row0, uint4 random) {
#if GAUSSIAN
  draw_normal_rows(v, V_LD, column, VISIBLE, row0, random);
#else
  draw_rows(v, V_LD, column, row0, 1.0f, random);
#endif
}
#endif

#if MASKED
// Zero where the block's rows, frames `at`, did not see the unit.
INLINE void mask_tile(floatN sum[ROWS][COLUMNS], const int count, global const float* seen,
                      const int at[ROWS], int column) {
#pragma unroll
  for (int r = 0; r < ROWS; ++r)
#pragma unroll
    for (int c = 0; c < count; ++c) sum[r][c] *= loadN(at[r] * V_LD + column + c * VEC, seen);
}
#endif

// Dynamic biases â and b̂ (eq 16, 17), one frame of the history after the other, which v takes in turn
INLINE void add_dynamic_biases(local float* v, global const float* frames, const int at[ROWS],
                               global const float* parameters, int8 parameters_at,
                               global float* visible_bias, global float* hidden_bias) {
  global const float* weights_a = parameters + parameters_at.s1;
  global const float* weights_b = parameters + parameters_at.s2;
  floatN sum[ROWS][COLUMNS];
  FOR_TILES(V_LD, {
    load_tile(sum, count, parameters + parameters_at.s3, 0, column);
    store_tile(sum, count, visible_bias, V_LD, column);
  });
  FOR_TILES(H_LD, {
    load_tile(sum, count, parameters + parameters_at.s4, 0, column);
    store_tile(sum, count, hidden_bias, H_LD, column);
  });
  for (int q = 0; q < ORDER; ++q) {
    take_frames(v, frames, at, ORDER - q);
    const int seen_by_a = q - (ORDER - ORDER_A), seen_by_b = q - (ORDER - ORDER_B);
    if (seen_by_a >= 0)
      FOR_TILES(V_LD, {
        load_tile(sum, count, visible_bias, V_LD, column);
        add_products(sum, count, v, V_LD, VISIBLE, weights_a + seen_by_a * V_LD * V_LD, V_LD, column);
        store_tile(sum, count, visible_bias, V_LD, column);
      });
    if (seen_by_b >= 0)
      FOR_TILES(H_LD, {
        load_tile(sum, count, hidden_bias, H_LD, column);
        add_products(sum, count, v, V_LD, VISIBLE, weights_b + seen_by_b * V_LD * H_LD, H_LD, column);
        store_tile(sum, count, hidden_bias, H_LD, column);
      });
  }
}

// v ← visible means given s, or draws of them. The last step stores them in `visible`, and data − end in
// `visible_change`, which is â until then.
INLINE void visible_half_step(local float* v, local const float* s, global const float* w_transposed,
                              global const float* visible_data, global float* visible,
                              global float* visible_change, global const float* seen,
                              const int at[ROWS], int row0, int step, bool last, uint4 random) {
  floatN sum[ROWS][COLUMNS];
  FOR_TILES(V_LD, {
    load_tile(sum, count, visible_change, V_LD, column);
    add_products(sum, count, s, H_LD, HIDDEN, w_transposed, V_LD, column);
#if !GAUSSIAN
    apply_sigmoid(sum, count, column, VISIBLE);
#endif
    keep_tile(sum, count, v, V_LD, column);
#if SAMPLE_VISIBLE
    for (int c = 0; c < count; ++c)
      draw_visible(v, column + c * VEC, row0,
                   (uint4)(random.xyz, random.w + (uint)(VISIBLE_PHASE + step)));
    load_kept_tile(sum, count, v, V_LD, column);
#endif
#if MASKED
    mask_tile(sum, count, seen, at, column);
    keep_tile(sum, count, v, V_LD, column);
#endif
    if (last) {
      store_tile(sum, count, visible, V_LD, column);
      store_change(sum, count, visible_data, visible_change, V_LD, column);
    }
  });
}

// s ← draws of the hidden units given v, for the next step (start_or_draw). The first step stores p(h | v, H)
// in `hidden_data`, the last one in `hidden`, and data − end in `hidden_change`, which is b̂ until then.
INLINE void hidden_half_step(local const float* v, local float* s, global const float* w,
                             global float* hidden_data, global float* hidden,
                             global float* hidden_change, global float* particles, int fresh,
                             int row0, int step, bool last, uint4 random) {
  floatN sum[ROWS][COLUMNS];
  FOR_TILES(H_LD, {
    load_tile(sum, count, hidden_change, H_LD, column);
    add_products(sum, count, v, V_LD, VISIBLE, w, H_LD, column);
    apply_sigmoid(sum, count, column, HIDDEN);
    if (last) {
      store_tile(sum, count, hidden, H_LD, column);
      store_change(sum, count, hidden_data, hidden_change, H_LD, column);
    } else if (step == 0) {
      store_tile(sum, count, hidden_data, H_LD, column);
    }
    start_or_draw(sum, count, s, H_LD, particles, fresh, step, last, column, row0,
                  (uint4)(random.xyz, random.w + (uint)step));
  });
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void gibbs_chain(
    global const float* frames, global const int* index, int first, int shift, int rows,
    global const float* parameters, int8 parameters_at, global const float* w_transposed,
    global float* visible_data, global float* visible, global float* visible_change,
    global float* hidden_data, global float* hidden, global float* hidden_change,
    global float* loss, int gibbs_steps, uint4 random, global float* particles, int fresh,
    global const float* seen) {
  local float v[ROWS * V_LD];
  local float s[ROWS * H_LD];
  const int row0 = get_group_id(0) * ROWS;
  int at[ROWS];
  for (int r = 0; r < ROWS; ++r) at[r] = index[first + min(row0 + r, rows - 1)] + shift;
  visible_data += row0 * V_LD;
  visible += row0 * V_LD;
  visible_change += row0 * V_LD;
  hidden_data += row0 * H_LD;
  hidden += row0 * H_LD;
  hidden_change += row0 * H_LD;
  particles += row0 * H_LD;

  add_dynamic_biases(v, frames, at, parameters, parameters_at, visible_change, hidden_change);

  take_frames(v, frames, at, 0);
  for (int column = get_local_id(0) * VEC; column < V_LD; column += GROUP * VEC)
    for (int r = 0; r < ROWS; ++r)
      storeN(loadN(r * V_LD + column, v), r * V_LD + column, visible_data);

  for (int step = 0; step <= gibbs_steps; ++step) {
    const bool last = step == gibbs_steps;
    if (step > 0) {
      visible_half_step(v, s, w_transposed, visible_data, visible, visible_change, seen, at, row0,
                        step, last, random);
      SYNC();
    }
    hidden_half_step(v, s, parameters + parameters_at.s0, hidden_data, hidden, hidden_change,
                     particles, fresh, row0, step, last, random);
    SYNC();
  }

  for (int r = get_local_id(0); r < ROWS && row0 + r < rows; r += GROUP)
    loss[row0 + r] = row_squares(visible_data + r * V_LD, v + r * V_LD, V_LD);
}
