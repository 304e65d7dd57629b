// Back-propagation through a layer's down-pass on its own output (decode_means of cdbn_decoder.cl), from
// the last frame to the first: all frames of many sequences in one launch. A work-group carries ROWS
// sequences (frame_ring.clh); its ring holds the errors of the ORDER frames that follow.
//
// `errors` [V_LD wide] holds each frame's own error and becomes that by the frame's input. Sequence i's
// frame t is row i · frames + t of `errors` and of `state`, the units themselves. `following`: A with its
// lags turned round, block q of it [V_LD x V_LD] transposed for the frame q + 1 later. THROUGH is what the
// units are: none, sigmoid, or centered_sigmoid, of which drop-out kept kept_share.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 THROUGH=none,sigmoid,centered_sigmoid GROUP=1,64 ORDER_B=0 GAUSSIAN= HIDDEN= SAMPLE=
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8 ORDER_B=0
//   VISIBLE=1,97 ORDER_A=1,5 ORDER_B=0 THROUGH=none,sigmoid,centered_sigmoid

#include "frame_ring.clh"

#ifndef THROUGH
#define THROUGH none
#endif

// What is left of an error before a unit that became y.
INLINE floatN through_none(floatN error, floatN y, float kept_share) { return error; }
INLINE floatN through_sigmoid(floatN error, floatN y, float kept_share) {
  return error * (y * (1.0f - y));
}
INLINE floatN through_centered_sigmoid(floatN error, floatN y, float kept_share) {
  return centered_sigmoid_gradient(error, y, kept_share);
}

INLINE void go_through_units(floatN sum[ROWS][COLUMNS], const int count, global const float* state,
                             const int start[ROWS], int frame, int column, float kept_share) {
#pragma unroll
  for (int c = 0; c < count; ++c) {
    const floatN mask = column_mask(column + c * VEC, VISIBLE);
#pragma unroll
    for (int r = 0; r < ROWS; ++r) {
      const floatN y = loadN((start[r] + frame) * V_LD + column + c * VEC, state);
      sum[r][c] = mask * PASTE(through_, THROUGH)(sum[r][c], y, kept_share);
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
