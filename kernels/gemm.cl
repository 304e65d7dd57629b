// Register-tiled products with the epilogues of the model's units.
//
// gemm:               C[i, j] = f(alpha · sum_k A[i, k] · B[k, j] + beta · C[i, j] + bias)
// gemm_transposed_a:  C[i, j] =   alpha · sum_k A[k, i] · B[k, j] + beta · C[i, j]
//
// All matrices are row-major floats with leading dimensions lda, ldb, ldc (multiples of 16, padding
// columns zero); *_offset is the first element used. With A_ROWS row r of A is row a_rows[r] +
// a_shift of the frames, and may run on over several frames (history windows, eq 15).
// f is the epilogue (epilogue.clh).
// One work-item makes TILE_ROWS x VEC of C, its accumulators in registers.
// global: (ceil(n / VEC), ceil(rows of C / TILE_ROWS))
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 TILE_ROWS=1,4,10,16 A_ROWS=0,1
//   VEC=1,16 A_ROWS=1 ACTIVATION=none,sigmoid,relu,centered_sigmoid,sigmoid_gradient,relu_gradient,centered_sigmoid_gradient
//   BIAS=none,row,matrix ACTIVATION=none,sigmoid,relu,centered_sigmoid,sigmoid_gradient,relu_gradient,centered_sigmoid_gradient SAMPLE=0,1,2,3
//   VEC=1,4,8,16 SAMPLE=0,1,2,3

#include "epilogue.clh"

#ifndef TILE_ROWS
#define TILE_ROWS 10
#endif
#ifndef A_ROWS
#define A_ROWS 0
#endif

#if A_ROWS
#define A_ROW(r) ((a_rows[a_first + (r)] + a_shift) * lda + a_offset)
#else
#define A_ROW(r) ((r)*lda + a_offset)
#endif

kernel void gemm(global const float* a, int a_offset, int lda, global const int* a_rows,
                 int a_first, int a_shift, global const float* b, int b_offset, int ldb,
                 global float* c, int c_offset, int ldc, int m, int n, int k, float alpha,
                 float beta, global const float* bias, int bias_offset, int bias_ld,
                 global const float* factor, int factor_offset, int factor_ld,
                 global float* sample, int sample_offset, int sample_ld, float temperature,
                 float kept_share, uint4 random) {
  const int column = get_global_id(0) * VEC;
  const int row0 = get_global_id(1) * TILE_ROWS;
  if (column >= n || row0 >= m) return;

  int a_row[TILE_ROWS];
  floatN sum[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) {
    a_row[r] = A_ROW(min(row0 + r, m - 1));
    sum[r] = (floatN)(0.0f);
  }
  b += b_offset + column;
  for (int i = 0; i < k; ++i) {
    const floatN b_row = loadN(i * ldb, b);
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) sum[r] = fma((floatN)(a[a_row[r] + i]), b_row, sum[r]);
  }

  const floatN mask = column_mask(column, n);
#if SAMPLE
  uintN draws[DRAW_WORDS];
  uint group = 0xFFFFFFFFu;
#endif
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) {
    const int row = row0 + r;
    if (row >= m) break;
    floatN value = alpha * sum[r];
    const int c_at = c_offset + row * ldc + column;
    if (beta != 0.0f) value = fma((floatN)(beta), loadN(c_at, c), value);
    value = EPILOGUE_VALUE(value, row, column);
    storeN(value, c_at, c);
#if SAMPLE
    if ((uint)row / 4 != group) {
      group = (uint)row / 4;
      draw_four_rows(draws, column, group, random);
    }
    const floatN drawn = sample_units(value, draws, row);
    storeN(mask * (value + temperature * (drawn - value)), sample_offset + row * sample_ld + column,
           sample);
#endif
  }
}

kernel void gemm_transposed_a(global const float* a, int a_offset, int lda,
                              global const int* a_rows, int a_first, int a_shift,
                              global const float* b, int b_offset, int ldb, global float* c,
                              int c_offset, int ldc, int m, int n, int k, float alpha, float beta) {
  const int column = get_global_id(0) * VEC;
  const int row0 = get_global_id(1) * TILE_ROWS;
  if (column >= n || row0 >= m) return;

  floatN sum[TILE_ROWS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) sum[r] = (floatN)(0.0f);
  b += b_offset + column;
  for (int i = 0; i < k; ++i) {
    const floatN b_row = loadN(i * ldb, b);
    const int at = A_ROW(i) + row0;
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) sum[r] = fma((floatN)(a[at + r]), b_row, sum[r]);
  }
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) {
    if (row0 + r >= m) break;
    const int c_at = c_offset + (row0 + r) * ldc + column;
    floatN value = alpha * sum[r];
    if (beta != 0.0f) value = fma((floatN)(beta), loadN(c_at, c), value);
    storeN(value, c_at, c);
  }
}
