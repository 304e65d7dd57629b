// Register-tiled products with the epilogues of the model's units.
//
// gemm:               C[i, j] = f(alpha · sum_k A[i, k] · B[k, j] + beta · C[i, j] + bias)
// gemm_transposed_a:  C[i, j] =   alpha · sum_k A[k, i] · B[k, j] + beta · C[i, j]
//
// All matrices are row-major floats with leading dimensions lda, ldb, ldc (multiples of 16, padding
// columns zero); *_offset is the first element used. With A_ROWS row r of A is row a_rows[r] +
// a_shift of the frames, and may run on over several frames (history windows, eq 15).
// f is the epilogue (epilogue.clh).
// One work-item makes TILE_ROWS rows of COLUMNS vectors of C, its accumulators in registers. Every element
// is one chain of fma() over k, whatever the tile.
// global: (ceil(n / (COLUMNS · VEC)), ceil(rows of C / TILE_ROWS))
// With PACKED=1 a work-item of gemm makes `group_rows` x `group_columns` of C, tile after tile, and has its
// columns of B in __local: `packed`, k · group_columns floats, a tile's side by side. group_columns is a
// multiple of COLUMNS · VEC. global: (ceil(rows of C / group_rows), ceil(n / group_columns)), local: (1, 1)
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 TILE_ROWS=1,4,10,16 A_ROWS=0,1 PACKED=0,1
//   VEC=1,16 COLUMNS=1,2,3,4 A_ROWS=0,1
//   VEC=1,16 A_ROWS=1 ACTIVATION=none,sigmoid,relu,centered_sigmoid,sigmoid_gradient,relu_gradient,centered_sigmoid_gradient
//   BIAS=none,row,matrix ACTIVATION=none,sigmoid,relu,centered_sigmoid,sigmoid_gradient,relu_gradient,centered_sigmoid_gradient SAMPLE=0,1,2,3
//   VEC=1,4,8,16 SAMPLE=0,1,2,3
//   VEC=1,4 UNROLL=16

#include "epilogue.clh"

#ifndef TILE_ROWS
#define TILE_ROWS 10
#endif
#ifndef COLUMNS
#define COLUMNS 1
#endif
#ifndef A_ROWS
#define A_ROWS 0
#endif

#ifndef PACKED
#define PACKED 0
#endif
#if PACKED
#define B_SPACE local
#else
#define B_SPACE global
#endif

#if A_ROWS
#define A_ROW(r) ((a_rows[a_first + (r)] + a_shift) * lda + a_offset)
#else
#define A_ROW(r) ((r)*lda + a_offset)
#endif

// sum[r][first + c] += Σ_i a[a_row[r] + i] · b[i, c], i < k
INLINE void add_rows(floatN sum[TILE_ROWS][COLUMNS], const int first, const int count,
                     global const float* a, const int a_row[TILE_ROWS], B_SPACE const float* b,
                     int ldb, int k) {
  UNROLLED
  for (int i = 0; i < k; ++i) {
    floatN b_row[COLUMNS];
#pragma unroll
    for (int c = 0; c < count; ++c) b_row[c] = loadToTileN(i * ldb + c * VEC, b);
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) {
      const floatN value = (floatN)(a[a_row[r] + i]);
#pragma unroll
      for (int c = 0; c < count; ++c) sum[r][first + c] = fma(value, b_row[c], sum[r][first + c]);
    }
  }
}

// add_rows() for Aᵀ: row i of A has its TILE_ROWS values side by side.
INLINE void add_outer_rows(floatN sum[TILE_ROWS][COLUMNS], const int first, const int count,
                           global const float* a, int a_offset, int lda, global const int* a_rows,
                           int a_first, int a_shift, int row0, global const float* b, int ldb,
                           int k) {
  UNROLLED
  for (int i = 0; i < k; ++i) {
    floatN b_row[COLUMNS];
#pragma unroll
    for (int c = 0; c < count; ++c) b_row[c] = loadToTileN(i * ldb + c * VEC, b);
    const int at = A_ROW(i) + row0;
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) {
      const floatN value = (floatN)(a[at + r]);
#pragma unroll
      for (int c = 0; c < count; ++c) sum[r][first + c] = fma(value, b_row[c], sum[r][first + c]);
    }
  }
}

#if PACKED
// packed[i · COLUMNS · VEC + c] = b[i, c], c < columns
INLINE void pack_columns(local float* packed, int columns, global const float* b, int ldb, int k) {
  for (int i = 0; i < k; ++i)
    for (int c = 0; c < columns; c += VEC)
      storeN(loadN(i * ldb + c, b), i * COLUMNS * VEC + c, packed);
}
#endif

