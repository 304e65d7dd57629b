// Free energies, one a row, and what is made of them. Sums run over a row's columns in ascending order,
// whatever VEC. Matrices are row-major; *_offset is the first float, *_ld a row's length, 0 where one
// row serves all. One number a row stands in the first column of a matrix.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 GAUSSIAN=0,1
//   VEC=1,4,8,16 SAMPLE=1
//   VEC=1,4 UNROLL=16

#include "units.clh"

#ifndef GAUSSIAN
#define GAUSSIAN 1
#endif

// `sum` and the first `count` components of x, one after another.
INLINE float add_lanes(float sum, floatN x, int count) {
  float lanes[VEC];
  storeN(x, 0, lanes);
  for (int i = 0; i < count; ++i) sum += lanes[i];
  return sum;
}

#if SAMPLE == 0
// energy[r] = ½ |v − â|² − Σ_j log(1 + exp(x_j)) (eq 9 and 14, errata), or −v·â in place of the square
// for binary units (eq 2); x = b̂ + v·W. With `add` it is added to what is there. global: (rows)
kernel void free_energy(global const float* v, int v_offset, int v_ld, global const float* bias,
                        int bias_ld, int visible, global const float* input, int input_ld, int hidden,
                        global float* energy, int energy_offset, int energy_ld, int add) {
  const int row = get_global_id(0);
  v += v_offset + row * v_ld;
  bias += row * bias_ld;
  input += row * input_ld;
  float seen = 0.0f;
  UNROLLED
  for (int i = 0; i < visible; ++i) {
#if GAUSSIAN
    const float d = v[i] - bias[i];
    seen = fma(0.5f * d, d, seen);
#else
    seen = fma(-v[i], bias[i], seen);
#endif
  }
  float summed_out = 0.0f;
  for (int j = 0; j < hidden; j += VEC)
    summed_out = add_lanes(summed_out, softplusN(loadN(j, input)), min(VEC, hidden - j));
  const int at = energy_offset + row * energy_ld;
  energy[at] = (add ? energy[at] : 0.0f) + (seen - summed_out);
}

// The unit columns[r] of each row becomes 1 − v. global: (rows)
kernel void flip_units(global float* v, int v_ld, global const int* columns) {
  const int at = get_global_id(0) * v_ld + columns[get_global_id(0)];
  v[at] = 1.0f - v[at];
}

// out[r] = scale · log σ(x[r] − y[r]); global: (rows)
kernel void log_sigmoid_difference(global const float* x, int x_ld, global const float* y,
                                   int y_offset, int y_ld, float scale, global float* out,
                                   int out_offset, int out_ld) {
  const int row = get_global_id(0);
  const floatN against = (floatN)(y[y_offset + row * y_ld] - x[row * x_ld]);
  out[out_offset + row * out_ld] = -scale * add_lanes(0.0f, softplusN(against), 1);
}
#endif

#if SAMPLE == 0
// out[r] = weight where x[r] < y[r], else 0; a NaN counts as not lower. global: (rows)
kernel void weigh_lower(global const float* x, global const float* y, int ld, float weight,
                        global float* out, int out_ld) {
  const int row = get_global_id(0);
  out[row * out_ld] = x[row * ld] < y[row * ld] ? weight : 0.0f;
}
#endif

#if SAMPLE == 1
// One temperature of annealed importance sampling (Salakhutdinov and Murray 2008, eq 16 to 18): rows
// move on from β to β'. x = b̂ + v·W; d is the machine's visible bias less the base's.
//   log w[r] += (β' − β) v·d + Σ_j log(1 + exp(β' x_j)) − log(1 + exp(β x_j))
// added up with what each sum before rounded away (Kahan), and the hidden units are drawn with β'.
// global: (rows)
kernel void anneal(global const float* input, int input_ld, int hidden, global const float* v, int v_ld,
                   global const float* d, int visible, float before, float after,
                   global float* log_weight, global float* lost, int weight_ld, global float* sample,
                   int sample_ld, uint4 random) {
  const int row = get_global_id(0);
  input += row * input_ld;
  v += row * v_ld;
  sample += row * sample_ld;
  float seen = 0.0f;
  UNROLLED
  for (int i = 0; i < visible; ++i) seen = fma(v[i], d[i], seen);
  float gained = (after - before) * seen;
  for (int j = 0; j < hidden; j += VEC) {
    const floatN x = loadN(j, input);
    gained = add_lanes(gained, softplusN(after * x) - softplusN(before * x), min(VEC, hidden - j));
    uintN words[DRAW_WORDS];
    draw_four_rows(words, j, row / 4, random);
    storeN(column_mask(j, hidden) * sample_units(sigmoidN(after * x), words, row), j, sample);
  }
  const int at = row * weight_ld;
  const float term = gained - lost[at];
  const float sum = log_weight[at] + term;
  lost[at] = (sum - log_weight[at]) - term;
  log_weight[at] = sum;
}
#endif
