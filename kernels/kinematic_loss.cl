// The loss of fine-tuning on the 3D modality and its derivative by the standardized features:
//
//   weights.x · mean |feature − target|²                     over all features
//   weights.y · mean |place − target's place|²               of all bones' ends, through the
//   weights.z · mean |step − target's step|²                 kinematics; a step is from frame to frame
//   weights.w · mean |foot's step − target's|²               of feet, the root's travel included, and
//                                                            only where the target's foot is planted
//
// A window is `frames` rows, of which those from `judged_from` on count. Rows of `prediction`, `target` and
// `error` are LD wide; `differences` holds 3 · BONES floats a row, place − target's place in metres.
// Compile-time: DIMENSION, LD, BONES; FEET, VELOCITY (the first of the root velocity's raw features).
//   bones      int4 each: parent (−1: the root), block, whether a foot is at its end, the block's
//              leading axis (0: x, 1: y)
//   levers     float4 each, metres
//   columns    int4 for each block pair: see column_of
//   scale      float2 for each raw feature: mean, deviation
// global: (rows, 1)
//
// Variants that `scripts/lint kernels` compiles:
//   DIMENSION=1,97 LD=112 BONES=1,20 FEET=1,4 VELOCITY=0,85

#include "common.clh"

#ifndef DIMENSION
#define DIMENSION 96
#endif
#ifndef LD
#define LD 96
#endif
#ifndef BONES
#define BONES 20
#endif
#ifndef FEET
#define FEET 4
#endif
#ifndef VELOCITY
#define VELOCITY 85
#endif

// An axis that is shorter does not become a unit vector: its derivative would grow without bound, and a
// network that is in doubt about an axis answers a short one. Longer ones are as features are decoded.
#define SHORT_AXIS 0.5f

// The orientation that a 6D block stands for, as its axes (Gram-Schmidt from the leading one on), and what
// its derivative needs: the other axis as the block has it, how far it is along the leading one, lengths.
typedef struct {
  float3 x, y, z, other;
  float length_leading, length_u, along;
  int leading;
} Turn;

INLINE float raw_feature(global const float* row, int feature, global const int* columns,
                         global const float2* scale) {
  const int column = columns[feature];
  return column < 0 ? scale[feature].x : scale[feature].x + scale[feature].y * row[column];
}

INLINE Turn turn_of(global const float* row, int block, int leading, global const int* columns,
                    global const float2* scale) {
  float v[6];
  for (int i = 0; i < 6; ++i) v[i] = raw_feature(row, 6 * block + i, columns, scale);
  const float3 x = (float3)(v[0], v[1], v[2]), y = (float3)(v[3], v[4], v[5]);
  const float3 first = leading ? y : x;
  Turn turn;
  turn.leading = leading;
  turn.other = leading ? x : y;
  turn.length_leading = sqrt(dot(first, first));
  const float3 axis = first / fmax(turn.length_leading, SHORT_AXIS);
  turn.along = dot(axis, turn.other);
  const float3 u = turn.other - turn.along * axis;
  turn.length_u = sqrt(dot(u, u));
  const float3 rest = u / fmax(turn.length_u, SHORT_AXIS);
  turn.x = leading ? rest : axis;
  turn.y = leading ? axis : rest;
  turn.z = cross(turn.x, turn.y);
  return turn;
}

INLINE float3 turned(Turn turn, float4 lever) {
  return turn.x * lever.x + turn.y * lever.y + turn.z * lever.z;
}

kernel void position_differences(global const float* prediction, global const float* target,
                              global float* differences, int difference_ld, int frames, int judged_from,
                              global const int4* bones, global const float4* levers,
                              global const int* columns, global const float2* scale) {
  const int row = get_global_id(0);
  if (row % frames < judged_from) return;
  prediction += row * LD;
  target += row * LD;
  differences += row * difference_ld;
  for (int i = 0; i < BONES; ++i) {
    const int parent = bones[i].x, block = bones[i].y, leading = bones[i].w;
    float3 place = turned(turn_of(prediction, block, leading, columns, scale), levers[i]) -
                   turned(turn_of(target, block, leading, columns, scale), levers[i]);
    if (parent >= 0) place += vload3(parent, differences);
    vstore3(place, i, differences);
  }
}

// The derivative by a vector from that by the axis which it became.
INLINE float3 lengthened_error(float3 error, float3 axis, float length) {
  return length < SHORT_AXIS ? error / SHORT_AXIS : (error - axis * dot(axis, error)) / length;
}

// Adds the derivative by a block's axes, taken back through Gram-Schmidt, to its six features.
INLINE void add_turn_error(global float* error, int block, Turn turn, float3 error_x,
                           float3 error_y, float3 error_z, global const int* columns,
                           global const float2* scale) {
  error_x += cross(turn.y, error_z);
  error_y += cross(error_z, turn.x);
  const float3 axis = turn.leading ? turn.y : turn.x, rest = turn.leading ? turn.x : turn.y;
  const float3 error_u =
      lengthened_error(turn.leading ? error_x : error_y, rest, turn.length_u);
  const float3 error_other = error_u - axis * dot(axis, error_u);
  const float3 error_axis = (turn.leading ? error_y : error_x) - turn.other * dot(axis, error_u) -
                            turn.along * error_u;
  const float3 error_first = lengthened_error(error_axis, axis, turn.length_leading);
  const float3 of_x = turn.leading ? error_other : error_first,
               of_y = turn.leading ? error_first : error_other;
  const float v[6] = {of_x.x, of_x.y, of_x.z, of_y.x, of_y.y, of_y.z};
  for (int i = 0; i < 6; ++i) {
    const int column = columns[6 * block + i];
    if (column >= 0) error[column] += v[i] * scale[6 * block + i].y;
  }
}

