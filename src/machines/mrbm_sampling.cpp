// Reconstruction and samples of an MRBM.

#include <numeric>

#include "base/random_streams.hpp"
#include "device/kernel_arguments.hpp"
#include "device/pointwise.hpp"
#include "machines/mean_field.hpp"
#include "machines/mrbm_chain.hpp"
#include "mcdbn/machines/sampling.hpp"

namespace mcdbn {

std::vector<Matrix> reconstruct(const Mrbm& mrbm, const std::vector<Rows>& modalities,
                                std::size_t steps) {
  require(modalities.size() == mrbm.modality_count() && steps > 0,
          "reconstruct: needs every modality, and at least one step");
  std::vector<std::size_t> all(modalities.size());
  std::iota(all.begin(), all.end(), 0);
  const Matrix hidden(mrbm.device(), modalities[0].count, mrbm.hidden());
  std::vector<Matrix> result;
  result.reserve(modalities.size());
  for (const Rows& rows : modalities) result.emplace_back(mrbm.device(), rows.count, rows.columns);
  const std::vector<Rows> own(result.begin(), result.end());
  for (std::size_t step = 0; step < steps; ++step) {
    shared_units(mrbm, all, step == 0 ? modalities : own, mrbm.b,
                 mean_of_units(VisibleKind::binary), hidden);
    for (const std::size_t m : all)
      absent_units(mrbm, m, hidden, mean_of_units(mrbm.kind(m)), own[m]);
  }
  return result;
}

std::vector<Matrix> sample(const Mrbm& mrbm, const std::vector<Matrix>& modalities,
                           const std::vector<bool>& given, std::size_t rows,
                           const ChainSettings& settings) {
  require(modalities.size() == mrbm.modality_count() && given.size() == modalities.size(),
          "sample: needs every modality, and which are given");
  std::vector<Matrix> result;
  for (std::size_t m = 0; m < modalities.size(); ++m) {
    result.emplace_back(mrbm.device(), rows, mrbm.visible(m));
    if (given[m]) result[m].copy_from(modalities[m]);
  }
  MrbmChainOptions options;
  options.steps = settings.steps;
  options.temperature = 1.0F;
  options.random = {settings.seed, 0, random_streams::kChains, 0};
  options.steps_apart = 2;  // step 1 is that of the last draw
  MrbmChain(mrbm, given, rows).run({result.begin(), result.end()}, options);
  if (settings.means) return result;
  for (std::size_t m = 0; m < result.size(); ++m) {
    if (given[m]) continue;
    const Rows units(result[m]);
    GemmOptions draw;
    draw.sampling = sampling_of(mrbm.kind(m));
    draw.sample = &units;
    draw.random = {settings.seed, 1, random_streams::kChains, static_cast<std::uint16_t>(m)};
    apply_epilogue(units, draw);
  }
  return result;
}

}  // namespace mcdbn
