// Back-propagation through a layer's down-pass on its own output (decode_means of cdbn_decoder.cl), from
// the last frame to the first: all frames of many sequences in one launch. A work-group carries ROWS
// sequences (frame_ring.clh); its ring holds the errors of the ORDER frames that follow.
//
// `errors` [V_LD wide] holds each frame's own error and becomes that by the frame's input. Sequence i's
// frame t is row i · frames + t of `errors` and of `state`, the units themselves. `following`: A with its
// lags turned round, block q of it [V_LD x V_LD] transposed for the frame q + 1 later. ACTIVATION is the
// gradient of what the units are (epilogue.clh): none, sigmoid_gradient, or centered_sigmoid_gradient, of
// which drop-out kept kept_share.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 ACTIVATION=none,sigmoid_gradient,centered_sigmoid_gradient GROUP=1,64 ORDER_B=0
//   ACTIVATION= BIAS= GAUSSIAN= HIDDEN= SAMPLE= ORDER_B=0
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8 ORDER_B=0
//   VISIBLE=1,97 ORDER_A=1,5 ORDER_B=0 ACTIVATION=none,sigmoid_gradient,centered_sigmoid_gradient
//   VEC=1,4 UNROLL=16

#include "frame_ring.clh"
#include "epilogue.clh"

// What is left of errors before units, which became `state`.
INLINE void go_through_units(floatN sum[ROWS][COLUMNS], const int count, global const float* state,
                             const int start[ROWS], int frame, int column, float kept_share) {
#pragma unroll
  for (int c = 0; c < count; ++c) {
    const floatN mask = column_mask(column + c * VEC, VISIBLE);
#pragma unroll
    for (int r = 0; r < ROWS; ++r) {
      const int at = (start[r] + frame) * V_LD + column + c * VEC;
      sum[r][c] = mask * PASTE(activation_, ACTIVATION)(sum[r][c], state, at, kept_share);
    }
  }
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void decoder_errors(
    global float* errors, global const float* state, int sequences, int frames, int first, int last,
    global const float* following, float kept_share) {
  local float ring[ORDER * ROWS * V_LD];
  const int row0 = get_group_id(0) * ROWS;
  int start[ROWS];
  for (int r = 0; r < ROWS; ++r) start[r] = min(row0 + r, sequences - 1) * frames;
  floatN sum[ROWS][COLUMNS];
  for (int frame = last - 1; frame >= first; --frame) {
    FOR_TILES(V_LD, {
      load_frame(sum, count, errors, start, frame, column);
      for (int later = 1; later <= min(ORDER, last - 1 - frame); ++later)
        add_products(sum, count, ring + SLOT(frame + later), V_LD, VISIBLE,
                     following + (later - 1) * V_LD * V_LD, V_LD, column);
      go_through_units(sum, count, state, start, frame, column, kept_share);
      store_frame(sum, count, errors, start, sequences - row0, frame, column);
    });
    remember_frame(ring, errors, start, frame);
  }
}
