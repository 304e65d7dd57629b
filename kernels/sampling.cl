// What chains with some visible units given need beside products and draws.
// Matrices are row-major; *_offset is the first float, *_ld a row's length, padding columns zero.
// global: (ceil(columns / VEC), rows)
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16
//   VEC=1,4 UNROLL=16

#include "types.clh"

// out = given, or `other` where it is NaN
kernel void where_given(global const float* given, int given_offset, int given_ld,
                        global const float* other, int other_offset, int other_ld, int columns,
                        global float* out, int out_offset, int out_ld) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  const floatN x = loadN(given_offset + row * given_ld + column, given);
  const floatN y = loadN(other_offset + row * other_ld + column, other);
  storeN(x == x ? x : y, out_offset + row * out_ld + column, out);
}
