// The mean squared error of a mini-batch of windows and its derivative: weight · mean |prediction −
// target|² over the rows of each window that count.
//
// A window is `frames` rows, of which those from `judged_from` on count; there are `count` windows. Rows of
// `prediction`, `target` and `error` are LD wide. Compile-time: DIMENSION, LD (a row's length).
// global: (rows)
// MASKED=1 counts only where `seen`, laid out like `target`, is 1 and not 0, and takes the mean over
// that; `count_seen` counts it first, a column a work-item.
//
// Variants that `scripts/lint kernels` compiles:
//   DIMENSION=1,97 LD=112 MASKED=0,1

#include "common.clh"

#ifndef DIMENSION
#define DIMENSION 43
#endif
#ifndef LD
#define LD PADDED(DIMENSION)
#endif

#ifndef MASKED
#define MASKED 0
#endif

#if MASKED
// seen_count[column] = how many of the rows that count saw it; global: (DIMENSION)
kernel void count_seen(global const float* seen, int count, int frames, int judged_from,
                       global float* seen_count) {
  const int column = get_global_id(0);
  float sum = 0.0f;
  for (int window = 0; window < count; ++window)
    for (int frame = judged_from; frame < frames; ++frame) sum += seen[(window * frames + frame) * LD + column];
  seen_count[column] = sum;
}
#endif

kernel void squared_loss(global const float* prediction, global const float* target, int count,
                           int frames, int judged_from, float weight, global float* error,
                           global float* losses, int losses_ld
#if MASKED
                           ,
                           global const float* seen, global const float* seen_count
#endif
) {
  const int row = get_global_id(0);
  const bool counts = row % frames >= judged_from;
#if MASKED
  float all_seen = 0.0f;
  for (int i = 0; i < DIMENSION; ++i) all_seen += seen_count[i];
  const float of_features = 1.0f / max(all_seen, 1.0f);
#else
  const float of_features = 1.0f / ((float)(count * (frames - judged_from)) * DIMENSION);
#endif
  float sum = 0.0f;
  for (int i = 0; i < LD; ++i) {
#if MASKED
    const float difference =
        counts ? seen[row * LD + i] * (prediction[row * LD + i] - target[row * LD + i]) : 0.0f;
#else
    const float difference = counts ? prediction[row * LD + i] - target[row * LD + i] : 0.0f;
#endif
    sum += difference * difference;
    error[row * LD + i] = 2.0f * weight * of_features * difference;
  }
  losses[row * losses_ld] = sum * of_features;
}
