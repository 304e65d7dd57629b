// Parameter updates, pointwise over [rows x ld] floats; padding columns hold zeros and stay so,
// as their gradients are zero. `gradient` points uphill for momentum (eq 36: data − reconstruction)
// and downhill's opposite, the loss's gradient, for Adam. global: (elements / VEC)

#include "units.clh"

// velocity ← momentum · velocity + rate · (gradient − decay · parameter); parameter += velocity
kernel void momentum_update(global float* parameter, global float* velocity,
                            global const float* gradient, float rate, float momentum, float decay) {
  const int at = get_global_id(0) * VEC;
  const floatN value = loadN(at, parameter);
  const floatN step =
      momentum * loadN(at, velocity) + rate * (loadN(at, gradient) - decay * value);
  storeN(step, at, velocity);
  storeN(value + step, at, parameter);
}

// squares[first + i] = the sum of squares of the floats i · VEC …, (i + items) · VEC … of `x`
kernel void sum_squares(global const float* x, int vectors, global float* squares, int first) {
  const int item = get_global_id(0), items = get_global_size(0);
  floatN sum = (floatN)(0.0f);
  for (int i = item; i < vectors; i += items) {
    const floatN value = loadN(i * VEC, x);
    sum = fma(value, value, sum);
  }
  squares[first + item] = sum_lanes(sum);
}

// scale[0] = what brings the length of a gradient, whose parts' squares these are, to at most `longest`
kernel void limit_scale(global const float* squares, int count, float longest, global float* scale) {
  float sum = 0.0f;
  for (int i = 0; i < count; ++i) sum += squares[i];
  const float length = sqrt(sum);
  scale[0] = length > longest ? longest / length : 1.0f;
}

// Kingma and Ba (2015), algorithm 1, with decoupled weight decay; correction1 = 1 − β1^t and so on. With
// SCALED the gradient is `scale` times what `gradient` holds.
kernel void adam_update(global float* parameter, global float* mean, global float* square,
                        global const float* gradient, float rate, float beta1, float beta2,
                        float epsilon, float decay, float correction1, float correction2
#ifdef SCALED
                        ,
                        global const float* scale
#endif
) {
  const int at = get_global_id(0) * VEC;
  floatN g = loadN(at, gradient);
#ifdef SCALED
  g *= scale[0];
#endif
  const floatN m = beta1 * loadN(at, mean) + (1.0f - beta1) * g;
  const floatN s = beta2 * loadN(at, square) + (1.0f - beta2) * g * g;
  const floatN value = loadN(at, parameter);
  storeN(m, at, mean);
  storeN(s, at, square);
  const floatN step = (m / correction1) / (sqrt(s / correction2) + epsilon);
  storeN(value - rate * (step + decay * value), at, parameter);
}

// average += share · (parameter − average)
kernel void average_update(global float* average, global const float* parameter, float share) {
  const int at = get_global_id(0) * VEC;
  const floatN old = loadN(at, average);
  storeN(fma((floatN)(share), loadN(at, parameter) - old, old), at, average);
}
