// How fast the device multiplies and adds, and how fast it reads, at best. fma_loop: CHAINS independent
// fma() chains a work-item, in registers. read_loop: a work-item adds up its own `rows` rows of 8 · VEC
// floats, `passes` times. global: any; out[item] keeps the compiler from dropping them.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 CHAINS=16
//   VEC=1,4 UNROLL=16

#include "types.clh"

#ifndef CHAINS
#define CHAINS 16
#endif

// An argument of vector type lets PoCL's compiler use the widest registers.
static inline __attribute__((always_inline)) floatN step(floatN x, floatN a, floatN b) {
  return fma(x, a, b);
}

kernel void fma_loop(global float* out, int iterations, float a, float b) {
  floatN x[CHAINS];
#pragma unroll
  for (int c = 0; c < CHAINS; ++c) x[c] = (floatN)((float)get_global_id(0) + (float)c);
  for (int i = 0; i < iterations; ++i)
#pragma unroll
    for (int c = 0; c < CHAINS; ++c) x[c] = step(x[c], (floatN)(a), (floatN)(b));
  floatN sum = x[0];
#pragma unroll
  for (int c = 1; c < CHAINS; ++c) sum += x[c];
  out[get_global_id(0)] = sum_lanes(sum);
}

kernel void read_loop(global const float* in, int rows, int passes, global float* out) {
  in += get_global_id(0) * rows * 8 * VEC;
  floatN sum[8];
#pragma unroll
  for (int c = 0; c < 8; ++c) sum[c] = (floatN)(0.0f);
  for (int pass = 0; pass < passes; ++pass) {
    for (int row = 0; row < rows; ++row)
#pragma unroll
      for (int c = 0; c < 8; ++c) sum[c] += loadN((row * 8 + c) * VEC, in);
    sum[0] *= 0.5f;  // or the passes could be one
  }
#pragma unroll
  for (int c = 1; c < 8; ++c) sum[0] += sum[c];
  out[get_global_id(0)] = sum_lanes(sum[0]);
}
