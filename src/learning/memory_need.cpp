#include "learning/memory_need.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/counted.hpp"
#include "mcdbn/base/errors.hpp"
#include "mcdbn/learning/greedy_schedule.hpp"
#include "mcdbn/machines/mrbm.hpp"

namespace mcdbn {
namespace {

double count_of(const std::vector<ParameterShape>& shapes) {
  double count = 0;
  for (const ParameterShape& shape : shapes)
    count += static_cast<double>(shape.rows) * static_cast<double>(shape.columns);
  return count;
}

/// Numbers that a frame of a window leaves behind in every layer of a modality.
double states_of(std::size_t dimension, const LearningSettings& settings) {
  return static_cast<double>(dimension) +
         2.0 * static_cast<double>(settings.layers * settings.hidden);
}

double fine_tuning_states(std::span<const std::size_t> dimensions,
                          const LearningSettings& settings) {
  const FineTuningSettings& tuning = settings.fine_tuning;
  const auto judged = static_cast<double>(tuning.windows) *
                      static_cast<double>(tuning.settle_frames + tuning.window_frames);
  const auto history =
      static_cast<double>(tuning.windows) * static_cast<double>(settings.layers * settings.order);
  double states = 0;
  for (const std::size_t dimension : dimensions)
    states += (judged + history) * states_of(dimension, settings);
  // Values and errors of the codes in every unrolled step (UnrolledPass).
  return states + judged * 2.0 * static_cast<double>(tuning.mean_field_steps) *
                      static_cast<double>(settings.hidden + settings.mrbm_hidden);
}

}  // namespace

MemoryNeed memory_need(std::span<const std::size_t> dimensions, double frames,
                       const LearningSettings& settings) {
  double parameters = 0, batch = 0, rows = 0;
  MrbmShape mrbm{{}, settings.mrbm_hidden};
  for (const std::size_t dimension : dimensions) {
    for (const CrbmShape& shape : layer_shapes(dimension, settings, VisibleKind::gaussian))
      parameters += count_of(Crbm::parameter_shapes(shape));
    mrbm.modalities.push_back({{}, settings.hidden});
    batch = std::max(batch, static_cast<double>(settings.batch) * states_of(dimension, settings));
    rows += static_cast<double>(dimension);
  }
  parameters += count_of(Mrbm::parameter_shapes(mrbm));
  const bool tunes = settings.fine_tuning.steps > 0;
  const bool is_greedy = !tunes || settings.fine_tuning.from_greedy;
  // The value and its step; Adam has two moments and fine-tuning a moving average and a gradient.
  const double copies = tunes ? 5 : 2;
  rows += static_cast<double>(dimensions.size() * settings.hidden);
  MemoryNeed need;
  need.parameters = sizeof(float) * copies * parameters;
  need.windows = sizeof(float) * std::max(is_greedy ? batch : 0.0,
                                          tunes ? fine_tuning_states(dimensions, settings) : 0.0);
  // Fine-tuning takes its windows from the host's memory.
  need.frames = is_greedy ? sizeof(float) * frames * rows : 0.0;
  return need;
}

void check_memory(const MemoryNeed& need, const DeviceInfo& device,
                  const LearningSettings& settings) {
  const auto has = static_cast<double>(device.global_memory_bytes);
  if (need.total() <= has) return;
  constexpr double kGigabyte = 1e9;
  const std::string lower =
      need.parameters >= std::max(need.windows, need.frames)
          ? fmt::format(
                "lower `hidden` (now {}), `mrbm-hidden` ({}), `order` ({}) or `layers` ({})",
                settings.hidden, settings.mrbm_hidden, settings.order, settings.layers)
      : need.windows >= need.frames
          ? fmt::format(
                "lower `batch` (now {}), `fine-tuning.windows` ({}), "
                "`fine-tuning.window-frames` ({}) or `fine-tuning.mean-field-steps` ({})",
                settings.batch, settings.fine_tuning.windows, settings.fine_tuning.window_frames,
                settings.fine_tuning.mean_field_steps)
          : "train on fewer clips, or lower `augment.views` or `hidden`";
  throw ConfigError(
      fmt::format("the training needs at least {:.3g} GB of memory, {} has {:.3g} GB: {}",
                  need.total() / kGigabyte, device.name, has / kGigabyte, lower));
}

void check_window(std::size_t longest, const LearningSettings& settings) {
  const std::size_t window = settings.layers * settings.order + settings.look_ahead + 1;
  if (window <= longest) return;
  throw ConfigError(fmt::format(
      "a window of {} is learnt from (`order` {} in each of `layers` {}, `look-ahead` {}, "
      "and its own), but the longest clip has {}; lower one of them, or give longer clips",
      counted(window, "frame"), settings.order, settings.layers, settings.look_ahead, longest));
}

}  // namespace mcdbn
