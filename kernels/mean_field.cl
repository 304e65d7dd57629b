// What the unrolled mean field (eq 32, 33) needs beside products: its back-propagation keeps every
// step's values one block of rows after another.

#include "philox.clh"
#include "activation.clh"

// out[r, c] = sum over blocks t of in[t · rows + r, c]; global: (ceil(columns / VEC), rows)
kernel void block_sum(global const float* in, int ld, int rows, int blocks, int columns,
                      global float* out, int out_ld) {
  const int column = get_global_id(0) * VEC;
  const int row = get_global_id(1);
  if (column >= columns) return;
  floatN sum = (floatN)(0.0f);
  for (int t = 0; t < blocks; ++t) sum += loadN((t * rows + row) * ld + column, in);
  storeN(sum, row * out_ld + column, out);
}
