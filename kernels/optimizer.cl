// What is done to the parameters of a machine in training, pointwise over floats of its buffers
// (optimizer.clh); padding columns hold zeros and stay so, as their gradients are zero.
// global: (floats / VEC)
//
// Variants that `scripts/lint kernels` compiles:
//   GROUP=1,256
//   VEC=1,4,8,16 SCALED=,1 OPTIMIZER=none,momentum,adam,momentum_l1,adam_l1 SAMPLE=
//   VEC=1,4 UNROLL=16

#include "units.clh"
#include "optimizer.clh"

#ifndef GROUP
#define GROUP 1
#endif

// The floats from `first` on by their gradients. With SCALED the gradient is `scale` times what
// `gradients` holds.
kernel void update_parameters(global float* parameters, global float* gradients,
                              global float* states, int size, int first, float8 rule
#ifdef SCALED
                              ,
                              global const float* scale
#endif
) {
  const int at = first + get_global_id(0) * VEC;
  floatN gradient = loadN(at, gradients);
#ifdef SCALED
  gradient *= scale[0];
#endif
  update(parameters, gradients, states, size, at, gradient, rule);
}

// squares[slot + i] = the sum of squares of the vectors i, i + items … of `vectors` from x[first] on
kernel void sum_squares(global const float* x, int first, int vectors, global float* squares,
                        int slot) {
  const int item = get_global_id(0), items = get_global_size(0);
  floatN sum = (floatN)(0.0f);
  UNROLLED
  for (int i = item; i < vectors; i += items) {
    const floatN value = loadN(first + i * VEC, x);
    sum = fma(value, value, sum);
  }
  squares[slot + item] = sum_lanes(sum);
}

// scale[0] = what brings the length of a gradient, whose parts' squares these are, to at most `longest`.
// global: (GROUP), local: (GROUP)
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void limit_scale(
    global const float* squares, int count, float longest, global float* scale) {
  local float sums[GROUP];
  float sum = 0.0f;
  UNROLLED
  for (int i = get_local_id(0); i < count; i += GROUP) sum += squares[i];
  sums[get_local_id(0)] = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (get_local_id(0) > 0) return;
  for (int i = 1; i < GROUP; ++i) sum += sums[i];
  const float length = sqrt(sum);
  scale[0] = length > longest ? longest / length : 1.0f;
}

// Fast weights (Tieleman and Hinton 2009), the floats from `first` on: fast ← kept · fast − rate · gradient;
// sum = parameter + fast
kernel void fast_update(global float* fast, global float* sum, global const float* parameters,
                        global const float* gradients, int first, float kept, float rate) {
  const int at = first + get_global_id(0) * VEC;
  const floatN moved = kept * loadN(at, fast) - rate * loadN(at, gradients);
  storeN(moved, at, fast);
  storeN(loadN(at, parameters) + moved, at, sum);
}

// average += share · (parameter − average)
kernel void average_update(global float* average, global const float* parameters, float share) {
  const int at = get_global_id(0) * VEC;
  const floatN old = loadN(at, average);
  storeN(fma((floatN)(share), loadN(at, parameters) - old, old), at, average);
}
