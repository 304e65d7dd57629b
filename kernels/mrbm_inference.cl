// The chain of an MRBM of two binary modalities with one clamped (Algorithm 5's inference) in one
// launch: `steps` times the shared hidden units given both modalities (eq 21, 32), then the absent
// one given them (eq 22, 23, 33). Rows are independent, so one work-group runs all of it for its ROWS rows.
// The absent modality starts from zeros, so that the first hidden pass sees the present one alone.
// Sums are those of gemm.cl, bias last: the same bits as product by product.
//
// global: (blocks · GROUP), local: (GROUP). Compile-time: mrbm_shape.clh, which has `layout` too, and
// tile.clh's ROWS, COLUMNS, GROUP. Modality p is present, q absent. Row r of `present` is row
// index[first + r] + shift if `indexed`, else r, of rows that are present_ld floats apart; row r of
// `absent` likewise, without index. `present_input` is scratch, [blocks · ROWS x H_LD]: b and the
// present modality's products.
//
// With a temperature other than 0 units are drawn as SAMPLE specifies, 1 or 3 (tile.clh), phase
// 2 · step for the hidden ones and 2 · step + 1 for the absent ones; the last step's absent ones stay
// probabilities. After CHAIN_PHASES phases they begin anew, with the random numbers' step
// `steps_apart` further on.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 SAMPLE=1,3 GROUP=1,64 STEPS= BINARY=
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8
//   MODALITIES=2,3 VISIBLE=,1,97 LARGEST=97 HIDDEN=1,97
//   VEC=1,4 UNROLL=16

#if SAMPLE != 3
#undef SAMPLE
#define SAMPLE 1
#endif
#include "mean_field.clh"

// Probabilities of this tile become what lies between them and their draws.
INLINE void draw_tile(local float* x, const int ld, const int count, int column, int row0,
                      float temperature, uint4 random, uint steps_apart, int pass) {
  if (temperature == 0.0f) return;
  const uint phase = (random.w & 0xffffu) + (uint)pass;
  random.z += phase / CHAIN_PHASES * steps_apart;
  random.w = (random.w & 0xffff0000u) + phase % CHAIN_PHASES;
  for (int c = 0; c < count; ++c) draw_rows(x, ld, column + c * VEC, row0, temperature, random);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void clamped_chain(
    global const float* present, int present_offset, int present_ld, global const int* index,
    int indexed, int first, int shift, int rows, global const int* layout, int p, int q,
    global const float* parameters, global const float* transposed, global float* present_input,
    global float* absent, int absent_offset, int absent_ld, int steps,
    float temperature, uint4 random, uint steps_apart) {
  local float x[ROWS * X_LD];  // the present modality, then the absent one
  local float h[ROWS * H_LD];
  const int row0 = get_group_id(0) * ROWS;
  const int P = UNITS(p), Q = UNITS(q), P_LD = PADDED(P);
  global const float* w_p = parameters + W_AT(p);
  global const float* w_q = parameters + W_AT(q);
  global const float* wt_q = transposed + WT_AT(q);
  global const float* a_q = parameters + A_AT(q);
  global const float* b = parameters + B_AT;
  for (int r = 0; r < ROWS; ++r) {
    const int row = min(row0 + r, rows - 1);
    const int at = present_offset + (indexed ? index[first + row] + shift : row) * present_ld;
    for (int column = get_local_id(0) * VEC; column < P_LD; column += GROUP * VEC)
      storeN(loadN(at + column, present), r * X_LD + column, x);
  }
  present_input += row0 * H_LD;
  absent += absent_offset + row0 * absent_ld;
  floatN sum[ROWS][COLUMNS];
  SYNC();

  ADD_PRESENT_INPUT(P, w_p, b, 0);
  for (int step = 0; step < steps; ++step) {
    const bool last = step + 1 == steps;
    // At first x still has the present modality, whose products are in present_input.
    SHARED_UNITS(step > 0 ? Q : 0, w_q, present_input, {
      draw_tile(h, H_LD, count, column, row0, temperature, random, steps_apart, 2 * step);
    });
    SYNC();
    ABSENT_UNITS(Q, wt_q, a_q, 0, {
      if (last) {
        store_first_rows(sum, count, absent, absent_ld, column, rows - row0);
      } else {
        keep_tile(sum, count, x, X_LD, column);
        draw_tile(x, X_LD, count, column, row0, temperature, random, steps_apart, 2 * step + 1);
      }
    });
    SYNC();
  }
}
