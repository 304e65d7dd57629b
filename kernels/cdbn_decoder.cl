// One layer's part of a CDBN's down-pass (Algorithm 5): all frames of many sequences in one launch.
// A work-group carries ROWS sequences from frame to frame (frame_ring.clh).
//
// Sequence i's frame t is row i · frames + t of `state` [V_LD wide] and `code` [H_LD wide]; work is done
// for frames first … last − 1, and the frames before `first` are history. ORDER is at least
// 1; decode_means asks only for ORDER_A.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 GAUSSIAN=0,1 GROUP=1,64 SAMPLE=
//   VEC=1,16 GAUSSIAN=0 CENTERED=0,1 GROUP=1,64
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8
//   VISIBLE=1,97 HIDDEN=1,97 ORDER_A=1,5 ORDER_B=0,5 GAUSSIAN=0,1
//   VEC=1,4 UNROLL=16

#undef SAMPLE
#define SAMPLE 1
#include "frame_ring.clh"

#ifndef CENTERED
#define CENTERED 0
#endif

// `input_from_above` is a + (layer above) · Wᵀ, sequence i's frame t in row i · input_frames + t − input_first;
// it may be `state` itself, which becomes the visible means. CENTERED=1: binary units are about zero.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void decode_means(
    global float* state, global const float* input_from_above, int input_frames, int input_first,
    int sequences, int frames, int first, int last, global const float* weights_a) {
  local float ring[ORDER * ROWS * V_LD];
  const int row0 = get_group_id(0) * ROWS;
  int start[ROWS], input_start[ROWS];
  for (int r = 0; r < ROWS; ++r) {
    start[r] = min(row0 + r, sequences - 1) * frames;
    input_start[r] = min(row0 + r, sequences - 1) * input_frames - input_first;
  }
  for (int frame = first - ORDER; frame < first; ++frame)
    remember_frame(ring, state, start, frame);
  floatN sum[ROWS][COLUMNS];
  for (int frame = first; frame < last; ++frame) {
    FOR_TILES(V_LD, {
      load_frame(sum, count, input_from_above, input_start, frame, column);
      add_history(sum, count, ring, frame, ORDER_A, weights_a, V_LD, column);
#if CENTERED
      apply_centered_sigmoid(sum, count, column, VISIBLE);
#elif !GAUSSIAN
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
    // The means of the last round are kept. It is part of the loop, which so runs at least once: where it
    // may not run at all, PoCL 3.1 makes other bits of it for groups of more than one work-item.
    for (int k = 0; k <= gibbs_steps; ++k) {
      FOR_TILES(V_LD, {
        load_tile(sum, count, bias_v, V_LD, column);
        add_products(sum, count, h, H_LD, HIDDEN, w_transposed, V_LD, column);
        apply_sigmoid(sum, count, column, VISIBLE);
        if (k == gibbs_steps) {
          store_frame(sum, count, state, start, sequences - row0, frame, column);
        } else {
          keep_draws(sum, count, v, V_LD, column, row0, temperature,
                     (uint4)(random.xyz, random.w + (uint)(2 * k)));
        }
      });
      SYNC();
      if (k < gibbs_steps)
        FOR_TILES(H_LD, {
          load_tile(sum, count, bias_h, H_LD, column);
          add_products(sum, count, v, V_LD, VISIBLE, w, H_LD, column);
          apply_sigmoid(sum, count, column, HIDDEN);
          keep_draws(sum, count, h, H_LD, column, row0, temperature,
                     (uint4)(random.xyz, random.w + (uint)(2 * k + 1)));
        });
      SYNC();
    }
    remember_frame(ring, state, start, frame);
  }
}
