// The mean squared error of a mini-batch of windows and its derivative: weight · mean |prediction −
// target|² over the rows of each window that count.
//
// A window is `frames` rows, of which those from `lead` on count; there are `count` windows. Rows of
// `prediction`, `target` and `error` are LD wide. Compile-time: DIMENSION, LD (a row's length).
// global: (rows)
//
// Variants that `scripts/lint kernels` compiles:
//   DIMENSION=1,97 LD=112

#ifndef DIMENSION
#define DIMENSION 43
#endif
#ifndef LD
#define LD ((DIMENSION + 15) / 16 * 16)
#endif

kernel void squared_loss(global const float* prediction, global const float* target, int count,
                           int frames, int lead, float weight, global float* error,
                           global float* losses, int losses_ld) {
  const int row = get_global_id(0);
  const bool counts = row % frames >= lead;
  const float of_features = 1.0f / ((float)(count * (frames - lead)) * DIMENSION);
  float sum = 0.0f;
  for (int i = 0; i < LD; ++i) {
    const float difference = counts ? prediction[row * LD + i] - target[row * LD + i] : 0.0f;
    sum += difference * difference;
    error[row * LD + i] = 2.0f * weight * of_features * difference;
  }
  losses[row * losses_ld] = sum * of_features;
}
