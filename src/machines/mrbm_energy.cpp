#include "machines/mrbm_energy.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "machines/energy_kernel.hpp"
#include "machines/mean_field.hpp"
#include "mcdbn/machines/energy.hpp"

namespace mcdbn {
namespace {

/// Writes or adds the visible term of modality m, and with `hidden` units that of the shared ones.
/// @param input of the shared units [rows x hidden]
void launch_energy(const Mrbm& mrbm, std::size_t m, const Rows& units, const Matrix& input,
                   std::size_t hidden, const Matrix& out, bool add) {
  Device& device = mrbm.device();
  launch(device, energy_kernel(device, "free_energy", mrbm.kind(m)), {{units.count, 1}},
         units.matrix->buffer(), units.offset(), units.stride(), mrbm.a[m].buffer(), 0,
         to_int(units.columns), input.buffer(), to_int(input.stride()), to_int(hidden),
         out.buffer(), 0, to_int(out.stride()), add ? 1 : 0);
}

/// Input of the shared units from all modalities. @return [rows x hidden]
Matrix shared_input(const Mrbm& mrbm, const std::vector<Rows>& units) {
  require(units.size() == mrbm.modality_count(), "free energy: needs every modality");
  for (std::size_t m = 0; m < units.size(); ++m)
    require(units[m].columns == mrbm.visible(m) && units[m].count == units[0].count &&
                units[m].index == nullptr,
            "free energy: the rows do not fit the MRBM");
  std::vector<std::size_t> all(units.size());
  std::iota(all.begin(), all.end(), 0);
  Matrix input(mrbm.device(), units[0].count, mrbm.hidden());
  shared_units(mrbm, all, units, mrbm.b, {}, input);
  return input;
}

}  // namespace

void free_energy_given_others(const Mrbm& mrbm, std::size_t m, const std::vector<Rows>& units,
                              const Matrix& out) {
  require(units[m].count == out.rows(), "free energy: needs one number a row");
  launch_energy(mrbm, m, units[m], shared_input(mrbm, units), mrbm.hidden(), out, false);
}

Matrix free_energy(const Mrbm& mrbm, const std::vector<Rows>& modalities) {
  const Matrix input = shared_input(mrbm, modalities);
  Matrix energy(mrbm.device(), input.rows(), 1);
  for (std::size_t m = 0; m < modalities.size(); ++m)
    launch_energy(mrbm, m, modalities[m], input, m == 0 ? mrbm.hidden() : 0, energy, m > 0);
  return energy;
}

Sequences free_energy(const Mcdbn& network, const std::vector<Sequences>& modalities) {
  require(modalities.size() == network.modality_count(), "free energy: needs every modality");
  std::vector<Sequences> codes;
  const auto frames = static_cast<Eigen::Index>(modalities[0].values.rows());
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  Sequences result{Matrix::from_host(network.mrbm.device(), MatrixF::Constant(frames, 1, kNone)),
                   modalities[0].clips, 0};
  for (std::size_t m = 0; m < modalities.size(); ++m) {
    codes.push_back(network.cdbns[m].up_pass(modalities[m]));
    require(modalities[m].values.rows() == result.values.rows(),
            "free energy: the modalities differ in frames");
    result.valid_from = std::max(result.valid_from, codes[m].valid_from);
  }
  for (const auto& clip : result.clips) {
    if (clip.frames <= result.valid_from + network.look_ahead) continue;
    const std::size_t first = clip.first + result.valid_from,
                      count = clip.frames - result.valid_from - network.look_ahead;
    std::vector<Rows> rows{{codes[0].values, first + network.ahead(0), count}};
    for (std::size_t m = 1; m < codes.size(); ++m)
      rows.emplace_back(codes[m].values, first + network.ahead(m), count);
    result.values.copy_rows_from(free_energy(network.mrbm, rows), 0, count, first);
  }
  return result;
}

void weigh_lower(const Matrix& x, const Matrix& y, float weight, const Matrix& out) {
  Device& device = out.device();
  launch(device, energy_kernel(device, "weigh_lower", VisibleKind::binary), {{out.rows(), 1}},
         x.buffer(), y.buffer(), to_int(x.stride()), weight, out.buffer(), to_int(out.stride()));
}

}  // namespace mcdbn
