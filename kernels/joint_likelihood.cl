// The joint likelihood of an MRBM by contrastive divergence over all modalities, the whole chain in one
// launch: hidden units of the data (eq 21), then `gibbs_steps` times every modality's units given them
// (eq 22, 23) and the hidden units given all. Rows are independent, so one work-group runs everything
// for its ROWS rows. x has a row's units of all modalities side by side, h its hidden units: what the
// products read, in __local. Draws are those of mrbm_chains.hpp.
//
// global: (blocks · GROUP), local: (GROUP). Compile-time: mrbm_shape.clh, which has `layout` too, tile.clh's
// ROWS, COLUMNS, GROUP, and ALL_UNITS, the padded units of all modalities together.
// Stacks are one modality after another, [stride x PADDED(units)] each: codes, the data, and visible,
// the chain's end. hidden_data, hidden [stride x H_LD] are p(h | v) of these. `stride` is whole blocks;
// rows past `rows` repeat the block's last one. loss[m · stride + row] = Σ (v data − v end)² of modality m.
// SAMPLE_VISIBLE=1 draws the visible units of every step, too. PERSISTENT=1 takes the first step's hidden
// units from `particles` [stride x H_LD], and leaves those of the last step there; where `fresh`, the
// chains start from the data. PERSISTENT=0 uses neither of the two arguments: any buffer will do.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 GROUP=1,64 SAMPLE= STEPS= ALL_UNITS=
//   VEC=1,16 GROUP=1,256 ROWS=1,32 COLUMNS=1,8
//   VEC=1,16 GROUP=1,64 BINARY=0,1 SAMPLE_VISIBLE=0,1 PERSISTENT=0,1
//   MODALITIES=2,3 VISIBLE=,1,97 LARGEST=97 HIDDEN=1,97 BINARY=0,1
//   VEC=1,4 UNROLL=16

#undef SAMPLE
#define SAMPLE 1
#include "persistent_chain.clh"
#include "mrbm_shape.clh"

#ifndef ALL_UNITS
#define ALL_UNITS (MODALITIES * PADDED(LARGEST))
#endif
#ifndef SAMPLE_VISIBLE
#define SAMPLE_VISIBLE 0
#endif

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void joint_chain(
    global const int* layout, int rows, int stride, global const float* parameters,
    global const float* transposed, global const float* codes, global float* visible,
    global float* hidden_data, global float* hidden, global float* loss, int gibbs_steps,
    uint4 random, global float* particles, int fresh) {
  local float x[ROWS * ALL_UNITS];
  local float h[ROWS * H_LD];
  const int row0 = get_group_id(0) * ROWS;
  const int present_rows = min(ROWS, rows - row0);
  hidden_data += row0 * H_LD;
  hidden += row0 * H_LD;
  particles += row0 * H_LD;
  floatN sum[ROWS][COLUMNS];

  for (int m = 0; m < MODALITIES; ++m) {
    const int ld = PADDED(UNITS(m)), before = UNITS_BEFORE(m);
    global const float* code = codes + stride * before + row0 * ld;
    for (int r = 0; r < ROWS; ++r)
      for (int column = get_local_id(0) * VEC; column < ld; column += GROUP * VEC)
        storeN(loadN(min(r, present_rows - 1) * ld + column, code), r * ALL_UNITS + before + column, x);
  }
  SYNC();

  for (int step = 0;; ++step) {
    const bool last = step == gibbs_steps;
    FOR_TILES(H_LD, {
      clear_tile(sum, count);
      for (int m = 0; m < MODALITIES; ++m)
        add_products(sum, count, x + UNITS_BEFORE(m), ALL_UNITS, UNITS(m), parameters + W_AT(m), H_LD,
                     column);
      add_tile(sum, count, parameters + B_AT, 0, column);
      apply_sigmoid(sum, count, column, HIDDEN);
      if (step == 0) store_tile(sum, count, hidden_data, H_LD, column);
      if (last) store_tile(sum, count, hidden, H_LD, column);
      start_or_draw(sum, count, h, H_LD, particles, fresh, step, last, column, row0,
                    (uint4)(random.xyz, random.w + (uint)step));
    });
    SYNC();
    if (last) break;
    for (int m = 0; m < MODALITIES; ++m) {
      local float* v = x + UNITS_BEFORE(m);
      FOR_TILES(PADDED(UNITS(m)), {
        clear_tile(sum, count);
        add_products(sum, count, h, H_LD, HIDDEN, transposed + WT_AT(m), PADDED(UNITS(m)), column);
        add_tile(sum, count, parameters + A_AT(m), 0, column);
        if (!IS_GAUSSIAN(m)) apply_sigmoid(sum, count, column, UNITS(m));
        keep_tile(sum, count, v, ALL_UNITS, column);
#if SAMPLE_VISIBLE
        const uint phase = VISIBLE_PHASE + (step + 1) * MODALITIES + m;
        const uint4 own = (uint4)(random.xyz, random.w + phase);
        for (int c = 0; c < count; ++c) {
          if (IS_GAUSSIAN(m))
            draw_normal_rows(v, ALL_UNITS, column + c * VEC, UNITS(m), row0, own);
          else
            draw_rows(v, ALL_UNITS, column + c * VEC, row0, 1.0f, own);
        }
#endif
      });
    }
    SYNC();
  }

  for (int m = 0; m < MODALITIES; ++m) {
    const int ld = PADDED(UNITS(m)), before = UNITS_BEFORE(m);
    const int first = stride * before + row0 * ld;
    for (int r = 0; r < ROWS; ++r)
      for (int column = get_local_id(0) * VEC; column < ld; column += GROUP * VEC)
        storeN(loadN(r * ALL_UNITS + before + column, x), first + r * ld + column, visible);
    for (int r = get_local_id(0); r < present_rows; r += GROUP)
      loss[m * stride + row0 + r] =
          row_squares(codes + first + r * ld, x + r * ALL_UNITS + before, ld);
  }
}