// The derivative of the loss by one bone's place.
INLINE float3 place_error(global const float* differences, int ld, int bone, int frame, int frames,
                          int judged_from, float per_place, float per_step) {
  const float3 here = vload3(bone, differences);
  float3 error = per_place * here;
  if (frame > judged_from) error += per_step * (here - vload3(bone, differences - ld));
  if (frame + 1 < frames) error += per_step * (here - vload3(bone, differences + ld));
  return error;
}

// A bone's end relative to the root, in metres.
INLINE float3 place_of(global const float* row, int bone, global const int4* bones,
                       global const float4* levers, global const int* columns,
                       global const float2* scale) {
  float3 place = 0.0f;
  for (int i = bone; i >= 0; i = bones[i].x)
    place += turned(turn_of(row, bones[i].y, bones[i].w, columns, scale), levers[i]);
  return place;
}

// How far the root goes in one frame, in metres.
INLINE float3 root_step(global const float* row, float frame_s, global const int* columns,
                        global const float2* scale) {
  return frame_s * (float3)(raw_feature(row, VELOCITY, columns, scale),
                            raw_feature(row, VELOCITY + 1, columns, scale),
                            raw_feature(row, VELOCITY + 2, columns, scale));
}

// What a foot's step from the frame before differs by where the target's foot is planted; else 0.
INLINE float3 planted_difference(global const float* prediction, global const float* target,
                                 global const float* differences, int ld, int bone, float frame_s,
                                 float planted_m, global const int4* bones,
                                 global const float4* levers, global const int* columns,
                                 global const float2* scale) {
  const float3 root = root_step(target, frame_s, columns, scale),
               step = root + place_of(target, bone, bones, levers, columns, scale) -
                      place_of(target - LD, bone, bones, levers, columns, scale);
  if (dot(step, step) > planted_m * planted_m) return 0.0f;
  return root_step(prediction, frame_s, columns, scale) - root + vload3(bone, differences) -
         vload3(bone, differences - ld);
}

// losses: a row each, four numbers: the row's share of the four means (unweighted).
kernel void pose_errors(global const float* prediction, global const float* target,
                        global const float* differences, int difference_ld, int count, int frames,
                        int judged_from, float4 weights, float frame_s, float planted_m,
                        global const int4* bones, global const float4* levers,
                        global const int* columns, global const float2* scale, global float* error,
                        global float* losses, int losses_ld) {
  const int row = get_global_id(0), frame = row % frames;
  prediction += row * LD;
  target += row * LD;
  error += row * LD;
  differences += row * difference_ld;
  losses += row * losses_ld;
  const float rows = (float)(count * (frames - judged_from));
  const float of_features = 1.0f / (rows * DIMENSION), of_places = 1.0f / (rows * 3 * BONES),
              of_steps = 1.0f / ((float)(count * (frames - judged_from - 1)) * 3 * BONES),
              of_contacts = 1.0f / ((float)(count * (frames - judged_from - 1)) * 3 * FEET);
  const bool counts = frame >= judged_from;
  float features = 0.0f, places = 0.0f, steps = 0.0f, contacts = 0.0f;
  for (int i = 0; i < LD; ++i) {
    const float difference = counts ? prediction[i] - target[i] : 0.0f;
    features += difference * difference;
    error[i] = 2.0f * weights.x * of_features * difference;
  }
  if (counts) {
    // From the ends to the root: a bone carries all that hangs on it.
    float3 carried[BONES];
    for (int i = 0; i < BONES; ++i) {
      const float3 here = vload3(i, differences);
      places += dot(here, here);
      if (frame > judged_from) {
        const float3 moved = here - vload3(i, differences - difference_ld);
        steps += dot(moved, moved);
      }
      carried[i] = place_error(differences, difference_ld, i, frame, frames, judged_from,
                               2.0f * weights.y * of_places, 2.0f * weights.z * of_steps);
    }
    float3 root_error = 0.0f;
    for (int i = 0; i < BONES; ++i) {
      if (!bones[i].z) continue;
      if (frame > judged_from) {
        const float3 here =
            planted_difference(prediction, target, differences, difference_ld, i, frame_s,
                               planted_m, bones, levers, columns, scale);
        contacts += dot(here, here);
        carried[i] += 2.0f * weights.w * of_contacts * here;
        root_error += 2.0f * weights.w * of_contacts * frame_s * here;
      }
      if (frame + 1 < frames)
        carried[i] -= 2.0f * weights.w * of_contacts *
                      planted_difference(prediction + LD, target + LD, differences + difference_ld,
                                         difference_ld, i, frame_s, planted_m, bones, levers,
                                         columns, scale);
    }
    const float of_root[3] = {root_error.x, root_error.y, root_error.z};
    for (int k = 0; k < 3; ++k) {
      const int column = columns[VELOCITY + k];
      if (column >= 0) error[column] += of_root[k] * scale[VELOCITY + k].y;
    }
    for (int i = BONES - 1; i >= 0; --i) {
      const int parent = bones[i].x, block = bones[i].y;
      if (parent >= 0) carried[parent] += carried[i];
      const float4 lever = levers[i];
      add_turn_error(error, block, turn_of(prediction, block, bones[i].w, columns, scale),
                     carried[i] * lever.x, carried[i] * lever.y, carried[i] * lever.z, columns,
                     scale);
    }
  }
  losses[0] = features * of_features;
  losses[1] = places * of_places;
  losses[2] = steps * of_steps;
  losses[3] = contacts * of_contacts;
}
