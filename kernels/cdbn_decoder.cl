// One layer's part of a CDBN's down-pass (Algorithm 5): all frames of many sequences in one launch.
// A work-group carries ROWS sequences from frame to frame, their last ORDER frames in __local.
//
// global: (blocks · GROUP), local: (GROUP). Sequence i's frame t is row i · frames + t of `state`
// [V_LD wide] and `code` [H_LD wide]; work is done for frames first … last − 1, and the frames before
// `first` are history. Compile-time: crbm_shape.clh (ORDER at least 1; decode_means asks only
// for ORDER_A), ROWS, COLUMNS, GROUP (tile.clh).
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 GAUSSIAN=0,1 GROUP=1,64 SAMPLE=
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8
//   VISIBLE=1,97 HIDDEN=1,97 ORDER_A=1,5 ORDER_B=0,5 GAUSSIAN=0,1

#undef SAMPLE
#define SAMPLE 1
#include "tile.clh"
#include "crbm_shape.clh"

// A frame's place in the ring of the last ORDER ones, [ORDER x ROWS x V_LD].
#define SLOT(frame) ((frame) % ORDER * (ROWS * V_LD))

// x ← rows start[r] of `from`
INLINE void take_rows(local float* x, const int ld, global const float* from,
                      const int start[ROWS], int frame) {
  for (int column = get_local_id(0) * VEC; column < ld; column += GROUP * VEC)
    for (int r = 0; r < ROWS; ++r)
      storeN(loadN((start[r] + frame) * ld + column, from), r * ld + column, x);
}

// Rows of whole sequences instead of a block's.
INLINE void load_frame(floatN sum[ROWS][COLUMNS], const int count, global const float* x,
                       const int start[ROWS], int frame, int column) {
#pragma unroll
  for (int r = 0; r < ROWS; ++r)
#pragma unroll
    for (int c = 0; c < count; ++c)
      sum[r][c] = loadN((start[r] + frame) * V_LD + column + c * VEC, x);
}

// Only the first `rows` rows: those past the last sequence repeat it, with other draws.
INLINE void store_frame(floatN sum[ROWS][COLUMNS], const int count, global float* x,
                        const int start[ROWS], int rows, int frame, int column) {
#pragma unroll
  for (int r = 0; r < ROWS; ++r)
#pragma unroll
    for (int c = 0; c < count; ++c)
      if (r < rows) storeN(sum[r][c], (start[r] + frame) * V_LD + column + c * VEC, x);
}

// sum += history · weights, of the last `order` frames the oldest first (eq 16, 17)
INLINE void add_history(floatN sum[ROWS][COLUMNS], const int count, local const float* ring,
                        int frame, const int order, global const float* weights, const int ld,
                        int column) {
  for (int q = 0; q < order; ++q)
    add_products(sum, count, ring + SLOT(frame + ORDER - order + q), V_LD, VISIBLE,
                 weights + q * V_LD * ld, ld, column);
}

// The frame is complete in `state`; from here on it is history.
INLINE void remember_frame(local float* ring, global const float* state, const int start[ROWS],
                           int frame) {
  SYNC();
  take_rows(ring + SLOT(frame), V_LD, state, start, frame);
  SYNC();
}

// `state` holds a + (layer above) · Wᵀ (the drive) and becomes the visible means.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void decode_means(
    global float* state, int sequences, int frames, int first, int last,
    global const float* weights_a) {
  local float ring[ORDER * ROWS * V_LD];
  const int row0 = get_group_id(0) * ROWS;
  int start[ROWS];
  for (int r = 0; r < ROWS; ++r) start[r] = min(row0 + r, sequences - 1) * frames;
  for (int frame = first - ORDER; frame < first; ++frame)
    remember_frame(ring, state, start, frame);
  floatN sum[ROWS][COLUMNS];
  for (int frame = first; frame < last; ++frame) {
    FOR_TILES(V_LD, {
      load_frame(sum, count, state, start, frame, column);
      add_history(sum, count, ring, frame, ORDER_A, weights_a, V_LD, column);
#if !GAUSSIAN
      apply_sigmoid(sum, count, column, VISIBLE);
#endif
      store_frame(sum, count, state, start, sequences - row0, frame, column);
    });
    remember_frame(ring, state, start, frame);
  }
}

// The top layer, binary, with `gibbs_steps` sampled steps a frame that start from the code; `state`
// becomes the last visible means. bias_v and bias_h are scratch, [blocks · ROWS x V_LD or H_LD].
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void decode_samples(
    global float* state, global const float* code, int sequences, int frames, int first, int last,
    global const float* w, global const float* w_transposed, global const float* weights_a,
    global const float* weights_b, global const float* bias_a, global const float* bias_b,
    global float* bias_v, global float* bias_h, int gibbs_steps, float temperature, uint4 random) {
  local float ring[ORDER * ROWS * V_LD];
  local float v[ROWS * V_LD];
  local float h[ROWS * H_LD];
  const int row0 = get_group_id(0) * ROWS;
  bias_v += row0 * V_LD;
  bias_h += row0 * H_LD;
  int start[ROWS];
  for (int r = 0; r < ROWS; ++r) start[r] = min(row0 + r, sequences - 1) * frames;
  for (int frame = first - ORDER; frame < first; ++frame)
    remember_frame(ring, state, start, frame);
  floatN sum[ROWS][COLUMNS];
  for (int frame = first; frame < last; ++frame) {
    random.z = (uint)frame;
    FOR_TILES(V_LD, {
      load_tile(sum, count, bias_a, 0, column);
      add_history(sum, count, ring, frame, ORDER_A, weights_a, V_LD, column);
      store_tile(sum, count, bias_v, V_LD, column);
    });
    FOR_TILES(H_LD, {
      load_tile(sum, count, bias_b, 0, column);
      add_history(sum, count, ring, frame, ORDER_B, weights_b, H_LD, column);
      store_tile(sum, count, bias_h, H_LD, column);
    });
    take_rows(h, H_LD, code, start, frame);
    SYNC();
    for (int k = 0; k < gibbs_steps; ++k) {
      FOR_TILES(V_LD, {
        load_tile(sum, count, bias_v, V_LD, column);
        add_products(sum, count, h, H_LD, HIDDEN, w_transposed, V_LD, column);
        apply_sigmoid(sum, count, column, VISIBLE);
        keep_tile(sum, count, v, V_LD, column);
        for (int c = 0; c < count; ++c)
          draw_rows(v, V_LD, column + c * VEC, row0, temperature,
                    (uint4)(random.xyz, random.w + (uint)(2 * k)));
      });
      SYNC();
      FOR_TILES(H_LD, {
        load_tile(sum, count, bias_h, H_LD, column);
        add_products(sum, count, v, V_LD, VISIBLE, w, H_LD, column);
        apply_sigmoid(sum, count, column, HIDDEN);
        keep_tile(sum, count, h, H_LD, column);
        for (int c = 0; c < count; ++c)
          draw_rows(h, H_LD, column + c * VEC, row0, temperature,
                    (uint4)(random.xyz, random.w + (uint)(2 * k + 1)));
      });
      SYNC();
    }
    FOR_TILES(V_LD, {
      load_tile(sum, count, bias_v, V_LD, column);
      add_products(sum, count, h, H_LD, HIDDEN, w_transposed, V_LD, column);
      apply_sigmoid(sum, count, column, VISIBLE);
      store_frame(sum, count, state, start, sequences - row0, frame, column);
    });
    remember_frame(ring, state, start, frame);
  }
}