kernel void gemm(global const float* a, int a_offset, int lda, global const int* a_rows,
                 int a_first, int a_shift, global const float* b, int b_offset, int ldb,
                 global float* c, int c_offset, int ldc, int m, int n, int k, float alpha,
                 float beta, global const float* bias, int bias_offset, int bias_ld,
                 global const float* factor, int factor_offset, int factor_ld,
                 global float* sample, int sample_offset, int sample_ld, float temperature,
                 float kept_share, uint4 random
#if PACKED
                 ,
                 int group_rows, int group_columns, local float* packed
#endif
) {
#if PACKED
  const int first_row = get_global_id(0) * group_rows, last_row = min(first_row + group_rows, m);
  const int first_column = get_global_id(1) * group_columns,
            last_column = min(first_column + group_columns, n);
#else
  const int first_row = get_global_id(1) * TILE_ROWS, last_row = min(first_row + 1, m);
  const int first_column = get_global_id(0) * COLUMNS * VEC,
            last_column = min(first_column + 1, n);
#endif
  b += b_offset + first_column;
#if PACKED
  for (int column = 0; first_column + column < last_column; column += COLUMNS * VEC)
    pack_columns(packed + column * k, min(last_column - first_column - column, COLUMNS * VEC),
                 b + column, ldb, k);
#endif
  for (int row0 = first_row; row0 < last_row; row0 += TILE_ROWS) {
    int a_row[TILE_ROWS];
#pragma unroll
    for (int r = 0; r < TILE_ROWS; ++r) a_row[r] = A_ROW(min(row0 + r, m - 1));
    for (int column0 = first_column; column0 < last_column; column0 += COLUMNS * VEC) {
#if PACKED
      local const float* columns = packed + (column0 - first_column) * k;
      const int ld_columns = COLUMNS * VEC;
#else
      global const float* columns = b;
      const int ld_columns = ldb;
#endif
      const bool is_whole = column0 + (COLUMNS - 1) * VEC < n;  // else it is made vector by vector
      floatN sum[TILE_ROWS][COLUMNS];
#pragma unroll
      for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
        for (int v = 0; v < COLUMNS; ++v) sum[r][v] = (floatN)(0.0f);
      if (is_whole) {
        add_rows(sum, 0, COLUMNS, a, a_row, columns, ld_columns, k);
      } else {
#pragma unroll
        for (int v = 0; v < COLUMNS; ++v)
          if (column0 + v * VEC < n)
            add_rows(sum, v, 1, a, a_row, columns + v * VEC, ld_columns, k);
      }

#pragma unroll
      for (int v = 0; v < COLUMNS; ++v) {
        const int column = column0 + v * VEC;
        if (column >= n) break;
        const floatN mask = column_mask(column, n);
#if SAMPLE
        uintN draws[DRAW_WORDS];
        uint group = 0xFFFFFFFFu;
#endif
#pragma unroll
        for (int r = 0; r < TILE_ROWS; ++r) {
          const int row = row0 + r;
          if (row >= m) break;
          floatN value = alpha * sum[r][v];
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
          storeN(mask * (value + temperature * (drawn - value)),
                 sample_offset + row * sample_ld + column, sample);
#endif
        }
      }
    }
  }
}

kernel void gemm_transposed_a(global const float* a, int a_offset, int lda,
                              global const int* a_rows, int a_first, int a_shift,
                              global const float* b, int b_offset, int ldb, global float* c,
                              int c_offset, int ldc, int m, int n, int k, float alpha, float beta) {
  const int column0 = get_global_id(0) * COLUMNS * VEC;
  const int row0 = get_global_id(1) * TILE_ROWS;
  if (column0 >= n || row0 >= m) return;
  const bool is_whole = column0 + (COLUMNS - 1) * VEC < n;  // else it is made vector by vector

  floatN sum[TILE_ROWS][COLUMNS];
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r)
#pragma unroll
    for (int v = 0; v < COLUMNS; ++v) sum[r][v] = (floatN)(0.0f);
  b += b_offset + column0;
  if (is_whole) {
    add_outer_rows(sum, 0, COLUMNS, a, a_offset, lda, a_rows, a_first, a_shift, row0, b, ldb, k);
  } else {
#pragma unroll
    for (int v = 0; v < COLUMNS; ++v)
      if (column0 + v * VEC < n)
        add_outer_rows(sum, v, 1, a, a_offset, lda, a_rows, a_first, a_shift, row0, b + v * VEC, ldb,
                       k);
  }
#pragma unroll
  for (int r = 0; r < TILE_ROWS; ++r) {
    if (row0 + r >= m) break;
#pragma unroll
    for (int v = 0; v < COLUMNS; ++v) {
      if (column0 + v * VEC >= n) break;
      const int c_at = c_offset + (row0 + r) * ldc + column0 + v * VEC;
      floatN value = alpha * sum[r][v];
      if (beta != 0.0f) value = fma((floatN)(beta), loadN(c_at, c), value);
      storeN(value, c_at, c);
    }
  }
}
