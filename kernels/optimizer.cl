// What is done to the parameters of a machine in training, pointwise over floats of its buffers
// (optimizer.clh); padding columns hold zeros and stay so, as their gradients are zero.
// global: (floats / VEC)
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 SCALED=,1 OPTIMIZER=none,momentum,adam,momentum_l1,adam_l1 SAMPLE=

#include "units.clh"
#include "optimizer.clh"

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
  for (int i = item; i < vectors; i += items) {
    const floatN value = loadN(first + i * VEC, x);
    sum = fma(value, value, sum);
  }
  squares[slot + item] = sum_lanes(sum);
}

// scale[0] = what brings the length of a gradient, whose parts' squares these are, to at most `longest`
kernel void limit_scale(global const float* squares, int count, float longest, global float* scale) {
  float sum = 0.0f;
  for (int i = 0; i < count; ++i) sum += squares[i];
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
