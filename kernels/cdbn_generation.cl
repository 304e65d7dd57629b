// The top layer of a CDBN that runs on its own output (Algorithm 4, lines 7 and 8): all frames of many
// sequences in one launch. A work-group carries ROWS sequences from frame to frame (frame_ring.clh).
//
// Sequence i's frame t is row i · frames + t of `state` [V_LD wide]; frames first … frames − 1 are
// generated, and those before `first`, at least one, are the seed. `bias_v` and `bias_h` are scratch,
// [blocks · ROWS x V_LD or H_LD].
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 GAUSSIAN=0,1 GROUP=1,64 SAMPLE=
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8
//   VISIBLE=1,97 HIDDEN=1,97 ORDER_A=1,5 ORDER_B=0,5 GAUSSIAN=0,1
//   VEC=1,4 UNROLL=16

#undef SAMPLE
#define SAMPLE 1
#include "frame_ring.clh"

// bias ← the history's part of the input, and the static bias (eq 16, 17)
#define DYNAMIC_BIAS(ld, order, weights, static_bias, bias)        \
  FOR_TILES(ld, {                                                  \
    clear_tile(sum, count);                                        \
    add_history(sum, count, ring, frame, order, weights, ld, column); \
    add_tile(sum, count, static_bias, 0, column);                  \
    store_tile(sum, count, bias, ld, column);                      \
  })

// sum = x · weights + bias: the input of units whose other layer is x. Sums are those of gemm.cl, bias
// last: the same bits as product by product.
#define INPUT(x, x_ld, units, weights, ld, bias)                   \
  clear_tile(sum, count);                                          \
  add_products(sum, count, x, x_ld, units, weights, ld, column);   \
  add_tile(sum, count, bias, ld, column)

// The hidden units start from the frame before. They are drawn in `gibbs_steps` steps, then comes one
// of means (generation.hpp). Visible units are means throughout.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void generate_frames(
    global float* state, int sequences, int frames, int first, global const float* w,
    global const float* w_transposed, global const float* weights_a, global const float* weights_b,
    global const float* bias_a, global const float* bias_b, global float* bias_v,
    global float* bias_h, int gibbs_steps, float temperature, uint4 random) {
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
  take_rows(v, V_LD, state, start, first - 1);
  SYNC();
  floatN sum[ROWS][COLUMNS];
  for (int frame = first; frame < frames; ++frame) {
    random.z = (uint)(frame - first);
    DYNAMIC_BIAS(V_LD, ORDER_A, weights_a, bias_a, bias_v);
    DYNAMIC_BIAS(H_LD, ORDER_B, weights_b, bias_b, bias_h);
    for (int k = 0; k <= gibbs_steps; ++k) {
      FOR_TILES(H_LD, {
        INPUT(v, V_LD, VISIBLE, w, H_LD, bias_h);
        apply_sigmoid(sum, count, column, HIDDEN);
        keep_tile(sum, count, h, H_LD, column);
        if (k < gibbs_steps && temperature != 0.0f)
          for (int c = 0; c < count; ++c)
            draw_rows(h, H_LD, column + c * VEC, row0, temperature,
                      (uint4)(random.xyz, random.w + (uint)k));
      });
      SYNC();
      FOR_TILES(V_LD, {
        INPUT(h, H_LD, HIDDEN, w_transposed, V_LD, bias_v);
#if !GAUSSIAN
        apply_sigmoid(sum, count, column, VISIBLE);
#endif
        keep_tile(sum, count, v, V_LD, column);
        if (k == gibbs_steps)
          store_frame(sum, count, state, start, sequences - row0, frame, column);
      });
      SYNC();
    }
    remember_frame(ring, state, start, frame);
  }
}
