// Every gradient of the joint likelihood by contrastive divergence and what the optimizer makes of it
// (optimizer.clh), in one launch over the outputs of joint_likelihood.cl, whose names and stacks are used
// here. Work-item t adds up one TILE_ROWS x VEC tile of a W over the mini-batch in registers and updates
// it in place, with the transposed copy; tiles of the first modality's W come first. Those of every a and
// of b follow, and the last work-item adds up the losses.
//
// global: (tiles + 1). Compile-time: mrbm_shape.clh, TILE_ROWS (divides 16), OPTIMIZER.
// The optimizer descends, so its gradient is the chain's end less the data.
//
// Variants that `scripts/lint kernels` compiles:
//   VEC=1,4,8,16 TILE_ROWS=4,8,16 SAMPLE= STEPS= BINARY=
//   MODALITIES=2,3 VISIBLE=,1,97 LARGEST=97 HIDDEN=1,97 OPTIMIZER=none,momentum,adam

#include "units.clh"
#include "mrbm_shape.clh"
#include "weight_tile.clh"

// Σ (end − data) over the mini-batch
INLINE floatN sum_of_changes(global const float* data, global const float* end, int rows,
                             const int ld) {
  floatN sum = (floatN)(0.0f);
  for (int i = 0; i < rows; ++i) sum += loadN(i * ld, end) - loadN(i * ld, data);
  return sum;
}

kernel void joint_likelihood_update(
    global const int* layout, int rows, int stride, global const float* codes,
    global const float* visible, global const float* hidden_data, global const float* hidden,
    global float* parameters, global float* transposed, global float* gradients,
    global float* states, int size, float8 rule, global const float* loss,
    global float* loss_sums) {
  const float mean = 1.0f / (float)rows;
  int tile = get_global_id(0);
  for (int m = 0; m < MODALITIES; ++m) {
    const int ld = PADDED(UNITS(m));
    const int tiles = ld / TILE_ROWS * (H_LD / VEC);
    if (tile < tiles) {
      const int first = stride * UNITS_BEFORE(m) + TILE_ROW(tile), column = TILE_COLUMN(tile);
      floatN sum[TILE_ROWS];
      clear_sums(sum);
      for (int i = 0; i < rows; ++i) {
        add_outer(sum, visible + first + i * ld, loadN(i * H_LD + column, hidden));
        add_outer(sum, codes + first + i * ld, -loadN(i * H_LD + column, hidden_data));
      }
      update_weights(tile, sum, mean, UNITS(m), ld, W_AT(m), transposed + WT_AT(m), parameters,
                     gradients, states, size, rule);
      return;
    }
    tile -= tiles;
  }
  const float8 bias_rule = without_decay(rule);
  int column = tile * VEC;
  for (int m = 0; m < MODALITIES; ++m) {
    const int ld = PADDED(UNITS(m));
    if (column < ld) {
      const int first = stride * UNITS_BEFORE(m) + column;
      const floatN sum = sum_of_changes(codes + first, visible + first, rows, ld);
      update(parameters, gradients, states, size, A_AT(m) + column, mean * sum, bias_rule);
      return;
    }
    column -= ld;
  }
  if (column < H_LD) {
    const floatN sum = sum_of_changes(hidden_data + column, hidden + column, rows, H_LD);
    update(parameters, gradients, states, size, B_AT + column, mean * sum, bias_rule);
    return;
  }
  if (column != H_LD) return;
  for (int m = 0; m < MODALITIES; ++m) {
    float sum = 0.0f;
    for (int i = 0; i < rows; ++i) sum += loss[m * stride + i];
    loss_sums[m] += sum / (float)(rows * UNITS(m));
  }
}
